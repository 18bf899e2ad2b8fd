// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/block_location.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
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

/// So many standard deviations of the place must be within the distance that the arm passes it at.
constexpr double kPassSigmas = 3.0;

/// The largest standard deviation, in any direction, of a corner of the faces. `covariance` of shift above
/// turn.
double std_farthest_m(const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<calib::Face>& faces) {
  double most_m2 = 0.0;
  for (const calib::Face& face : faces) {
    for (const double u : {-1.0, 1.0}) {
      for (const double v : {-1.0, 1.0}) {
        const Eigen::Vector3d corner_m = face.center_m + u * face.half_extent_m.x() * face.edge_u +
                                         v * face.half_extent_m.y() * face.edge_v();
        Eigen::Matrix<double, 3, 6> moves = Eigen::Matrix<double, 3, 6>::Zero();
        moves.leftCols<3>().setIdentity();
        for (int axis = 0; axis < 3; ++axis)
          moves.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(corner_m);
        const Eigen::Matrix3d of_corner = moves * covariance * moves.transpose();
        most_m2 =
            std::max(most_m2, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(of_corner).eigenvalues()[2]);
      }
    }
  }
  return std::sqrt(most_m2);
}

}  // namespace

BlockLocation::BlockLocation(const Cell& configured, ControllerSession& session, PublishedStatus& status,
                             Wake& wake, Clocks clocks)
    : configured_(configured),
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
  const double known_m = kPassSigmas * std_farthest_m(locating_->fit()->covariance, configured_.block.faces);
  if (known_m > kPassMetres)
    return CommandRefusal{
        .detail = fmt::format(
            "these touches determine the block's place to {:.0f} mm only, and the arm passes it at {:.0f}: "
            "take touches back (touchcal undo) and make them nearer to where they are asked for",
            calib::mm_from_metres(known_m), calib::mm_from_metres(kPassMetres))};
  auto postures =
      pass_postures(cell_with_block_pose(configured_, located(place_, *locating_)), locating_->touches());
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
  passing_ = false;
  const auto& fault = status_.fault();
  const bool met_something =
      fault && (fault->code == FaultCode::kUnexpectedContact || fault->code == FaultCode::kCollision);
  if (!passed && met_something) leave();  // the block is not where the touches say, or not alone
  if (!passed) {
    status_.publish();
    co_return false;
  }
  session_.give_permit_back();
  co_return keep_found_place();
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
                                   there.nominal_position_error_m);
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

bool BlockLocation::keep_found_place() {
  BlockPose place = located(place_, *locating_);
  place.located_at = format_utc(clocks_.system());
  place.digest = block_pose_digest(configured_);
  try {
    if (!file_.empty()) write_block_pose(file_, place);
  } catch (const std::exception& error) {
    status_.raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    return false;
  }
  leave();
  use(std::move(place));
  return true;
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
      "the block stands {:.1f} {:.1f} {:.1f} mm and {:.2f} degrees from where the cell's file has it",
      calib::mm_from_metres(shift_m.x()), calib::mm_from_metres(shift_m.y()),
      calib::mm_from_metres(shift_m.z()),
      calib::degrees_from_radians(Eigen::AngleAxisd(place_->cell_from_block.linear()).angle()));
}

}  // namespace cell
