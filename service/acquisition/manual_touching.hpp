#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/acquisition/hand_touch.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/run/hand_guide.hpp"

namespace cell {

/// A guided run: a person makes its touches with the pendant, for a cell in which nothing is commanded yet.
/// Says which touch comes next, watches the controller's states for it, and keeps it as the touch executor
/// keeps one of its own. What cannot be the touch that is awaited is refused in words.
class ManualTouching {
 public:
  /// All must outlive it.
  ManualTouching(const Cell& cell, RunStore& store, ControllerSession& session, TouchPreparation& preparation,
                 TouchExecutor& touches, PublishedStatus& status, Wake& wake);

  /// Tells which touch comes next and waits for it; a touch that was taken wakes. The step is done
  /// (Event::kDone) when there is none left.
  boost::asio::awaitable<void> await_touch(ActiveRun& active);
  [[nodiscard]] bool awaits_touch() const { return watch_.has_value(); }
  /// Takes where the arm stands as the touch that is awaited: one must be. `active`: null without a run.
  std::optional<CommandRefusal> take(ActiveRun* active);
  /// A touch of a person who jogs, where one is awaited.
  void on_controller_state(ActiveRun* active, const cs8::State& state);
  /// The run's last touch is withdrawn and asked for again. The aim forgets it as well: it is made anew from
  /// all others.
  void undo(ActiveRun& active);
  /// What the person is told; nothing in another state than EXECUTE, which ends the watching.
  std::optional<HandGuide> guide(State state);

 private:
  [[nodiscard]] HandGuide guide_to(const Run& run) const;
  std::optional<std::string> take_touch(ActiveRun* active, const HandTouch& touch);
  [[nodiscard]] std::optional<std::string> why_not(const Run& run, const calib::PlannedTouch& planned,
                                                   const HandTouch& touch) const;

  const Cell& cell_;
  RunStore& store_;
  ControllerSession& session_;
  TouchPreparation& preparation_;
  TouchExecutor& touches_;
  PublishedStatus& status_;
  Wake& wake_;
  std::optional<HandTouchWatch> watch_;  // as long as touches are awaited
  std::optional<HandGuide> guide_;       // to the one that is
};

}  // namespace cell
