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

/// A touch as it is about to be commanded, and the path to it.
struct PreparedTouch {
  calib::AimedTouch aimed;
  calib::JointVector from;  // where the path begins
  std::vector<calib::JointVector> via;
  int aimed_with = 0;                                       // as StoredTouch::aimed_with
  calib::JointVector planned = calib::JointVector::Zero();  // the joints of the planned touch: which it is
};

/// A touch that leaves for the controller.
struct OutgoingTouch {
  calib::PlannedTouch touch;            // as it is aimed
  std::vector<calib::JointVector> via;  // to its clear posture
  int aimed_with = 0;                   // as StoredTouch::aimed_with
};

/// Which touch comes next, aimed with what the touches before it told, and the path there. It knows how the
/// last two touches were made, also those of the run before: from them the arm has a clear path to leave by.
/// Pure computation, milliseconds; the touch executor and, for a person's touches, the manual touching use
/// it. What cannot be made is nothing, and the log says why.
class TouchPreparation {
 public:
  /// A run: nothing is known of the arm but `problem`.
  void begin(calib::PlanningProblem problem);
  /// The block stands elsewhere: nothing of what was made holds.
  void forget_all();
  /// What is known of the arm is made anew from the touches.
  void restart_aim() { aim_.emplace(planning_); }

  /// The run's touches that the aim does not know yet; true when the others contradict the last of them.
  bool add_contacts(const Run& run);
  [[nodiscard]] const calib::PlanningProblem& problem() const { return planning_; }
  /// Of the run: there must be one.
  [[nodiscard]] const calib::OnlineArmEstimate& aim() const { return *aim_; }
  void set_aim(calib::OnlineArmEstimate aim) { aim_ = std::move(aim); }
  /// Where a touch of this face has the ball, along the outward normal, as the arm is known now; metres.
  [[nodiscard]] double height_m(int face, const calib::JointVector& joints) const;
  /// Whether a contact of the touch commanded last was farther off than its search was made for: what is
  /// known of the arm is wrong there.
  [[nodiscard]] bool is_surprise(const calib::JointVector& contact) const;

  /// The next touch was prepared from here.
  [[nodiscard]] bool is_ready_from(const calib::JointVector& joints) const;
  /// The touch that was prepared, when it is `next`, with another path: from here. True when there is one.
  bool reroute_from(const calib::JointVector& joints, const calib::PlannedTouch& next);
  /// The run's next touch, from here. One that cannot be made as it is aimed is made with the nominal miss,
  /// so that the plan's order stays; when there is no path to that either, it comes behind the others, once.
  /// False when it cannot be made then.
  bool prepare_next(Run& run, const calib::JointVector& joints);
  /// While the arm makes a touch: the one behind it, at this place of the plan.
  void look_ahead(Run& run, std::size_t place);
  /// A touch beside the plan, from here.
  [[nodiscard]] std::optional<PreparedTouch> prepare(calib::AimedTouch aimed,
                                                     const calib::JointVector& joints) const;
  /// A touch of the plan as it is aimed, or as the nominal arm makes it; or in a few words why not.
  [[nodiscard]] std::variant<calib::AimedTouch, std::string> aim_or_nominal(
      const calib::PlannedTouch& planned) const;

  /// The touch that was prepared leaves: it is the one commanded last from now on.
  OutgoingTouch send_next();
  OutgoingTouch send(PreparedTouch prepared);
  [[nodiscard]] const std::optional<calib::AimedTouch>& made() const { return made_; }
  /// From where the arm stood to the end of the search.
  [[nodiscard]] const std::vector<calib::JointVector>& made_path() const { return made_path_; }
  void set_made_path(std::vector<calib::JointVector> path) { made_path_ = std::move(path); }

  /// What was prepared is prepared anew.
  void drop_next() { next_.reset(); }
  /// The touch commanded last met nothing or something too early: it comes again with the nominal miss.
  void set_missed(bool missed) { missed_ = missed; }
  /// What was known of the arm may be wrong: no clear path to leave by is known.
  void forget_made();

  /// Where the arm leaves from. At the clear posture of one of the last two touches it leaves as that touch
  /// was made; broken off on the path between them, as the one that was known better, for which the path was
  /// clear. Anywhere else nothing is known. Valid until the next touch leaves.
  [[nodiscard]] calib::TransferEnd leaving(const calib::JointVector& joints) const;

  /// As it was when the run's last stored touch was made: the next one was aimed before its contact was
  /// known.
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
