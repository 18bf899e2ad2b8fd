#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "cs8_protocol/client.hpp"
#include "service/acquisition/locating.hpp"
#include "service/acquisition/touch_judgement.hpp"
#include "service/acquisition/touched_again.hpp"
#include "service/documents/plan.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/packml_state.hpp"
#include "service/run/readiness.hpp"
#include "service/run/run.hpp"
#include "service/run/status.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// One thing that stands in the way of a start.
struct Unmet {
  std::string code;    // "not_powered"
  std::string detail;  // what to do
};

/// Why a command was not taken.
struct CommandRefusal {
  enum class Kind { kState, kPreconditions, kUnknownRecipe, kNotThisRun, kOtherKey };
  Kind kind = Kind::kState;
  std::string detail;
  std::vector<Unmet> unmet;       // all of them at once
  std::optional<FaultCode> code;  // its entry in the fault table
};

/// What a run is asked for with.
struct StartRequest {
  std::string recipe;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> operator_name;
  bool guided = false;  // a person makes the touches with the pendant; nothing is commanded
};

struct Started {
  std::int64_t run_id = 0;
  bool repeated = false;  // the same Idempotency-Key started it before
};

/// A recipe's plan, or why there is none: the same whenever it is asked for.
using PlanOutcome = std::variant<std::shared_ptr<const Plan>, PlanRefusal>;

/// A fault of the link ends by itself when there is a link again.
bool is_link_fault(FaultCode code);

/// A failure of the link as a fault.
Fault link_fault(const cs8::LinkError& error);

/// The cell in operation: the state, the run, the link. Commands act at once on the state
/// (state_machine.hpp); the coroutine drive() does what the state asks for, one touch at a time. One thread:
/// that of the executor.
class Operation {
 public:
  using Clock = std::function<std::chrono::system_clock::time_point()>;

  /// `cell` and `store` must outlive the operation.
  Operation(boost::asio::any_io_executor executor, const Cell& cell, RunStore& store, Endpoint controller,
            std::string instance_id, Clock clock);
  ~Operation();
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;

  /// Begins to look for the controller and to act on commands. Nothing moves before start().
  void launch();
  /// Ends all: a running motion is stopped, the run is closed as stopped. Waits a few seconds for the
  /// controller's answer; after that the link is cut, on which the controller stops by itself.
  boost::asio::awaitable<void> shut_down();

  std::variant<Started, CommandRefusal> start(const StartRequest& request);
  /// `run_id` when the command names a run: it must be the active one.
  std::optional<CommandRefusal> command(Command command, std::optional<std::int64_t> run_id = {});
  /// The commands that lead out of the present state and are taken now.
  [[nodiscard]] std::vector<Command> exits() const;

  /// Where the place of the block is kept; to be told before launch(). One that is there is used, unless it
  /// is of another cell. Throws what cannot be read.
  void keep_place_in(const std::filesystem::path& file);
  /// Where the block was found; nothing as long as it stands where the cell's file says.
  [[nodiscard]] const std::optional<BlockPose>& place() const { return place_; }

  [[nodiscard]] Status status() const;
  [[nodiscard]] std::uint64_t sequence() const { return status_.sequence; }
  [[nodiscard]] std::optional<std::int64_t> data_age_ms() const;
  /// As the controller told it last; nothing before it has.
  [[nodiscard]] std::optional<cs8::State> controller_state() const { return client_.latest_state(); }
  /// Whoever is told each change of the status, at once; one at a time.
  void on_change(std::function<void(const Status&)> told) { told_ = std::move(told); }
  /// All that stands in the way of a start now.
  [[nodiscard]] std::vector<Unmet> unmet_preconditions() const;
  /// The run under way or the last one of this daemon; null before the first.
  [[nodiscard]] const Run* run() const { return run_ ? &*run_ : nullptr; }
  /// The result document of run(), as json text; nothing before there is a result.
  [[nodiscard]] std::optional<std::string> result_json() const;
  /// With its block where it was found last.
  [[nodiscard]] const Cell& cell() const { return cell_; }
  [[nodiscard]] const TipRegions& tip_regions() const { return *tip_regions_; }
  [[nodiscard]] const RunStore& store() const { return store_; }

  /// Plans a recipe of this cell, unless it has been planned. Takes seconds, on a thread of its own.
  boost::asio::awaitable<PlanOutcome> plan_recipe(std::string name);
  /// What plan_recipe() gave; nothing before. A run by this recipe makes these touches.
  [[nodiscard]] std::optional<PlanOutcome> planned(const std::string& recipe) const;
  [[nodiscard]] bool is_planning() const { return plans_under_way_ > 0; }
  /// Null when no plan made since the daemon began has this id.
  [[nodiscard]] std::shared_ptr<const Plan> plan_with_id(const std::string& id) const;

