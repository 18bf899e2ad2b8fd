// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/block_location.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/acquisition/link_fault.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

BlockPose located(const std::optional<BlockPose>& before, const Locating& locating) {
  const calib::BlockRegistration& fit = locating.fit().value();
  BlockPose place{.cell_from_block = fit.old_from_new,
                  .covariance = fit.covariance,
                  .std_block_pose = fit.std_block_pose,
                  .touches = locating.touches()};
  if (before) place.cell_from_block = before->cell_from_block * fit.old_from_new;
  return place;
}

/// Why nothing can be planned around a block whose place is known no better than `there` has it: every path
/// keeps that far from the faces, and every search reaches that far to either side.
std::optional<std::string> why_too_vague(const Cell& there, std::optional<double> search_length_max_m) {
  std::string limited_by = "the arm passes the faces at that distance";
  double limit_m = kPassMetres;
  if (search_length_max_m && calib::position_error_max_m(*search_length_max_m) < limit_m) {
    limit_m = calib::position_error_max_m(*search_length_max_m);
    limited_by = fmt::format("the controller searches over {:.0f} mm",
                             calib::mm_from_metres(search_length_max_m.value()));
  }
  if (there.place_error_m <= std::max(limit_m, there.nominal_position_error_m)) return std::nullopt;
  return fmt::format(
      "these touches determine the block's place to {:.0f} mm only (3 sigma at the corners of its faces), "
      "and "
      "{:.0f} mm is the limit, as {}: take touches back (touchcal undo) and make them again where they are "
      "asked for, far apart, by jogging until the probe trips (not by touchcal take), with the hand turned "
      "as little as possible between them",
      calib::mm_from_metres(there.place_error_m), calib::mm_from_metres(limit_m), limited_by);
}

}  // namespace

BlockLocation::BlockLocation(const Cell& configured, StoreQueue& store, ControllerSession& session,
                             PublishedStatus& status, Wake& wake, Clocks clocks)
    : configured_(configured),
      store_(store),
      session_(session),
      status_(status),
      wake_(wake),
      clocks_(std::move(clocks)),
      cell_(configured),
      regions_(std::in_place, cell_),
      located_(std::make_shared<const LocatedCell>(LocatedCell{cell_, std::nullopt})) {}

bool BlockLocation::keep_in(const std::filesystem::path& file) {
  file_ = file;
  auto place = read_block_pose(file);
  if (!place) return false;
  if (place->digest != block_pose_digest(configured_)) {
    spdlog::warn(
        "{}: the cell's files have changed since the block was located; it is taken to stand where "
        "they say. touchcal locate finds it",
        file.string());
    return false;
  }
  use(std::move(*place));
  return true;
}

std::optional<CommandRefusal> BlockLocation::locate() {
  if (!session_.connected())
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = unmet_by_controller(false, {}, status_.fault())};
  if (locating_) return locating_->fit() ? prepare_pass() : std::nullopt;
  try {
    locating_.emplace(cell_);
  } catch (const std::invalid_argument& error) {
    return CommandRefusal{.detail = error.what()};
  }
  watch_.emplace(cell_.arm.model);
  spdlog::info("locating the block by touches");
  status_.publish();
  return std::nullopt;
}

bool BlockLocation::can_undo() const { return awaits_touch() && !locating_->touches().empty(); }

void BlockLocation::undo() {
  locating_->undo();
  status_.publish();
}

std::optional<CommandRefusal> BlockLocation::take() {
  auto taken = watch_->take();
  if (auto* why = std::get_if<std::string>(&taken)) return CommandRefusal{.detail = std::move(*why)};
  if (auto why = take_touch(std::get<HandTouch>(taken))) return CommandRefusal{.detail = std::move(*why)};
  return std::nullopt;
}

void BlockLocation::on_controller_state(const cs8::State& state) {
  if (!awaits_touch()) return;
  if (const auto touch = watch_->on_controller_state(state)) take_touch(*touch);
}

/// Why it was not taken, if it was not.
std::optional<std::string> BlockLocation::take_touch(const HandTouch& touch) {
  const std::size_t before = locating_->touches().size();
  locating_->take(touch);
  const HandGuide guide = locating_->guide();
  spdlog::info("touch by hand{}{}; {}", guide.problem ? " not taken: " : "", guide.problem.value_or(""),
               guide.words);
  status_.publish();
  if (locating_->touches().size() > before) return std::nullopt;
  return guide.problem.value_or("no touch is awaited now");
}

void BlockLocation::leave() {
  locating_.reset();
  watch_.reset();
}

std::optional<HandGuide> BlockLocation::guide() const {
  if (!locating_) return std::nullopt;
  HandGuide guide = locating_->guide();
  if (passing_) {
    guide.step = HandStep::kPassing;
    guide.words = "the arm goes once around the block: keep away from it";
  }
  return guide;
}

