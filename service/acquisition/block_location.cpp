// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/block_location.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/acquisition/link_fault.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/base/run_on.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Whether the place was found by just these touches.
bool is_made_of(const BlockPose& place, const std::vector<LocatingTouch>& touches) {
  return std::ranges::equal(place.touches, touches, [](const auto& fitted, const LocatingTouch& made) {
    return to_wire(fitted.joints) == made.joints;
  });
}

/// Null where the arm can go around the block, or where that is not found.
const std::string* why_no_pass(const std::optional<FoundBlock>& found) {
  return found ? std::get_if<std::string>(&found->pass) : nullptr;
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

BlockLocation::BlockLocation(boost::asio::any_io_executor operation, boost::asio::any_io_executor computation,
                             const Cell& configured, StoreQueue& store, ControllerSession& session,
                             PublishedStatus& status, Wake& wake, Clocks clocks)
    : computation_(std::move(computation)),
      configured_(configured),
      store_(store),
      session_(session),
      status_(status),
      wake_(wake),
      clocks_(std::move(clocks)),
      cell_(configured),
      regions_(std::in_place, cell_),
      located_(std::make_shared<const LocatedCell>(LocatedCell{cell_, std::nullopt, regions_->shared()})),
      journal_(store, std::move(operation), computation_) {}

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

void BlockLocation::keep_dialogue_in(const std::filesystem::path& file,
                                     const std::optional<std::string>& config_digest) {
  journal_.keep_in(file, config_digest);
  const LocatingJournal::Left left = journal_.left(place_before());
  if (!left.record && !left.why_not) return;
  if (left.record && place_ && is_made_of(*place_, left.record->touches)) {
    forget_touches();  // it was found just before the end
    return;
  }
  try {
    take_up(left);
  } catch (const std::invalid_argument& error) {
    spdlog::warn("{}: the touches by hand in it are discarded: {}", file.string(), error.what());
    dialogue_.reset();
    forget_touches();
  }
}

void BlockLocation::take_up(const LocatingJournal::Left& left) {
  dialogue_.emplace(cell_);
  std::optional<std::string> why_not = left.why_not;
  const std::vector<LocatingTouch> touches =
      left.record ? left.record->touches : std::vector<LocatingTouch>();
  for (const LocatingTouch& touch : touches) {
    const HandTouch made{touch.joints, from_wire(touch.joints), touch.moved_m};
    if (!why_not) why_not = dialogue_->block.locating.why_not(made);
    if (why_not) break;
    dialogue_->block.take(made, configured_, place_);  // no link waits for it yet
    dialogue_->made.push_back(touch);
  }
  if (why_not) {
    dialogue_.emplace(cell_);
    dialogue_->note = fmt::format(
        "the touches by hand of the daemon before are discarded, all are made again: {}; ", *why_not);
    forget_touches();
  } else {
    dialogue_->note = fmt::format(
        "the daemon was restarted and {} kept, the last one made {} (touchcal undo takes it back, touchcal "
        "stop all); ",
        touches.size() == 1 ? "1 touch is" : fmt::format("{} touches are", touches.size()),
        touches.back().touched_at);
  }
  spdlog::warn("locating the block: {}{}", dialogue_->note, dialogue_->block.locating.guide().words);
}

std::optional<std::string> BlockLocation::place_before() const {
  return place_ ? std::optional(place_->located_at) : std::nullopt;
}

std::optional<CommandRefusal> BlockLocation::refusal_while_storing() const {
  if (!is_storing()) return std::nullopt;
  return CommandRefusal{.detail = "the last touch is being stored; then once more"};
}

std::optional<CommandRefusal> BlockLocation::locate() {
  if (auto refusal = refusal_while_storing()) return refusal;
  if (!session_.connected())
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = unmet_by_controller(false, {}, status_.fault())};
  if (dialogue_) return dialogue_->block.found ? prepare_pass() : std::nullopt;
  try {
    dialogue_.emplace(cell_);
  } catch (const std::invalid_argument& error) {
    return CommandRefusal{.detail = error.what()};
  }
  spdlog::info("locating the block by touches");
  status_.publish();
  return std::nullopt;
}

bool BlockLocation::can_undo() const { return awaits_touch() && !is_storing() && !dialogue_->made.empty(); }

void BlockLocation::undo() {
  std::vector<LocatingTouch> others = dialogue_->made;
  others.pop_back();
  const auto take_back = [this](const std::optional<std::string>& failure) {
    if (failure) {
      spdlog::error("a touch by hand is not taken back: {}", *failure);
      dialogue_->block.locating.refuse("the last touch could not be taken back, which is to be stored: " +
                                       *failure);
    } else {
      dialogue_->note.clear();
      dialogue_->made.pop_back();
      dialogue_->block.undo();
    }
    status_.publish();
  };
  journal_.write(
      std::move(others), place_before(), [] {}, take_back);
}

std::optional<CommandRefusal> BlockLocation::take() {
  auto taken = dialogue_->watch.take();
  if (auto* why = std::get_if<std::string>(&taken)) return CommandRefusal{.detail = std::move(*why)};
  if (auto why = take_touch(std::get<HandTouch>(taken))) return CommandRefusal{.detail = std::move(*why)};
  return std::nullopt;
}

void BlockLocation::on_controller_state(const cs8::State& state) {
  if (!awaits_touch()) return;
  if (const auto touch = dialogue_->watch.on_controller_state(state)) take_touch(*touch);
}

