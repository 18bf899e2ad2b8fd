// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/manual_touching.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "config/touched_places.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// From one state to the next, 20 ms: faster, and the trigger is not known well enough to calibrate with.
constexpr double kGuidedMovedMaxMetres = 2e-4;
/// A touch with all joints this near to those of another one on the same face adds nothing.
constexpr double kSamePostureRad = 0.035;

/// On any face: the probe bounced, it is the same contact once more.
constexpr double kSameContactRad = 2e-3;

bool is_same_posture(const calib::Touch& touch, int face, const calib::JointVector& joints) {
  const double apart_rad = (touch.joints - joints).cwiseAbs().maxCoeff();
  return apart_rad < (touch.face == face ? kSamePostureRad : kSameContactRad);
}

/// Whether a ball lies over a face's rectangle, cap or wall, as far as the arm is known.
bool is_over(const calib::Face& face, const Eigen::Vector3d& ball_m, double miss_m) {
  if (face.cap) {
    const Eigen::Vector3d from_center_m = ball_m - face.cap->center_m;
    const double cosine = face.plane.outward.dot(from_center_m.normalized());
    return std::acos(std::clamp(cosine, -1.0, 1.0)) <=
           face.cap->half_angle_rad + miss_m / from_center_m.norm();
  }
  if (face.bore) {
    const double along_m = face.bore->axis.dot(ball_m - face.bore->center_m);
    const Eigen::Vector3d outward = normal_at(surface_of(face), ball_m);
    const double around_rad = std::acos(std::clamp(face.plane.outward.dot(outward), -1.0, 1.0));
    return std::abs(along_m) <= face.half_extent_m.x() + miss_m &&
           around_rad <= face.bore->half_angle_rad + miss_m / surface_of(face).radius_m();
  }
  const Eigen::Vector3d off_m = ball_m - face.center_m;
  return std::abs(off_m.dot(face.edge_u)) <= face.half_extent_m.x() + miss_m &&
         std::abs(off_m.dot(face.edge_v())) <= face.half_extent_m.y() + miss_m;
}

/// Of the touches of a tool so far: whether they contradict each other.
bool tool_contradicts(const Run& run) {
  if (run.kind() != RunKind::kTool || run.touches_done() < calib::kToolTouchesMin) return false;
  const auto outcome = calib::find_tool_centre(*run.verification()->record, run.verification()->tip,
                                               verifying_touches(run.touches()), {});
  const auto* verdict = std::get_if<calib::ToolVerdict>(&outcome);
  return !verdict || !verdict->passed;
}

/// A person counts the planes of the block that is there: "2", "2 at stand with the tip left".
std::string plane_words(const Cell& cell, const Recipe& recipe, int face) {
  std::string words = std::to_string(static_cast<std::size_t>(face) % cell.block.faces.size() + 1);
  if (const auto place = further_place_name(cell.block, recipe, face)) words += " at " + *place;
  if (const auto tip = further_tip_name(cell, recipe, face)) words += " with the tip " + *tip;
  return words;
}

std::string words_for(const Run& run, const std::string& plane) {
  if (run.kind() == RunKind::kTool)
    return fmt::format(
        "touch plane {} with the tip of the tool {} in about this posture: jog it against the plane, at the "
        "end in the smallest steps, until it just touches; then touchcal take (not needed where the tip "
        "trips the probe's input), then back",
        plane, run.verification()->tool);
  return fmt::format(
      "touch plane {} in about this posture: jog the ball against it, under 10 mm/s at the end, until the "
      "probe trips, then back",
      plane);
}

}  // namespace

ManualTouching::ManualTouching(const Cell& cell, StoreQueue& store, TouchPreparation& preparation,
                               TouchExecutor& touches, PublishedStatus& status, Wake& wake)
    : cell_(cell),
      store_(store),
      preparation_(preparation),
      touches_(touches),
      status_(status),
      wake_(wake) {}

void ManualTouching::begin_run() {
  taken_.reset();
  is_storing_ = false;
  undo_count_ = 0;
}

asio::awaitable<void> ManualTouching::await_touch(ActiveRun& active) {
  touches_.forget_hold();
  const Run& run = active.run;
  const auto taken = std::exchange(taken_, std::nullopt);
  if (taken && taken->run_id == run.id()) {
    co_await keep(active, *taken);
    co_return;
  }
  if (run.touches_done() == 0) undo_count_ = 0;
  if (undo_count_ > 0) {
    --undo_count_;
    co_await withdraw_last(active);
    co_return;
  }
  if (run.identification_is_due()) {
    co_await touches_.identify(active);
    co_return;  // nobody waited for a touch meanwhile: what there was is looked at now
  }
  if (!run.next()) {
    touches_.warn_of_outliers(active);
    status_.apply(Event::kDone);
    co_return;
  }
  if (!run.next_here()) {
    co_await touches_.ask_for_block(active);
    co_return;
  }
  const bool contradicts = preparation_.add_contacts(run);
  HandGuide guide = guide_to(run);
  const bool is_new = !guide_ || guide_->index != guide.index;
  if (!is_new) guide.problem = guide_->problem;
  if (contradicts || (is_new && tool_contradicts(run)))
    guide.problem =
        "the last touch does not fit the others: touchcal undo takes it back, else go on with this one";
  watch_ball_of(run.next()->face);
  if (guide_ != guide) {
    guide_ = std::move(guide);
    status_.publish();
  }
  co_await wake_.wait(1h);
}

void ManualTouching::watch_ball_of(int face) {
  const calib::PlanningProblem& problem = preparation_.problem();
  const std::size_t tip = problem.knowledge.artefact.tip_of(static_cast<std::size_t>(face));
  if (watch_ && watched_tip_ == tip) return;
  watch_.emplace(calib::for_tip_of(problem, face).nominal);
  watched_tip_ = tip;
}

