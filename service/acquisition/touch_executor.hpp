#pragma once

#include <boost/asio/awaitable.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "calib_core/planning/aimed_touch.hpp"
#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/block_move.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/outlier_retest.hpp"
#include "service/acquisition/reference_monitor.hpp"
#include "service/acquisition/refused_contacts.hpp"
#include "service/acquisition/run_computation.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touch_judgement.hpp"
#include "service/acquisition/touch_preparation.hpp"

namespace cell {

/// What holds a run: a person's pause (kNothing), a touch of the plan or of the reference place that was not
/// made, a touch that the others contradict, the drift of the reference place, the wrong stylus, or a block
/// that a person is to bring to another place.
enum class HeldBy { kNothing, kTouch, kReference, kOutlier, kDrift, kStylus, kBlock };

/// Makes a run's touches, one after the other, each from its command to its place in the store:
///
///   prepare -> command -> answer -> judge -> keep (store, then Run::add) -> acknowledge
///
/// A contact counts when it is stored; only then may the controller forget it. One that is refused is stored
/// apart with the reason (store/refused_result.hpp) before the controller may forget it. The arm does not
/// wait for arithmetic: the estimate from the last touch and the path to the next are computed while it
/// moves, and what a contact changes in them while the disk writes it, both beside the link (RunComputation).
/// Behind the contact, on the same way to the disk, goes the command that follows, which leaves when both are
/// stored and nothing has come between. Called by the cell's loop in EXECUTE. Failures are raised at the
/// status and end the step; a lost link ends the step without a fault, which the controller's hook raises.
class TouchExecutor {
 public:
  /// All must outlive it.
  TouchExecutor(const Cell& cell, RunComputation& computation, StoreQueue& store, ControllerSession& session,
                TouchPreparation& preparation, BlockMove& block_move, PublishedStatus& status, Wake& wake,
                Clocks clocks);

  /// Begins a run, without a hold or a suspect.
  void begin_run(const ActiveRun& active);
  /// Continues a run after a restart: restores the reference place.
  boost::asio::awaitable<void> restore_reference(ActiveRun& active);

  /// The run was out of hands: its reference place, if it has one, is touched before the next touch.
  void look_at_reference() { reference_.make_due(); }

  /// Makes one touch: the retest of an outlier, the reference place or the next of the plan. Where no touch
  /// is left and none is to be made again, ends the step (Event::kDone), or has the block brought to the next
  /// place.
  boost::asio::awaitable<void> make_next_touch(ActiveRun& active);
  /// Computes the result of all touches so far, unless it exists.
  boost::asio::awaitable<void> identify(ActiveRun& active);
  /// No touch is left where the block stands: holds the run until it is at the next place.
  boost::asio::awaitable<void> ask_for_block(ActiveRun& active);
  /// The block has been brought to another place: what was known of touches beside the plan is of the last
  /// one.
  void begin_place();
  /// When a run continues after a restart: see TouchPreparation::recall().
  boost::asio::awaitable<void> recall(ActiveRun& active);
  /// When a run continues after a restart, or a contact was kept late: a last touch that the others
  /// contradict is made again before anything else. The estimate must be that without it.
  void suspect_last(const ActiveRun& active);
  /// Tells which of all touches do not fit the others, by the result of all: identify() before.
  void warn_of_outliers(ActiveRun& active);
  /// Stores a contact and adds it to the run; false when it could not be stored, which holds the run.
  /// `answered` is the command that it answers; empty where none is known. `noise_um` as in StoredTouch.
  boost::asio::awaitable<bool> keep(ActiveRun& active, calib::PlannedTouch planned, cs8::TouchResult result,
                                    std::optional<OpenTouch> answered,
                                    std::optional<double> noise_um = std::nullopt);
  /// Settles a result that the controller still has, of a run that has ended or is on hold: a contact in it
  /// is stored with that run, then the controller may forget it; also where an earlier daemon ended the run.
  /// One that tells of a collision or the like ends a run on hold. `active`: null without a run.
  boost::asio::awaitable<void> settle_open_command(ActiveRun* active, std::uint32_t sequence);

  [[nodiscard]] HeldBy held_by() const { return held_by_; }
  void forget_hold() { held_by_ = HeldBy::kNothing; }
  /// A person's answer to the hold. store_answer() follows before anything moves.
  void settle_hold(ActiveRun& active, Command command);
  /// What the answer changes in the plan is stored, then it counts. False when it could not be stored: the
  /// run is held again, as before the answer.
  boost::asio::awaitable<bool> store_answer(ActiveRun& active);
  /// Whether the answer that was stored last says that the block stands at another place.
  [[nodiscard]] bool take_moved_block() { return std::exchange(has_moved_block_, false); }
  /// Goes on from the hold.
  [[nodiscard]] Command answer_to_hold() const { return answer_; }

