#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "service/run/run.hpp"

namespace cell {

/// A touch ready to be commanded, and the path to it.
struct PreparedTouch {
  calib::AimedTouch aimed;
  calib::JointVector from;  // where the path begins
  std::vector<calib::JointVector> via;
  int aimed_with = 0;                                       // as StoredTouch::aimed_with
  calib::JointVector planned = calib::JointVector::Zero();  // the joints of the planned touch: which it is
};

/// From where the arm stands to the end of the search.
std::vector<calib::JointVector> path_of(const PreparedTouch& prepared);

/// A touch to send to the controller.
struct OutgoingTouch {
  calib::PlannedTouch touch;            // as it is aimed
  std::vector<calib::JointVector> via;  // to its clear posture
  int aimed_with = 0;                   // as StoredTouch::aimed_with
};

/// Chooses the next touch, aims it with the estimate from the touches before, and finds the path there. It
/// keeps how the last two touches were made, also those of the run before: the arm leaves along their clear
/// paths. Pure computation, milliseconds; used by the touch executor and by manual touching. A touch that
/// cannot be prepared gives an empty result, and the log says why.
class TouchPreparation {
 public:
  /// Begins a run with no estimate of the arm but `problem`.
  void begin(calib::PlanningProblem problem);
  /// Discards everything prepared: the block was found elsewhere.
  void forget_all();
  /// Makes the estimate again from the touches.
  void restart_aim() { aim_.emplace(planning_); }

  /// Adds the run's new touches to the estimate; true when the others contradict the last of them.
  bool add_contacts(const Run& run);
  /// Adds the contact that becomes the run's next touch once it is stored; true when the others contradict
  /// it. Where it is not stored after all, set_aim() puts the estimate back.
  bool add_ahead(const Run& run, const calib::Touch& touch);
  [[nodiscard]] const calib::PlanningProblem& problem() const { return planning_; }
  /// The run's estimate; there must be a run.
  [[nodiscard]] const calib::OnlineArmEstimate& aim() const { return *aim_; }
  void set_aim(calib::OnlineArmEstimate aim) { aim_ = std::move(aim); }
  /// The ball's height along the face's outward normal at a touch, by the present estimate; metres.
  [[nodiscard]] double height_m(int face, const calib::JointVector& joints) const;
  /// True when the contact of the last commanded touch was farther off than its search allowed for: the
  /// estimate is wrong there.
  [[nodiscard]] bool is_surprise(const calib::JointVector& contact) const;

  /// True when the next touch was prepared from here.
  [[nodiscard]] bool is_ready_from(const calib::JointVector& joints) const;
  /// The prepared touch; nothing when there is none.
  [[nodiscard]] const std::optional<PreparedTouch>& next() const { return next_; }
  /// Gives the prepared touch a path from here, when it is `next`. True when there is one.
  bool reroute_from(const calib::JointVector& joints, const calib::PlannedTouch& next);
  /// Prepares the run's next touch from here. A touch that cannot be made as aimed is made with the nominal
  /// miss, which keeps the plan's order; without a path to that either, it is put off to the end, once. False
  /// when it cannot be made then, or the arm cannot leave.
  bool prepare_next(Run& run, const calib::JointVector& joints);
  /// Whether a clear path leads from here to the park posture: after a hold the arm stands where a person
  /// left it, and where it cannot leave, no touch is to blame.
  [[nodiscard]] bool can_leave(const calib::JointVector& joints) const;
  /// Prepares the touch after the one under way, at this position in the plan.
  void look_ahead(Run& run, std::size_t place);
  /// Prepares a touch outside the plan, from here.
  [[nodiscard]] std::optional<PreparedTouch> prepare(calib::AimedTouch aimed,
                                                     const calib::JointVector& joints) const;
  /// A touch of the plan as aimed, or as the nominal arm makes it; or the reason why neither can be made.
  [[nodiscard]] std::variant<calib::AimedTouch, std::string> aim_or_nominal(
      const calib::PlannedTouch& planned) const;

  /// Hands out the prepared touch, which becomes the last commanded one.
  OutgoingTouch send_next();
  OutgoingTouch send(PreparedTouch prepared);
  [[nodiscard]] const std::optional<calib::AimedTouch>& made() const { return made_; }
  /// From where the arm stood to the end of the search.
  [[nodiscard]] const std::vector<calib::JointVector>& made_path() const { return made_path_; }
  void set_made_path(std::vector<calib::JointVector> path) { made_path_ = std::move(path); }

  /// Discards the prepared touch, so that it is prepared again.
  void drop_next() { next_.reset(); }
  /// The last commanded touch found nothing, or something too early: it is repeated with the nominal miss.
  void set_missed(bool missed) { missed_ = missed; }
  /// The estimate may be wrong: discards the clear paths to leave by.
  void forget_made();

  /// The touch from which the arm leaves: one of the last two, when the arm is at its clear posture; on the
  /// path between them, the one that was known better, for which the path was clear. Null anywhere else.
  /// Valid until the next take().
  [[nodiscard]] calib::TransferEnd leaving(const calib::JointVector& joints) const;

  /// The estimate before the run's last stored touch: the next touch was aimed before that contact was known.
  void recall(Run& run);

 private:
  std::optional<PreparedTouch> prepared(Run& run, std::size_t place, const calib::TransferEnd& from);
  [[nodiscard]] std::optional<PreparedTouch> with_path(std::variant<calib::AimedTouch, std::string> made,
                                                       const calib::TransferEnd& from) const;

  calib::PlanningProblem planning_;              // of the run
  std::optional<calib::OnlineArmEstimate> aim_;  // of the run
  std::optional<calib::AimedTouch> made_;        // commanded last
  std::optional<calib::AimedTouch> before_;      // ... and the one before
  std::vector<calib::JointVector> made_path_;
  bool missed_ = false;
  std::optional<PreparedTouch> next_;  // as long as the arm is where its path begins
};

}  // namespace cell