/// Why it was not taken, if it was not; else it is on its way to the disk.
std::optional<std::string> BlockLocation::take_touch(const HandTouch& touch) {
  const Locating& locating = dialogue_->block.locating;
  if (locating.guide().step != HandStep::kTouch) return "no touch is awaited now";
  std::optional<std::string> why = locating.why_not(touch);
  if (is_storing()) why = "the one before was still being stored: touch again";
  if (why) {
    spdlog::info("touch by hand not taken: {}", *why);
    dialogue_->block.locating.refuse(*why);
    status_.publish();
    return why;
  }
  const LocatingTouch made{touch.wire_joints, touch.moved_m, format_utc(clocks_.system())};
  std::vector<LocatingTouch> with = dialogue_->made;
  with.push_back(made);
  const auto touched = std::make_shared<TouchedBlock>(dialogue_->block);
  const auto reckon = [touched, touch, &cell = configured_, before = place_] {
    touched->take(touch, cell, before);
  };
  journal_.write(std::move(with), place_before(), reckon, [this, touched, made](const auto& failure) {
    keep_touch(std::move(*touched), made, failure);
  });
  return std::nullopt;
}

/// It is on the disk and `touched` has it, or that failed.
void BlockLocation::keep_touch(TouchedBlock touched, const LocatingTouch& made,
                               const std::optional<std::string>& failure) {
  if (failure) {
    spdlog::error("touch by hand not taken: {}", *failure);
    dialogue_->block.locating.refuse("it could not be stored: " + *failure);
  } else {
    dialogue_->note.clear();
    dialogue_->made.push_back(made);
    dialogue_->block = std::move(touched);
    spdlog::info("touch by hand; {}", dialogue_->block.locating.guide().words);
  }
  status_.publish();
}

void BlockLocation::leave() {
  passing_ = false;
  if (!dialogue_) return;
  dialogue_.reset();
  forget_touches();
}

/// Nobody waits for it: what is over is over, also where its file stays.
void BlockLocation::forget_touches() {
  journal_.forget([this](const std::string& failure) {
    status_.warn(
        {FaultCode::kStoreFailed,
         fmt::format("the touches by hand of a dialogue that is over stay there, and the next daemon "
                     "takes them up: {}",
                     failure)});
  });
}

std::optional<HandGuide> BlockLocation::guide() const {
  if (!dialogue_) return std::nullopt;
  HandGuide guide = dialogue_->block.locating.guide();
  guide.words = dialogue_->note + guide.words;
  if (const auto* why = why_no_pass(dialogue_->block.found)) guide.problem = *why;
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
  const std::optional<FoundBlock>& found = dialogue_->block.found;
  if (auto why = why_too_vague(found->cell, session_.search_length_max_m()))
    return CommandRefusal{.detail = *std::move(why)};
  if (const auto* why = why_no_pass(found)) return CommandRefusal{.detail = *why};
  passing_ = true;
  return std::nullopt;
}

asio::awaitable<bool> BlockLocation::pass() {
  bool passed = false;
  try {
    passed = co_await go_around_block();
  } catch (...) {
    passing_ = false;
    throw;
  }
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

/// The ways are computed beside the link; a stop that comes meanwhile is looked at behind that.
asio::awaitable<bool> BlockLocation::go_around_block() {
  session_.forget_standing();
  const bool permitted = co_await session_.obtain_permit(0);  // it is no run
  if (!permitted) co_return false;
  const auto from = co_await session_.standing_joints();
  if (!from || status_.state() != State::kStarting) co_return false;
  const FoundBlock& found = dialogue_->block.found.value();
  Cell there = found.cell;
  there.speeds.travel_m_s *= kPassSpeedShare;
  const auto find_ways = [there, from = *from,
                          stops = std::get<std::vector<calib::JointVector>>(found.pass)] {
    return pass_ways(there, from, stops);
  };
  const std::optional<std::vector<PassWay>> ways = co_await run_on(computation_, find_ways);
  if (status_.state() != State::kStarting) co_return false;
  if (!ways) {
    status_.raise({FaultCode::kNoSafeWay, "around the block: jog the arm to its park posture first"},
                  Event::kAbortFault);
    co_return false;
  }
  for (const PassWay& way : *ways) {
    const cs8::Travel command = travel_command(there, way.to, way.via);
    const bool arrived = co_await session_.travel(command);
    if (!arrived || status_.state() != State::kStarting) co_return false;
  }
  co_return true;
}

/// On the store's thread: a disk may take seconds, and the link and a stop do not wait for it.
asio::awaitable<bool> BlockLocation::keep_found_place() {
  BlockPose place = dialogue_->block.found.value().place;
  place.located_at = format_utc(clocks_.system());
  place.digest = block_pose_digest(configured_);
  if (!file_.empty()) {
    const auto write = [file = file_, place](RunStore& store) {
      store.demand_in_place();
      write_block_pose(file, place);
    };
    const auto failure = co_await store_.write(write);
    if (failure) {
      status_.raise({FaultCode::kStoreFailed, *failure}, Event::kAbortFault);
      co_return false;
    }
  }
  use(std::move(place));
  co_return true;
}

void BlockLocation::hand_in(TipRegions::Shared made) {
  if (place_) return;  // they are of another place
  regions_.emplace(cell_, std::move(made));
  publish_cell();
}

void BlockLocation::publish_cell() {
  auto located = std::make_shared<const LocatedCell>(LocatedCell{cell_, place_, regions_->shared()});
  const std::lock_guard lock(located_mutex_);
  located_ = std::move(located);
}

void BlockLocation::use(BlockPose place) {
  cell_ = cell_with_block_pose(configured_, place);
  regions_.emplace(cell_);
  place_ = std::move(place);
  publish_cell();
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
