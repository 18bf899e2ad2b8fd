#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "service/acquisition/wake.hpp"
#include "service/base/clocks.hpp"
#include "service/run/status.hpp"

namespace cell {

/// The owner of the state and of the status that supervisors poll. Every part of the acquisition reports
/// here: faults, warnings, ends of steps. A setter does not publish; the next publish() does. One thread.
class PublishedStatus {
 public:
  /// What the status needs of the others; called from inside the calls below.
  struct Hooks {
    std::function<void(Status&)> describe;  // brings everything up to date, before each publication
    std::function<void(State)> on_entered;  // a new state, before it is published
    /// A fault is kept, by its name and message. What it throws is logged.
    std::function<void(const std::string& name, const std::string& message)> store_fault;
  };

  /// `wake` must outlive it: it is woken at each new state.
  PublishedStatus(Clocks clocks, Wake& wake, std::string instance_id, Hooks hooks);

  [[nodiscard]] State state() const { return status_.state; }
  [[nodiscard]] const Status& latest() const { return status_; }
  [[nodiscard]] const std::optional<Fault>& fault() const { return status_.fault; }
  /// Sets the one listener that is called at each change.
  void on_change(std::function<void(const Status&)> listener) { status_listener_ = std::move(listener); }

  /// Does nothing when it is the present state.
  void enter(State state);
  /// Enters the state that the state machine gives for the event.
  void apply(Event event);
  /// A fault: logged, kept, published; then its event.
  void raise(Fault fault, Event event);
  /// The same for a fault that is there once more: published, neither logged nor kept again.
  void show(Fault fault, Event event);
  /// Published and logged while the run goes on.
  void warn(Fault fault);
  /// What this warning told of is over: the one before it is shown again. Nothing where it is not shown.
  void end_warning(FaultCode code);
  void publish();

  /// The daemon ends: nothing new begins.
  void end() { is_ending_ = true; }
  [[nodiscard]] bool is_ending() const { return is_ending_; }

  void set_fault(Fault fault) { status_.fault = std::move(fault); }
  void clear_fault() { status_.fault.reset(); }
  /// What the cell waits for from a person, and what to do; published when it changes.
  void wait_for(std::optional<std::string> name);
  /// A run: without a fault, a warning or a verdict yet.
  void begin_run(std::int64_t run_id);
  /// No run: a pass around the block is not one.
  void forget_run();
  void set_verdict(Verdict verdict) { status_.verdict = verdict; }
  void set_last_accepted(std::int64_t run_id, std::optional<std::string> at);
  void set_reference_drift(double drift_m) { status_.reference_drift_m = drift_m; }

 private:
  Clocks clocks_;
  Wake& wake_;
  Hooks hooks_;
  Status status_;
  std::optional<Fault> warning_before_;  // the one that is shown
  std::function<void(const Status&)> status_listener_;
  bool is_ending_ = false;
};

}  // namespace cell
