// A run whose touches a person makes with the pendant, for a cell in which nothing is commanded yet. Each
// co_await stands alone in its statement, see drive.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "service/acquisition/operation.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// From one state to the next, 20 ms: faster, and the trigger is not known well enough to calibrate with.
constexpr double kGuidedMovedMaxMetres = 2e-4;
/// A touch with all joints this near to another one's on the same face tells nothing new.
constexpr double kSamePostureRad = 0.035;

/// On any face: the probe bounced, it is the same contact once more.
constexpr double kSameContactRad = 2e-3;

bool is_same_posture(const calib::Touch& touch, int face, const calib::JointVector& joints) {
  const double apart_rad = (touch.joints - joints).cwiseAbs().maxCoeff();
  return apart_rad < (touch.face == face ? kSamePostureRad : kSameContactRad);
}

/// Whether a ball lies over a face's rectangle, as far as the arm is known.
bool is_over(const calib::Face& face, const Eigen::Vector3d& ball_m, double miss_m) {
  const Eigen::Vector3d off_m = ball_m - face.center_m;
  return std::abs(off_m.dot(face.edge_u)) <= face.half_extent_m.x() + miss_m &&
         std::abs(off_m.dot(face.edge_v())) <= face.half_extent_m.y() + miss_m;
}

}  // namespace

/// What stands in the way of a run by hand: all but what only a command that moves the arm needs.
std::vector<Unmet> Operation::unmet_for_hands(const std::string& recipe) const {
  constexpr std::array kForMotion{
      FaultCode::kEmergencyStop, FaultCode::kNotRemote,    FaultCode::kNotPowered,        FaultCode::kHold,
      FaultCode::kProbeTouched,  FaultCode::kMonitorSpeed, FaultCode::kProbeNotCalibrated};
  std::vector<Unmet> unmet = unmet_for(recipe);
  std::erase_if(unmet, [&](const Unmet& one) {
    return std::ranges::any_of(kForMotion, [&](FaultCode code) { return describe(code).name == one.code; });
  });
  return unmet;
}

/// Tells which touch comes next and waits for it; take_guided() wakes.
asio::awaitable<void> Operation::await_guided_touch() {
  held_by_ = HeldBy::kNothing;
  const calib::PlannedTouch* planned = run_->next();
  if (!planned) {
    apply(Event::kDone);
    co_return;
  }
  identify();
  const bool contradicts = learn();
  const auto aimed = calib::aim_touch(planning_, *aim_, *planned);
  const auto* made = std::get_if<calib::AimedTouch>(&aimed);
  HandGuide guide{
      .activity = HandActivity::kGuided,
      .plane = planned->face + 1,
      .index = run_->touches_done() + 1,
      .total = run_->touches_total(),
      .words = fmt::format("touch plane {} in about this posture: jog the ball against it, under 10 "
                           "mm/s at the end, until the probe trips, then back",
                           planned->face + 1),
      .problem = {},
      .about_joints = made ? made->touch.joints : planned->joints};
  if (guide_ && guide_->index == guide.index) guide.problem = guide_->problem;
  if (contradicts)
    guide.problem =
        "the last touch does not fit the others: touchcal undo takes it back, else go on with this one";
  if (!hand_watch_) hand_watch_.emplace(cell_.arm.model);
  if (guide_ != guide) {
    guide_ = std::move(guide);
    publish();
  }
  co_await wait_for_wake(1h);
}

/// A touch that can be the one that is awaited is kept; else it is told why not.
std::optional<std::string> Operation::take_guided(const HandTouch& touch) {
  const calib::PlannedTouch* planned = run_ ? run_->next() : nullptr;
  if (!guide_ || !planned || status_.state != State::kExecute) return "no touch is awaited now";
  const auto refuse = [this](std::string why) {
    spdlog::info("touch by hand not taken: {}", why);
    guide_->problem = why;
    publish();
    return std::optional(std::move(why));
  };
  if (touch.moved_m && *touch.moved_m > kGuidedMovedMaxMetres) {
    return refuse(
        fmt::format("the ball went {:.2f} mm in the moment of the touch: come slower, under 10 mm/s",
                    calib::mm_from_metres(*touch.moved_m)));
  }
  const calib::Face& face = planning_.faces[static_cast<std::size_t>(planned->face)];
  const Eigen::Vector3d ball_m = calib::forward_kinematics(aim_->model(), touch.joints).translation();
  const double off_m = calib::signed_distance_m(calib::contact_plane(face, planning_.stylus), ball_m);
  if (std::abs(off_m) > cell_.nominal_position_error_m) {
    return refuse(fmt::format("the ball was {:.0f} mm off plane {}: touch that one",
                              calib::mm_from_metres(off_m), planned->face + 1));
  }
  if (!is_over(face, ball_m, cell_.nominal_position_error_m))
    return refuse(fmt::format("the ball was beside plane {}: touch that one", planned->face + 1));
  for (const calib::Touch& made : run_->problem().touches) {
    if (!is_same_posture(made, planned->face, touch.joints)) continue;
    return refuse(
        "a touch in this posture was made before: turn the wrist or take another place on the plane");
  }
  cs8::TouchResult result;
  result.outcome = cs8::Outcome::kContact;
  result.source = cs8::CaptureSource::kPolled;
  result.contact = touch.wire_joints;
  result.edges = 1;
  const calib::PlannedTouch wanted = *planned;  // the run goes on to the next one
  if (!keep_touch(wanted, result)) return "it could not be stored";
  check_place(run_->problem().touches.back());
  publish();
  wake_.cancel();
  return std::nullopt;
}

/// The aim forgets the touch as well: it is made anew from all others.
void Operation::undo_guided() {
  try {
    run_->withdraw_last(store_, "a person took it back");
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    return;
  }
  aim_.emplace(planning_);
  guide_.reset();
  publish();
  wake_.cancel();
}

}  // namespace cell
