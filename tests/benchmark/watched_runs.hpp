#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/benchmark/measured_cell.hpp"

namespace bench {

/// A daemon is to be ready again so soon.
inline constexpr double kReadyMaxMs = 1'000.0;

/// How broken runs came out.
struct Tally {
  int broken = 0, runs = 0, ended_alike = 0, given_up = 0;
  int lost = 0, doubled = 0;
  int unacknowledged = 0;  // answers of a run that was given up that are not stored and were never taken
  int discarded = 0;       // contacts that the daemon took for no measurement: stored apart, with the reason
  int references_again = 0;  // reference touches whose answer was not stored: no part of the fit, made again
  std::vector<double> answers_ms, ready_ms;
};

/// Touches of the recipe of these runs: 7 to fit and one held out on each of the paper's planes.
inline constexpr int kWatchedTouches = 4 * (7 + 1);

/// Runs of a short recipe in the cell `edf`, watched on the wire: what the controller answered is held
/// against the store, the result against that of an undisturbed run, which is made first. Whatever cannot go
/// on is std::runtime_error.
class WatchedRuns {
 public:
  /// With `calls_can_fail` the daemon's calls can be armed: MeasuredCell::calls().
  explicit WatchedRuns(bool calls_can_fail = false, std::vector<std::string> daemon_options = {});

  MeasuredCell& cell() { return cell_; }
  [[nodiscard]] const std::string& run() const { return run_; }
  [[nodiscard]] int frames_of_undisturbed() const { return frames_in_a_run_; }
  /// Since the run was started.
  int seen_frames();
  int seen_touch_commands();
  /// False where so many have not come after `patience`.
  bool wait_for_frames(int wanted, std::chrono::microseconds patience);
  /// While frames go on.
  void pass_time(std::chrono::microseconds time);
  /// Called once, on the wire's thread, with the next touch command, before the controller has it.
  void at_next_touch(std::function<void()> act);

  void start();
  /// What the present daemon has logged in the run; before another one is started.
  void keep_log();
  /// What the daemons of the run have logged, one after the other.
  [[nodiscard]] std::string log_of_run() const { return logs_ + cell_.log(); }
  /// The next daemon, until it tells what became of the run, and until it has its link as well.
  void restart(Tally& tally);
  /// A person takes the cause away and says that it goes on, until the run is over; then it is judged.
  /// `remedies`: what he does at the cell, in order, as lines of the simulator's control connection.
  void settle(Tally& tally, const std::vector<std::string>& remedies);

 private:
  /// A touch that the controller answered: application's session and sequence.
  using Answered = std::map<std::pair<std::uint32_t, std::uint32_t>, cs8::JointsMicrodeg>;

  void note(const SeenFrame& frame);
  std::string wait_for_end();
  void leave(const std::string& state, const std::vector<std::string>& remedies);
  void remove(const std::vector<std::string>& remedies);
  void judge(Tally& tally);
  [[nodiscard]] nlohmann::json result() const;
  [[nodiscard]] bool is_like_undisturbed(const nlohmann::json& result) const;

  std::mutex mutex_;
  std::condition_variable seen_;
  int frames_ = 0, touch_commands_ = 0;
  std::function<void()> at_next_touch_;
  std::uint32_t session_ = 0;
  Answered answered_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> acknowledged_;
  MeasuredCell cell_;
  std::string run_, logs_;
  int frames_in_a_run_ = 0;
  nlohmann::json undisturbed_;
};

}  // namespace bench
