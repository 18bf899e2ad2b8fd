#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/block_location.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/hold_time.hpp"
#include "service/acquisition/manual_touching.hpp"
#include "service/acquisition/plan_cache.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/run_computation.hpp"
#include "service/acquisition/run_planning.hpp"
#include "service/acquisition/run_recovery.hpp"
#include "service/acquisition/start_request.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/acquisition/way_back.hpp"
#include "service/base/clocks.hpp"
#include "service/store/run_page.hpp"

namespace cell {

struct Started {
  StoredRun run;          // as it was stored
  bool repeated = false;  // the same Idempotency-Key started it before
};

/// The cell in operation: the state and the run. Commands act at once on the state (run/packml_state.hpp);
/// one loop does what the state asks for, a step at a time, by the owners of what the step needs. One thread,
/// Threads::operation, but for what says that it is for any.
class CellOperation {
 public:
  /// Where it works: its own thread, that of a run's arithmetic (RunComputation), and that of the plans.
  struct Threads {
    boost::asio::any_io_executor operation;
    boost::asio::any_io_executor computation;
    boost::asio::any_io_executor planning;
  };

  /// `cell` and the store must outlive the operation; the store's executor and that of the computation must
  /// have ended their work when the operation is destroyed, which that of the plans need not.
  CellOperation(const Threads& threads, const Cell& cell, StoreQueue store, Endpoint controller,
                std::string instance_id, Clocks clocks);
  /// With a controller of any kind.
  CellOperation(const Threads& threads, const Cell& cell, StoreQueue store,
                std::unique_ptr<Controller> controller, std::string instance_id, Clocks clocks);
  CellOperation(const CellOperation&) = delete;
  CellOperation& operator=(const CellOperation&) = delete;

  /// Begins to look for the controller and to act on commands. Nothing moves before start().
  void launch();
  /// Stops a running motion and leaves the run on hold in the store, where the next daemon takes it up. Waits
  /// a few seconds for the controller's answer, then closes the link, on which the controller stops the arm.
  boost::asio::awaitable<void> shut_down();

  boost::asio::awaitable<std::variant<Started, CommandRefusal>> start(StartRequest request);
  /// `run_id` when the command names a run: it must be the active one.
  std::optional<CommandRefusal> command(Command command, std::optional<std::int64_t> run_id = {});
  /// Waits until a touch of a dialogue, or what takes one back, is on the disk: a few seconds at most, after
  /// which the status tells the touch before.
  boost::asio::awaitable<void> touch_stored();
  /// The commands that lead out of the present state and are taken now.
  [[nodiscard]] std::vector<Command> exits() const;

  /// Sets the file of the block's pose, and beside it that of the dialogue which finds it; call it before
  /// launch(). See BlockLocation::keep_in and keep_dialogue_in.
  void keep_place_in(const std::filesystem::path& file);
  /// The found pose of the block; empty while it is where the cell file says.
  [[nodiscard]] const std::optional<BlockPose>& place() const { return location_.place(); }

  [[nodiscard]] Status status() const;
  [[nodiscard]] std::uint64_t sequence() const { return status_.latest().sequence; }
  /// From any thread.
  [[nodiscard]] std::optional<std::int64_t> data_age_ms() const { return session_.data_age_ms(); }
  /// The controller's last reported state; empty before the first.
  [[nodiscard]] std::optional<cs8::State> controller_state() const { return session_.latest_state(); }
  /// Sets the one listener that is called at each change of the status.
  void on_change(std::function<void(const Status&)> listener) { status_.on_change(std::move(listener)); }
  /// Every precondition of a start that is not met now.
  [[nodiscard]] std::vector<Unmet> unmet_preconditions() const;
  /// The same with all that a start is refused for that brings nothing: also a place that the daemon before
  /// knew and that is lost, which touchcal locate finds, and a temperature of the block that is missing or
  /// too old, which a start may bring.
  [[nodiscard]] std::vector<Unmet> unmet_before_start() const;
  /// The run under way or the last one of this daemon; null before the first.
  [[nodiscard]] const Run* run() const { return run_ ? &run_->run : nullptr; }
  /// The same with what belongs to it.
  [[nodiscard]] const ActiveRun* active_run() const { return run_ ? &*run_ : nullptr; }
  /// The cell with its block at the last found pose.
  [[nodiscard]] const Cell& cell() const { return location_.cell(); }
  /// The same with place(), from any thread: a value that does not change.
  [[nodiscard]] std::shared_ptr<const LocatedCell> located_cell() const { return location_.located_cell(); }
  [[nodiscard]] const TipRegions& tip_regions() const { return location_.regions(); }
  /// Digest of the cell's files at the daemon's start.
  [[nodiscard]] const std::optional<std::string>& config_digest() const { return recovery_.config_digest(); }
  [[nodiscard]] const RunStore& store() const { return store_.store(); }
  [[nodiscard]] const Clocks& clocks() const { return clocks_; }