std::optional<CommandRefusal> BlockLocation::prepare_pass() {
  if (session_.open_touch() || session_.sequence_to_settle() != 0)
    return CommandRefusal{.detail = "the controller is not ready: touchcal reset, then once more"};
  if (status_.fault() && !is_link_fault(status_.fault()->code))
    return CommandRefusal{.detail = "a fault is there to be read first: " + status_.fault()->message(),
                          .code = FaultCode::kFaultUnacknowledged};
  const Cell there = cell_with_block_pose(configured_, located(place_, *locating_));
  if (auto why = why_too_vague(there, session_.search_length_max_m()))
    return CommandRefusal{.detail = *std::move(why)};
  auto postures = pass_postures(there, locating_->touches());
  if (auto* why = std::get_if<std::string>(&postures)) return CommandRefusal{.detail = std::move(*why)};
  pass_stops_ = std::get<std::vector<calib::JointVector>>(std::move(postures));
  passing_ = true;
  return std::nullopt;
}

asio::awaitable<bool> BlockLocation::pass() {
  const bool passed = co_await go_around_block();
  if (!passed && status_.state() == State::kStarting) {
    co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    co_return false;
  }
  bool found = false;
  if (passed) {
    session_.give_permit_back();
    const bool kept = co_await keep_found_place();
    found = kept;
  }
  passing_ = false;
  if (found) {
    leave();
    co_return true;
  }
  const auto& fault = status_.fault();
  const bool met_something =
      fault && (fault->code == FaultCode::kUnexpectedContact || fault->code == FaultCode::kCollision);
  if (!passed && met_something) leave();  // the block is not where the touches say, or not alone
  status_.publish();
  co_return false;
}

asio::awaitable<bool> BlockLocation::go_around_block() {
  session_.forget_standing();
  const bool permitted = co_await session_.obtain_permit(0);  // it is no run
  if (!permitted) co_return false;
  const auto from = co_await session_.standing_joints();
  if (!from || status_.state() != State::kStarting) co_return false;
  Cell there = cell_with_block_pose(configured_, located(place_, *locating_));
  there.speeds.travel_m_s *= kPassSpeedShare;
  const calib::TransferSpace space(there.arm.model, there.collision_scene(), there.park_joints,
                                   there.face_error_m());
  std::vector<calib::JointVector> stops = pass_stops_;
  stops.push_back(there.park_joints);
  calib::JointVector at = *from;
  for (const calib::JointVector& stop : stops) {
    const auto via = calib::find_path(space, at, stop);
    if (!via) {
      status_.raise({FaultCode::kNoSafeWay, "around the block: jog the arm to its park posture first"},
                    Event::kAbortFault);
      co_return false;
    }
    const cs8::Travel command = travel_command(there, stop, *via);
    const bool arrived = co_await session_.travel(command);
    if (!arrived || status_.state() != State::kStarting) co_return false;
    at = stop;
  }
  co_return true;
}

/// On the store's thread: a disk may take seconds, and the link and a stop do not wait for it.
asio::awaitable<bool> BlockLocation::keep_found_place() {
  BlockPose place = located(place_, *locating_);
  place.located_at = format_utc(clocks_.system());
  place.digest = block_pose_digest(configured_);
  if (!file_.empty()) {
    const auto write = [file = file_, place](RunStore&) { write_block_pose(file, place); };
    const auto failure = co_await store_.write(write);
    if (failure) {
      status_.raise({FaultCode::kStoreFailed, *failure}, Event::kAbortFault);
      co_return false;
    }
  }
  use(std::move(place));
  co_return true;
}

void BlockLocation::use(BlockPose place) {
  cell_ = cell_with_block_pose(configured_, place);
  regions_.emplace(cell_);
  place_ = std::move(place);
  auto located = std::make_shared<const LocatedCell>(LocatedCell{cell_, place_});
  {
    const std::lock_guard lock(located_mutex_);
    located_ = std::move(located);
  }
  const Eigen::Vector3d shift_m = place_->cell_from_block.translation();
  spdlog::info(
      "the block stands {:.1f} {:.1f} {:.1f} mm and {:.2f} degrees from where the cell's file has it; paths "
      "keep {:.0f} mm from its faces",
      calib::mm_from_metres(shift_m.x()), calib::mm_from_metres(shift_m.y()),
      calib::mm_from_metres(shift_m.z()),
      calib::degrees_from_radians(Eigen::AngleAxisd(place_->cell_from_block.linear()).angle()),
      calib::mm_from_metres(cell_.face_error_m()));
}

}  // namespace cell
