// What an Operation does while a person jogs: touches by hand, where the block stands, and whether it still
// stands there. Each co_await stands alone in its statement, see drive.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/acquisition/operation.hpp"
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

/// Begins the dialogue (locating.hpp); once the block is found, sends the arm around it. The place counts for
/// all runs that follow, also of later daemons.
std::optional<CommandRefusal> Operation::locate() {
  if (!client_.connected())
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = unmet_preconditions()};
  if (locating_) return locating_->fit() ? begin_pass() : std::nullopt;
  try {
    locating_.emplace(cell_);
  } catch (const std::invalid_argument& error) {
    return CommandRefusal{.detail = error.what()};
  }
  hand_watch_.emplace(cell_.arm.model);
  spdlog::info("locating the block by touches");
  publish();
  return std::nullopt;
}

/// Takes where the arm stands as the touch that is awaited of a person.
std::optional<CommandRefusal> Operation::take() {
  auto taken = hand_watch_->take();
  if (auto* why = std::get_if<std::string>(&taken)) return CommandRefusal{.detail = std::move(*why)};
  if (auto why = take_by_hand(std::get<HandTouch>(taken))) return CommandRefusal{.detail = std::move(*why)};
  return std::nullopt;
}

std::optional<CommandRefusal> Operation::refuse_undo() const {
  const bool guiding = guided_ && status_.state == State::kExecute && run_->touches_done() > 0;
  if (locating_ ? !passing_ && !locating_->touches().empty() : guiding) return std::nullopt;
  return CommandRefusal{.detail = "there is no touch by hand to take back"};
}

/// The last touch that a person made is forgotten and asked for again.
std::optional<CommandRefusal> Operation::undo() {
  spdlog::info("the last touch by hand is taken back");
  if (locating_) {
    locating_->undo();
    publish();
  } else {
    undo_guided();
  }
  return std::nullopt;
}

void Operation::hear_by_hand(const cs8::State& state) {
  if (!hand_watch_ || passing_) return;
  if (const auto touch = hand_watch_->hear(state)) take_by_hand(*touch);
}

/// Why it was not taken, if it was not.
std::optional<std::string> Operation::take_by_hand(const HandTouch& touch) {
  if (!locating_) return take_guided(touch);
  const std::size_t before = locating_->touches().size();
  locating_->take(touch);
  const HandGuide guide = locating_->guide();
  spdlog::info("touch by hand{}{}; {}", guide.problem ? " not taken: " : "", guide.problem.value_or(""),
               guide.words);
  publish();
  if (locating_->touches().size() > before) return std::nullopt;
  return guide.problem.value_or("no touch is awaited now");
}

/// A run that begins ends the dialogue.
void Operation::tell_guide() {
  if (locating_ && run_open_) leave_locating();
  if (status_.state != State::kExecute) guide_.reset();
  status_.by_hand = locating_ ? std::optional(locating_->guide()) : guide_;
  if (passing_ && status_.by_hand) {
    status_.by_hand->step = HandStep::kPassing;
    status_.by_hand->words = "the arm goes once around the block: keep away from it";
  }
  if (!status_.by_hand) hand_watch_.reset();
}

void Operation::leave_locating() {
  locating_.reset();
  hand_watch_.reset();
}

std::optional<CommandRefusal> Operation::begin_pass() {
  if (open_touch_ || unsettled_sequence_ != 0)
    return CommandRefusal{.detail = "the controller is not ready: touchcal reset, then once more"};
  if (status_.fault && !is_link_fault(status_.fault->code))
    return CommandRefusal{.detail = "a fault is there to be read first: " + status_.fault->message(),
                          .code = FaultCode::kFaultUnacknowledged};
  const double known_m = kPassSigmas * std_farthest_m(locating_->fit()->covariance, configured_.block.faces);
  if (known_m > kPassMetres)
    return CommandRefusal{
        .detail = fmt::format(
            "these touches tell the block's place to {:.0f} mm only, and the arm passes it at {:.0f}: "
            "take touches back (touchcal undo) and make them nearer to where they are asked for",
            calib::mm_from_metres(known_m), calib::mm_from_metres(kPassMetres))};
  auto postures =
      pass_postures(cell_with_block_pose(configured_, located(place_, *locating_)), locating_->touches());
  if (auto* why = std::get_if<std::string>(&postures)) return CommandRefusal{.detail = std::move(*why)};
  pass_ = std::get<std::vector<calib::JointVector>>(std::move(postures));
  run_.reset();
  status_.run_id.reset();
  status_.recipe.reset();
  status_.verdict = Verdict::kNone;
  status_.fault.reset();
  passing_ = true;
  enter(State::kStarting);
  return std::nullopt;
}

asio::awaitable<void> Operation::pass_block() {
  const bool passed = co_await go_around_block();
  if (!passed && status_.state == State::kStarting) {
    co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    co_return;
  }
  passing_ = false;
  const bool met_something = status_.fault && (status_.fault->code == FaultCode::kUnexpectedContact ||
                                               status_.fault->code == FaultCode::kCollision);
  if (!passed && met_something) leave_locating();  // the block is not where the touches say, or not alone
  if (!passed) {
    publish();
    co_return;
  }
  client_.finish();
  keep_found_place();
}