HandGuide ManualTouching::guide_to(const Run& run) const {
  const calib::PlannedTouch& planned = *run.next();
  const auto aimed = calib::aim_touch(preparation_.problem(), preparation_.aim(), planned);
  const auto* made = std::get_if<calib::AimedTouch>(&aimed);
  return {.activity = run.kind() == RunKind::kTool ? HandActivity::kTool : HandActivity::kGuided,
          .plane = planned.face + 1,
          .index = run.touches_done() + 1,
          .total = run.touches_total(),
          .words = words_for(run, plane_words(cell_, run.recipe(), planned.face)),
          .problem = {},
          .about_joints = made ? made->touch.joints : planned.joints};
}

std::optional<HandGuide> ManualTouching::guide(State state) {
  if (state != State::kExecute) guide_.reset();
  if (!guide_) watch_.reset();
  return guide_;
}

void ManualTouching::on_controller_state(ActiveRun* active, const cs8::State& state) {
  if (!watch_) return;
  if (const auto touch = watch_->on_controller_state(state)) take_touch(active, *touch);
}

bool ManualTouching::takes_by_word(const ActiveRun* active) const {
  return watch_ && active && active->run.kind() == RunKind::kTool;
}

std::optional<std::string> ManualTouching::take(ActiveRun* active) {
  if (!takes_by_word(active)) return "no touch is awaited now";
  const auto taken = watch_->take_by_word();
  if (const auto* why = std::get_if<std::string>(&taken)) return *why;
  return take_touch(active, std::get<HandTouch>(taken));
}

/// Keeps a touch that can be the expected one; else returns the reason.
std::optional<std::string> ManualTouching::take_touch(ActiveRun* active, const HandTouch& touch) {
  const calib::PlannedTouch* planned = active ? active->run.next_here() : nullptr;
  if (!guide_ || !planned || status_.state() != State::kExecute) return "no touch is awaited now";
  std::optional<std::string> why = why_not(active->run, *planned, touch);
  if (taken_ || is_storing_ || undo_count_ > 0) why = "the one before was still being stored: touch again";
  if (why) {
    spdlog::info("touch by hand not taken: {}", *why);
    guide_->problem = why;
    status_.publish();
    return why;
  }
  cs8::TouchResult result;
  result.outcome = cs8::Outcome::kContact;
  result.source = cs8::CaptureSource::kPolled;
  result.contact = touch.wire_joints;
  result.edges = 1;
  taken_ = Taken{.run_id = active->run.id(),
                 .wanted = *planned,
                 .result = result,
                 .noise_um = own_noise_um(touch, active->run.problem().touch_noise_m)};
  wake_.wake();
  return std::nullopt;
}

asio::awaitable<void> ManualTouching::keep(ActiveRun& active, Taken taken) {
  is_storing_ = true;
  const bool kept = co_await touches_.keep(active, taken.wanted, taken.result, std::nullopt, taken.noise_um);
  is_storing_ = false;
  if (!kept) co_return;
  if (active.place_check) {
    if (const auto moved = active.place_check->check(active.run.problem().touches.back()))
      status_.raise(*moved, Event::kHoldFault);
  }
  status_.publish();
}

/// Why a touch cannot be the planned one; nothing when it can.
std::optional<std::string> ManualTouching::why_not(const Run& run, const calib::PlannedTouch& planned,
                                                   const HandTouch& touch) const {
  const char* what = run.kind() == RunKind::kTool ? "the tip" : "the ball";
  if (touch.moved_m && *touch.moved_m > kGuidedMovedMaxMetres) {
    return fmt::format("{} moved {:.2f} mm during the touch: approach more slowly, under 10 mm/s", what,
                       calib::mm_from_metres(*touch.moved_m));
  }
  const calib::PlanningProblem& problem = preparation_.problem();
  const calib::Face& face = problem.faces[static_cast<std::size_t>(planned.face)];
  const Eigen::Isometry3d tip = calib::forward_kinematics(preparation_.aim().model(), touch.joints);
  const calib::ContactSurface surface = calib::touched_surface(problem, planned.face);
  const Eigen::Vector3d ball_m = calib::ball_at_m(surface, tip);
  const double off_m = calib::signed_distance_m(surface, tip);
  const double miss_m = calib::ball_position_error_m(problem, planned.face);
  if (std::abs(off_m) > miss_m) {
    return fmt::format("{} was {:.0f} mm off plane {}: touch that one", what, calib::mm_from_metres(off_m),
                       planned.face + 1);
  }
  if (!is_over(face, ball_m, miss_m))
    return fmt::format("{} was beside plane {}: touch that one", what, planned.face + 1);
  for (const calib::Touch& made : run.problem().touches) {
    if (is_same_posture(made, planned.face, touch.joints))
      return "a touch in this posture was made before: turn the wrist or take another place on the plane";
  }
  return std::nullopt;
}

void ManualTouching::undo(const ActiveRun& active) {
  if (taken_) {
    taken_.reset();  // it is not stored yet
  } else {
    undo_count_ = std::min(undo_count_ + 1, active.run.touches_done() + (is_storing_ ? 1 : 0));
  }
  wake_.wake();
}

asio::awaitable<void> ManualTouching::withdraw_last(ActiveRun& active) {
  const auto write = [id = active.run.id(), number = active.run.touches().back().number](RunStore& store) {
    store.withdraw_touch(id, number, "a person took it back");
  };
  is_storing_ = true;
  const auto failure = co_await store_.write(write);
  is_storing_ = false;
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return;
  }
  active.run.withdraw_last();
  preparation_.restart_aim();
  guide_.reset();
  status_.publish();
}

}  // namespace cell