  /// Plans a recipe of this cell, unless it has been planned. Takes seconds, on Threads::planning.
  boost::asio::awaitable<PlanOutcome> plan_recipe(std::string name) { return plans_.plan(std::move(name)); }
  /// See PlanCache::hand_in(); call it before launch().
  void hand_in_plan(std::shared_ptr<const Plan> plan) { plans_.hand_in(std::move(plan)); }
  /// See BlockLocation::hand_in(); call it before launch().
  void hand_in_regions(TipRegions::Shared made) { location_.hand_in(std::move(made)); }
  /// What plan_recipe() gave; nothing before. A run by this recipe makes these touches.
  [[nodiscard]] std::optional<PlanOutcome> planned(const std::string& recipe) const {
    return plans_.planned(recipe);
  }
  [[nodiscard]] bool is_planning() const { return plans_.is_planning(); }
  /// Null when no plan made since the daemon began has this id.
  [[nodiscard]] std::shared_ptr<const Plan> plan_with_id(const std::string& id) const {
    return plans_.plan_with_id(id);
  }

 private:
  // commands and status (cell_operation.cpp)
  /// What the store knows before a start.
  struct Earlier {
    std::optional<StoredRun> with_key;  // that the same Idempotency-Key started
    RunPage last;                       // one, where there was any
  };
  [[nodiscard]] static std::optional<std::variant<Started, CommandRefusal>> repeated_start(
      const StartRequest& request, const Earlier& earlier);
  [[nodiscard]] static CommandRefusal refusal_at_the_end();
  [[nodiscard]] std::optional<CommandRefusal> refuse_start(const StartRequest& request) const;
  [[nodiscard]] std::vector<Unmet> unmet_for(const StartRequest& request) const;
  [[nodiscard]] std::vector<Unmet> unmet_whatever_is_given() const;
  boost::asio::awaitable<std::variant<Started, CommandRefusal>> start_alone(StartRequest request);
  boost::asio::awaitable<std::optional<CommandRefusal>> find_verification(StartRequest& request);
  boost::asio::awaitable<void> give_up(std::int64_t run_id);
  [[nodiscard]] NewRun new_run(const StartRequest& request) const;
  [[nodiscard]] std::optional<CommandRefusal> refusal_reason(Command command) const;
  [[nodiscard]] std::optional<CommandRefusal> refuse_answer_to_hold(Command command) const;
  [[nodiscard]] std::optional<CommandRefusal> refuse_undo() const;
  [[nodiscard]] bool is_ready_to_start() const;
  [[nodiscard]] bool is_way_back_due() const;
  [[nodiscard]] std::optional<State> after(Command command) const;
  void apply_command(Command command);
  std::optional<CommandRefusal> locate();
  std::optional<CommandRefusal> undo();
  std::optional<CommandRefusal> take();
  void look_for_mounted_tool();
  void look_for_tool(const StoredRun& last);
  void look_for_block();
  [[nodiscard]] std::optional<Unmet> unmet_by_tool() const;
  void on_entered(State state);
  void describe_to(Status& status);
  void store_fault(const std::string& name, const std::string& message);
  void forget_plans();
  void look_for_lost_place(const RunPage& last);
  [[nodiscard]] ActiveRun* active() { return run_ ? &*run_ : nullptr; }
  [[nodiscard]] bool is_interrupted() const { return run_ && run_->interruption; }
  [[nodiscard]] bool waits_for_its_files() const { return run_ && run_->open && run_->is_of_other_files(); }
  [[nodiscard]] std::string now_text() const;