/// Past every face at 30 mm, where any contact is a fault; then to the park posture.
asio::awaitable<bool> Operation::go_around_block() {
  standing_.reset();
  const bool permitted = co_await get_permission();
  if (!permitted) co_return false;
  const auto from = co_await standing_joints();
  if (!from || status_.state != State::kStarting) co_return false;
  Cell there = cell_with_block_pose(configured_, located(place_, *locating_));
  there.speeds.travel_m_s *= kPassSpeedShare;
  const calib::TransferSpace space(there.arm.model, there.collision_scene(), there.park_joints,
                                   there.nominal_position_error_m);
  std::vector<calib::JointVector> stops = pass_;
  stops.push_back(there.park_joints);
  calib::JointVector at = *from;
  for (const calib::JointVector& stop : stops) {
    const auto via = calib::find_path(space, at, stop);
    if (!via) {
      raise({FaultCode::kNoSafeWay, "around the block: jog the arm to its park posture first"},
            Event::kAbortFault);
      co_return false;
    }
    const cs8::Travel command = travel_command(there, stop, *via);
    const cs8::MoveReply reply = co_await client_.travel(command);
    const bool arrived = take_move(reply);
    if (!arrived || status_.state != State::kStarting) co_return false;
    at = stop;
  }
  co_return true;
}

void Operation::keep_found_place() {
  BlockPose place = located(place_, *locating_);
  place.located_at = now_text();
  place.digest = block_pose_digest(configured_);
  try {
    if (!place_file_.empty()) write_block_pose(place_file_, place);
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    return;
  }
  leave_locating();
  use_place(std::move(place));
  enter(State::kIdle);
}

void Operation::keep_place_in(const std::filesystem::path& file) {
  place_file_ = file;
  auto place = read_block_pose(file);
  if (!place) return;
  if (place->digest == block_pose_digest(configured_)) {
    use_place(std::move(*place));
  } else {
    spdlog::warn(
        "{}: the cell's files are others than when the block was located; it is taken to stand where "
        "they say. touchcal locate finds it",
        file.string());
  }
}

/// All that was planned or made ready where the block stood before is forgotten.
void Operation::use_place(BlockPose place) {
  run_.reset();
  plans_.clear();
  ++place_count_;
  aim_.reset();
  ahead_.reset();
  forget_made();
  made_way_.clear();
  cell_ = cell_with_block_pose(configured_, place);
  tip_regions_.emplace(cell_);
  place_ = std::move(place);
  const Eigen::Vector3d shift_m = place_->cell_from_block.translation();
  spdlog::info(
      "the block stands {:.1f} {:.1f} {:.1f} mm and {:.2f} degrees from where the cell's file has it",
      calib::mm_from_metres(shift_m.x()), calib::mm_from_metres(shift_m.y()),
      calib::mm_from_metres(shift_m.z()),
      calib::degrees_from_radians(Eigen::AngleAxisd(place_->cell_from_block.linear()).angle()));
}

/// The touches that found the place tell how far off a run's first ones may be.
void Operation::begin_place_check() {
  place_check_.reset();
  faces_met_.clear();
  if (!place_) return;
  calib::PlanningProblem problem = planning_;
  for (const calib::RegistrationTouch& touch : place_->touches)
    problem.knowledge.touch_noise_m = std::max(problem.knowledge.touch_noise_m, touch.std_m);
  place_check_.emplace(problem);
  for (const calib::RegistrationTouch& touch : place_->touches)
    place_check_->add({.face = touch.face, .joints = touch.joints});
}

void Operation::check_place(const calib::Touch& touch) {
  if (!place_check_ || !faces_met_.insert(touch.face).second) return;
  const calib::PredictedContact contact = place_check_->add(touch);
  const bool met_all = std::ranges::all_of(place_->touches, [this](const calib::RegistrationTouch& made) {
    return faces_met_.contains(made.face);
  });
  if (met_all) place_check_.reset();
  if (std::abs(contact.position_error_m) <= contact.predicted_position_error_m) return;
  raise({FaultCode::kBlockMoved, fmt::format("plane {} was met {:.1f} mm from there, {:.1f} mm could be",
                                             touch.face + 1, calib::mm_from_metres(contact.position_error_m),
                                             calib::mm_from_metres(contact.predicted_position_error_m))},
        Event::kHoldFault);
}

/// A face that is not met at all where it was located.
Fault Operation::placed_fault(Fault fault, int face) const {
  const bool missed = fault.code == FaultCode::kNoContact || fault.code == FaultCode::kEarlyContact ||
                      fault.code == FaultCode::kUnexpectedContact;
  if (!missed || !place_check_ || faces_met_.contains(face)) return fault;
  return {FaultCode::kBlockMoved, fmt::format("at plane {} {}", face + 1, describe(fault.code).cause)};
}

}  // namespace cell