 private:
  // commands and status (operation.cpp)
  boost::asio::awaitable<void> wait_for_end(std::chrono::milliseconds at_most);
  [[nodiscard]] std::optional<CommandRefusal> objection(Command command) const;  // commands.cpp
  void heed(Command command);                                                    // commands.cpp
  void enter(State state);
  void apply(Event event);
  void raise(Fault fault, Event event);
  void publish();
  void hear(const cs8::State& state);
  void hear_permit(const cs8::Permit& permit);
  void lose(const cs8::LinkError& error);
  [[nodiscard]] std::vector<Unmet> unmet_for(const std::string& recipe) const;
  [[nodiscard]] ControllerView controller_view() const;
  [[nodiscard]] std::string now_text() const;

  // a person's word before anything moves (permission.cpp)
  boost::asio::awaitable<bool> get_permission();
  boost::asio::awaitable<void> wait_until_readier(std::optional<cs8::State> told,
                                                  std::chrono::steady_clock::time_point at_latest);
  void wait_for(const AwaitedAction* awaited);
  [[nodiscard]] bool is_permitted() const;
  [[nodiscard]] std::uint32_t permit_number() const;

  // going on with a run that an earlier daemon left open (resumption.cpp)
  void restore_run();
  [[nodiscard]] Event link_down() const;
  boost::asio::awaitable<bool> make_resumable();
  boost::asio::awaitable<bool> plan_again();
  void recall_aim();
  bool keep_open_command();

  // what the states do (drive.cpp, link.cpp)
  boost::asio::awaitable<void> drive();
  boost::asio::awaitable<void> reset();
  boost::asio::awaitable<void> start_run();
  boost::asio::awaitable<void> resume_run();
  boost::asio::awaitable<void> outlast_suspension();
  boost::asio::awaitable<bool> plan();
  boost::asio::awaitable<void> make_next_touch();
  void identify();
  bool keep_touch(const calib::PlannedTouch& planned, const cs8::TouchResult& result);
  void take_contact(const calib::PlannedTouch& planned, const cs8::TouchReply& reply,
                    const cs8::TouchResult& result);
  boost::asio::awaitable<void> complete_run();
  boost::asio::awaitable<bool> park();
  boost::asio::awaitable<std::optional<cs8::State>> settled_state();
  boost::asio::awaitable<void> settle_open_command(std::uint32_t sequence);
  void acknowledge(std::uint32_t sequence);
  boost::asio::awaitable<std::optional<calib::JointVector>> standing_joints();
  boost::asio::awaitable<void> leave_face();
  boost::asio::awaitable<void> connect();
  boost::asio::awaitable<void> wait_for_wake(std::chrono::milliseconds at_most);
  bool take_move(const cs8::MoveReply& reply);
  void expect_stop(cs8::Outcome outcome);
  bool keep_late_touch(const calib::PlannedTouch& planned, const cs8::TouchResult& result);
  void close_run(RunOutcome outcome);

  /// A touch as it is about to be commanded, and the way to it.
  struct PreparedTouch {
    calib::AimedTouch aimed;
    calib::JointVector from;  // where the way begins
    std::vector<calib::JointVector> via;
    int aimed_with = 0;                                       // as StoredTouch::aimed_with
    calib::JointVector planned = calib::JointVector::Zero();  // the joints of the planned touch: which it is
  };

  /// What keeps a run on hold: a person's pause (nothing), a touch that was not made, of the plan or at the
  /// reference place, one that the others contradict, the drift of the reference or the wrong stylus.
  enum class HeldBy { kNothing, kTouch, kReference, kMisfit, kDrift, kStylus };

  // touches judged, and made beside the plan (touched_again.cpp)
  void warn(Fault fault);
  void begin_checks();
  bool accept(const calib::PlannedTouch& touch, std::uint32_t sequence, const cs8::TouchResult& result,
              HeldBy held_by);
  [[nodiscard]] double height_m(int face, const calib::JointVector& joints) const;
  boost::asio::awaitable<std::optional<cs8::TouchResult>> touch_apart(calib::AimedTouch aimed,
                                                                      HeldBy held_by);
  void note_reference_place(const calib::PlannedTouch& planned, const cs8::TouchResult& result);
  void restore_reference();
  [[nodiscard]] bool reference_due() const;
  boost::asio::awaitable<void> touch_reference();
  void judge_reference(const calib::JointVector& joints);
  void watch_fit();
  boost::asio::awaitable<void> touch_misfit_again();
  void settle_hold(Command command);

  // touches by hand, and where the block is (by_hand.cpp, guided.cpp)
  std::optional<CommandRefusal> locate();
  std::optional<CommandRefusal> take();
  std::optional<CommandRefusal> undo();
  void hear_by_hand(const cs8::State& state);
  void tell_guide();
  [[nodiscard]] std::vector<Unmet> unmet_for_hands(const std::string& recipe) const;
  std::optional<std::string> take_by_hand(const HandTouch& touch);
  void leave_locating();
  boost::asio::awaitable<void> await_guided_touch();
  std::optional<std::string> take_guided(const HandTouch& touch);
  [[nodiscard]] std::optional<CommandRefusal> refuse_undo() const;
  void undo_guided();
  std::optional<CommandRefusal> begin_pass();
  boost::asio::awaitable<void> pass_block();
  boost::asio::awaitable<bool> go_around_block();
  void keep_found_place();
  void use_place(BlockPose place);
  void begin_place_check();
  void check_place(const calib::Touch& touch);
  [[nodiscard]] Fault placed_fault(Fault fault, int face) const;