  // what the controller tells (cell_operation_link.cpp)
  void on_controller_state(const cs8::State& state);
  void on_link_lost(const cs8::LinkError& error);
  void on_failed_hook(std::string why);
  [[nodiscard]] Event after_lost_link() const;
  [[nodiscard]] bool moves_without_run() const;

  // what the states do (cell_operation_loop.cpp)
  boost::asio::awaitable<void> act_on_states();
  boost::asio::awaitable<void> identify_run();
  boost::asio::awaitable<void> act_on(State state);
  boost::asio::awaitable<void> break_off(State state, std::string why);
  boost::asio::awaitable<void> reset();
  boost::asio::awaitable<void> await_readiness();
  boost::asio::awaitable<void> connect();
  boost::asio::awaitable<void> settle(std::uint32_t sequence);
  boost::asio::awaitable<void> start_run();
  boost::asio::awaitable<void> resume_run();
  [[nodiscard]] bool can_search();
  boost::asio::awaitable<bool> obtain_permit();
  [[nodiscard]] bool has_permit() const;
  void end_old_permit();
  [[nodiscard]] std::string resumption_text(bool looks_at_reference) const;
  boost::asio::awaitable<void> wait_out_suspension();
  boost::asio::awaitable<void> pass_block();
  boost::asio::awaitable<void> complete_run();

  // the end of a run, and with the daemon (cell_operation_end.cpp)
  /// How a run ended, which the disk did not take yet.
  struct UnstoredEnd {
    std::int64_t run_id = 0;
    RunKind kind = RunKind::kCalibration;
    RunEnd end;
    bool finished = false;          // as ActiveRun::finished
    std::optional<Fault> ended_by;  // what was shown before it could not be stored
    std::string told;               // that it could not be, as it is shown since
    std::chrono::steady_clock::time_point try_at;
  };
  boost::asio::awaitable<void> close_run(RunOutcome outcome);
  boost::asio::awaitable<std::optional<std::string>> store_end(UnstoredEnd closed);
  boost::asio::awaitable<void> store_end_again();
  [[nodiscard]] bool is_end_due() const;
  [[nodiscard]] std::optional<Unmet> unmet_by_unstored_end() const;
  [[nodiscard]] std::chrono::milliseconds quiet_wait() const;
  void break_off_for_end();
  boost::asio::awaitable<void> leave_for_next_daemon();
  boost::asio::awaitable<void> leave_face_once();
  boost::asio::awaitable<void> wait_for_end(std::chrono::milliseconds at_most);

  /// Where the coroutine runs, and its end.
  struct Loop {
    boost::asio::any_io_executor executor;
    TimerWake ended;
    bool runs = false;
    bool left_face = false;  // or tried to, at the end
    bool ends_pass = false;  // around the block, with the daemon and not by a person
  };

  StoreQueue store_;
  Clocks clocks_;
  TimerWake wake_;  // of the loop, when it has something to do
  PublishedStatus status_;
  std::unique_ptr<Controller> controller_;
  ControllerSession session_;
  HoldTime hold_time_;  // of the run
  BlockLocation location_;
  PlanCache plans_;
  TouchPreparation preparation_;
  RunPlanning planning_;
  RunComputation computation_;
  Parking parking_;
  BlockMove block_move_;
  TouchExecutor touches_;
  ManualTouching manual_;
  WayBack way_back_;
  RunRecovery recovery_;
  std::optional<ActiveRun> run_;
  std::optional<UnstoredEnd> unstored_end_;
  std::optional<Unmet> lost_place_;  // by the newest run, as it was read last
  /// The run that touched with a tool, until a person says that the probe is back: nothing moves the arm with
  /// it, as nobody knows its shape.
  std::optional<std::int64_t> run_of_tool_;
  /// A run may have left the block at another place than the first, and nobody has located it since.
  bool block_is_away_ = false;
  Loop loop_;
  bool is_starting_ = false;  // a start waits for the store
  bool is_settling_ = false;  // the run's last answer is asked for: it stays until that is stored
};

}  // namespace cell
