#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/hand_touch.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/run/hand_guide.hpp"

namespace cell {

/// A guided run: a person makes the touches with the pendant, in a cell where the arm is not commanded.
/// Shows which touch comes next, watches the controller's states for it, and stores it as the touch executor
/// does. A contact that cannot be the expected touch is refused with the reason.
class ManualTouching {
 public:
  /// All must outlive it.
  ManualTouching(const Cell& cell, StoreQueue& store, TouchPreparation& preparation, TouchExecutor& touches,
                 PublishedStatus& status, Wake& wake);

  /// A run begins: nothing of the one before is to be stored or taken back.
  void begin_run();
  /// Stores what was touched or taken back; else shows which touch comes next and waits for it. Ends the step
  /// (Event::kDone) when no touch is left.
  boost::asio::awaitable<void> await_touch(ActiveRun& active);
  [[nodiscard]] bool awaits_touch() const { return watch_.has_value(); }
  /// Watches for a touch by a person who jogs, while one is expected.
  void on_controller_state(ActiveRun* active, const cs8::State& state);
  /// Whether a person's word makes a touch, see take(): of a tool, whose tip may trip nothing.
  [[nodiscard]] bool takes_by_word(const ActiveRun* active) const;
  /// Takes the present position as the touch that is awaited; or says why not.
  std::optional<std::string> take(ActiveRun* active);
  /// Withdraws the run's last touch and asks for it again. The online estimate is made again from the others.
  void undo(const ActiveRun& active);
  /// The instruction shown to the person; empty outside EXECUTE, where the watch ends.
  std::optional<HandGuide> guide(State state);

 private:
  /// A touch that is the expected one and is not stored yet.
  struct Taken {
    std::int64_t run_id = 0;
    calib::PlannedTouch wanted;
    cs8::TouchResult result;
    std::optional<double> noise_um;  // as StoredTouch::noise_um
  };

  boost::asio::awaitable<void> keep(ActiveRun& active, Taken taken);
  boost::asio::awaitable<void> withdraw_last(ActiveRun& active);
  /// Of the tip that makes the next touch: how far its ball moves is what counts.
  void watch_ball_of(int face);
  [[nodiscard]] HandGuide guide_to(const Run& run) const;
  std::optional<std::string> take_touch(ActiveRun* active, const HandTouch& touch);
  [[nodiscard]] std::optional<std::string> why_not(const Run& run, const calib::PlannedTouch& planned,
                                                   const HandTouch& touch) const;

  const Cell& cell_;
  StoreQueue& store_;
  TouchPreparation& preparation_;
  TouchExecutor& touches_;
  PublishedStatus& status_;
  Wake& wake_;
  std::optional<HandTouchWatch> watch_;  // as long as touches are awaited
  std::size_t watched_tip_ = 0;          // whose ball it watches
  std::optional<HandGuide> guide_;       // to the one that is
  std::optional<Taken> taken_;
  bool is_storing_ = false;
  int undo_count_ = 0;  // touches to be taken back
};

}  // namespace cell