 private:
  boost::asio::awaitable<bool> prepare(ActiveRun& active);
  void hold_without_way(bool can_leave, const std::string& to, HeldBy held_by);
  boost::asio::awaitable<bool> keep_open_command(ActiveRun& active, OpenTouch open);
  std::optional<OpenTouch> command_behind(const ActiveRun& active, bool contradicted) const;
  bool take_stored_ahead(const Run& run);
  boost::asio::awaitable<void> work_ahead(ActiveRun& active);
  void tell_left_out(const Run& run, int dropped);
  boost::asio::awaitable<void> take_contact(ActiveRun& active, OpenTouch open, cs8::TouchResult result);
  /// A contact on its way to the store.
  struct Storing {
    StoredTouch touch;
    StoreQueue::Begun begun;
    std::shared_ptr<bool> total_stored;
  };
  Storing begin_storing(const Run& run, const calib::PlannedTouch& planned, const cs8::TouchResult& result,
                        const std::optional<OpenTouch>& answered,
                        std::optional<double> noise_um = std::nullopt);
  boost::asio::awaitable<bool> finish_storing(ActiveRun& active, Storing storing, std::uint32_t edges,
                                              std::function<void(RunStore&)> behind);
  void tell_kept();
  boost::asio::awaitable<bool> aim_ahead(ActiveRun& active, StoredTouch touch);
  // What is answered (touch_executor_answers.cpp).
  boost::asio::awaitable<bool> accept(ActiveRun& active, calib::PlannedTouch touch, std::uint32_t sequence,
                                      cs8::TouchResult result, HeldBy held_by);
  bool deal_with(const ActiveRun& active, const calib::PlannedTouch& touch, const TouchJudgement& judged,
                 const cs8::TouchResult& result, HeldBy held_by);
  void take_no_measurement(const ActiveRun& active, const calib::PlannedTouch& touch,
                           const TouchJudgement& judged, HeldBy held_by);
  void tell_end_of_unknown(const cs8::QueryReply& reply);
  void take_rejection(const cs8::Rejected& rejected, HeldBy held_by);
  boost::asio::awaitable<bool> keep_late_touch(ActiveRun& active, OpenTouch open, cs8::TouchResult result);
  void aim_behind_late_touch(const ActiveRun& active, const calib::JointVector& contact);
  boost::asio::awaitable<bool> refuse(std::optional<std::int64_t> run_id, AnsweredCommand command,
                                      cs8::TouchResult result, std::string reason);
  void tell_unstored(const std::string& failure);
  void leave_unstored(const ActiveRun* active);
  void forget_stored_command(std::int64_t run_id);

  // Beside the plan (touch_executor_beside_plan.cpp).
  boost::asio::awaitable<bool> touch_beside_plan(ActiveRun& active, calib::AimedTouch aimed, HeldBy held_by);
  boost::asio::awaitable<void> work_beside_plan(ActiveRun& active, HeldBy held_by, calib::JointVector from);
  void settle_beside_plan();
  boost::asio::awaitable<void> touch_reference(ActiveRun& active);
  boost::asio::awaitable<bool> aim_at_reference(ActiveRun& active);
  boost::asio::awaitable<std::optional<PreparedTouch>> prepare_beside_plan(ActiveRun& active,
                                                                           calib::AimedTouch aimed,
                                                                           HeldBy held_by);
  boost::asio::awaitable<void> doubt_reference(std::int64_t run_id, ReferenceMonitor::Doubt doubt);
  boost::asio::awaitable<bool> refuse_beside_plan(std::int64_t run_id);
  void judge_reference(const ActiveRun& active);
  boost::asio::awaitable<void> retest_outlier(ActiveRun& active);
  boost::asio::awaitable<bool> replace(ActiveRun& active, OutlierRetest::Replaced replaced);
  boost::asio::awaitable<bool> confirm(ActiveRun& active, StoredTouch again);
  boost::asio::awaitable<bool> leave_out(ActiveRun& active, bool outlier);

  // When all touches of the plan are made (touch_executor_at_end.cpp).
  boost::asio::awaitable<void> end_touches(ActiveRun& active);
  std::vector<int> suspects(ActiveRun& active);
  bool suspect_one(const Run& run, const std::vector<int>& suspects);

  const Cell& cell_;
  RunComputation& computation_;
  StoreQueue& store_;
  ControllerSession& session_;
  TouchPreparation& preparation_;
  BlockMove& block_move_;
  PublishedStatus& status_;
  Wake& wake_;
  Clocks clocks_;
  RefusedContacts refused_;
  TouchHistory history_;
  ReferenceMonitor reference_;
  OutlierRetest outlier_;
  /// The contact of a touch beside the plan until it is stored: the controller has it as well.
  struct BesidePlan {
    std::uint32_t session = 0;
    std::uint32_t sequence = 0;
    cs8::TouchResult result;
    std::string captured_at;
    std::optional<std::string> refused = {};  // why it is no measurement, which is not stored yet
  };
  [[nodiscard]] bool is_beside_plan(std::uint32_t sequence) const {
    return beside_plan_ && beside_plan_->session == session_.number() && beside_plan_->sequence == sequence;
  }
  std::optional<BesidePlan> beside_plan_;
  /// A touch that is stored, for the log: it is written behind the command that follows.
  struct KeptLine {
    std::int64_t run_id = 0;
    StoredTouch touch;
    std::uint32_t edges = 0;
  };
  std::optional<KeptLine> kept_;
  std::optional<OpenTouch> stored_ahead_;         // the command that leaves next, when it is stored already
  std::optional<PreparedTouch> reference_ahead_;  // the way to the reference place, when it is touched next
  bool total_is_due_ = false;  // the run's number of touches has changed and is not stored yet
  int false_trigger_count_ = 0;
  bool stylus_allowed_ = false;  // by a person
  HeldBy held_by_ = HeldBy::kNothing;
  Command answer_ = Command::kResume;
  std::optional<HeldBy> leaves_out_;  // by a person's answer, which is not stored yet
  bool takes_block_word_ = false;     // likewise
  bool has_moved_block_ = false;      // stored, and not looked at yet
};

}  // namespace cell