  // which touch comes next, aimed with what the touches before it told (aiming.cpp)
  void begin_aim();
  bool learn();
  boost::asio::awaitable<bool> prepare_touch();
  void look_ahead();
  void stop_when_good_enough(std::size_t first);
  std::optional<PreparedTouch> prepared(std::size_t index, const calib::TransferEnd& from);
  [[nodiscard]] std::optional<PreparedTouch> with_way(std::variant<calib::AimedTouch, std::string> made,
                                                      const calib::TransferEnd& from) const;
  [[nodiscard]] calib::TransferEnd leaving(const calib::JointVector& joints) const;
  void forget_made();
  [[nodiscard]] bool is_surprise(const calib::JointVector& contact) const;

  /// What an earlier daemon left of the run.
  struct Interrupted {
    std::optional<std::string> plan_id;
    std::vector<PlanChange> plan_changes;
  };

  /// A touch whose result was not acknowledged yet: the controller still has it.
  struct OpenTouch {
    std::uint32_t session = 0;
    std::uint32_t sequence = 0;
    calib::PlannedTouch planned;  // as it was aimed
    int aimed_with = 0;           // as StoredTouch::aimed_with
  };

  boost::asio::any_io_executor executor_;
  const Cell& configured_;                 // as its file has it
  Cell cell_;                              // with the block where it was found
  std::optional<TipRegions> tip_regions_;  // of cell_
  RunStore& store_;
  Endpoint endpoint_;
  Clock clock_;
  cs8::Client client_;
  boost::asio::thread_pool planner_{1};  // planning takes seconds; the thread of the sockets must not wait
  boost::asio::steady_timer wake_;       // cancelled when drive() has something to do
  boost::asio::steady_timer ended_;      // cancelled when drive() has ended

  /// The controller's application and its version, as it told; and the run's conditions, as kept with it.
  std::optional<std::string> controller_application_;
  std::string conditions_;

  Status status_;
  std::function<void(const Status&)> told_;  // of changes
  std::optional<Run> run_;
  bool run_finished_ = false;                        // complete, and stored as such
  bool run_open_ = false;                            // begun in the store, not finished there
  std::optional<Interrupted> interrupted_;           // until somebody resumes the run
  std::optional<std::string> config_digest_;         // of the cell's files
  std::size_t stored_changes_ = 0;                   // of the run's plan
  std::chrono::system_clock::time_point run_began_;  // to touch
  std::map<std::string, PlanOutcome> plans_;         // by recipe
  int plans_under_way_ = 0;                          // on the planner's thread, or waiting for it
  calib::PlanningProblem planning_;                  // of the run
  std::optional<calib::JointVector> standing_;   // where the last command left the arm, when that is certain
  std::optional<calib::OnlineArmEstimate> aim_;  // of the run
  std::optional<calib::AimedTouch> made_;        // commanded last
  std::optional<calib::AimedTouch> before_;      // ... and the one before
  std::vector<calib::JointVector> made_way_;     // from where the arm stood to the end of its search
  bool missed_ = false;  // its search met nothing: it comes again with the nominal miss
  /// The next touch, found while the arm makes the one before; as long as the arm is there.
  std::optional<PreparedTouch> ahead_;
  HeldBy held_by_ = HeldBy::kNothing;
  TouchHistory history_;
  std::optional<ReferencePlace> reference_;
  std::optional<Misfit> misfit_;
  int false_trigger_count_ = 0;
  bool stylus_allowed_ = false;            // by a person, for this run
  std::optional<std::uint32_t> overruns_;  // of the controller's tasks, as it told
  std::uint32_t unsettled_sequence_ = 0;   // an open command met in a state that does not settle it
  Command answer_ = Command::kResume;      // to the hold, while the run goes on from it
  std::uint32_t session_ = 0;              // of the controller's application
  std::optional<OpenTouch> open_touch_;
  std::chrono::steady_clock::time_point told_at_;  // when the controller told its newest state
  std::int32_t task_error_ = 0;                    // as it told then
  int inputs_disagree_count_ = 0;                  // newest states of the controller in a row
  std::optional<HandTouchWatch> hand_watch_;       // as long as touches by hand are awaited
  std::optional<Locating> locating_;
  bool guided_ = false;                   // the run's touches are made by hand
  std::optional<HandGuide> guide_;        // ... the one that is awaited
  bool passing_ = false;                  // once around the block, without a run
  std::vector<calib::JointVector> pass_;  // postures of it
  std::optional<BlockPose> place_;
  int place_count_ = 0;               // of places used: a plan made with an older one is none
  std::filesystem::path place_file_;  // empty: nowhere
  std::optional<calib::OnlineArmEstimate> place_check_;  // of the run, with the touches that found the place
  std::set<int> faces_met_;                              // by the run, as long as the place is checked
  bool asking_ = false;                                  // for a permit
  bool shutting_down_ = false;
  bool driving_ = false;
};

}  // namespace cell
