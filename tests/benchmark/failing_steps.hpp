#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "service/base/exit_code.hpp"
#include "tests/benchmark/watched_runs.hpp"

namespace bench {

using nlohmann::json;
using touchcal::testing::FailingCall;
using touchcal::testing::Finished;

enum class Step { kFirstStart, kStart, kTouch, kEnd };
inline constexpr std::array kSteps{Step::kFirstStart, Step::kStart, Step::kTouch, Step::kEnd};
inline constexpr std::array kStepNames{"first start", "start", "touch", "end"};
inline constexpr std::array kCalls{FailingCall::kAllocation, FailingCall::kWrite, FailingCall::kShortWrite,
                                   FailingCall::kSync, FailingCall::kKill};
inline constexpr std::array kCallNames{"nothing",     "allocation", "write",
                                       "short write", "sync",       "kill in a write"};
inline constexpr int kTouchesAtOnce = 4;                  // a lot of a touch falls into these
inline constexpr std::chrono::seconds kStepPatience{40};  // of a run that neither goes on nor stands
inline constexpr int kPauseMs = 2;

struct Failure {
  Step step;
  FailingCall call;
  std::int64_t at;
  [[nodiscard]] std::string text() const {
    return std::string(kCallNames[static_cast<std::size_t>(call)]) + " " + std::to_string(at) + " of a " +
           kStepNames[static_cast<std::size_t>(step)];
  }
};

/// What an undisturbed step makes of each kind.
struct Counts {
  std::int64_t allocations = 0, writes = 0, syncs = 0;
  [[nodiscard]] std::int64_t of(FailingCall call) const {
    if (call == FailingCall::kAllocation) return allocations;
    return call == FailingCall::kSync ? syncs : writes;
  }
};

/// Steps of touchcald's life in which a call fails, in runs that are watched: what was lost, who ended
/// without a word, how soon the next daemon was ready.
class FailingRuns {
 public:
  /// `in_a_run`: a run is gone on with to its end after so many failures. `restarts_for_a_plan`: of so many
  /// starts and ends one is in a touch.
  explicit FailingRuns(int in_a_run, int restarts_for_a_plan = 1)
      : in_a_run_(in_a_run), restarts_for_a_plan_(restarts_for_a_plan) {
    // In this order the fewest daemons have to plan: it is the first start that leaves no run.
    for (const Step step : {Step::kTouch, Step::kEnd, Step::kStart, Step::kFirstStart}) {
      make({step, FailingCall::kNone, 0});
      const Counts& counts = counts_[static_cast<std::size_t>(step)] = made_;
      std::printf("%-11s makes %lld allocations, %lld writes, %lld syncs\n",
                  kStepNames[static_cast<std::size_t>(step)], static_cast<long long>(counts.allocations),
                  static_cast<long long>(counts.writes), static_cast<long long>(counts.syncs));
    }
    std::fflush(stdout);
    settle();
    tally_ = {};
  }

  [[nodiscard]] const Counts& counts(Step step) const { return counts_[static_cast<std::size_t>(step)]; }

  void make(const Failure& failure) {
    const int lost = tally_.lost + tally_.doubled;
    now_ = failure.text();
    try {
      if (failure.step == Step::kFirstStart) settle();
      if (failure.step != Step::kFirstStart) be_in_a_run();
      switch (failure.step) {
        case Step::kFirstStart:
        case Step::kStart:
          start(failure);
          break;
        case Step::kTouch:
          touch(failure);
          break;
        case Step::kEnd:
          end(failure);
          break;
      }
      failed_ += static_cast<int>(cell_.calls().failed);
      if (failure.call != FailingCall::kNone) ++tally_.broken;
      told_.push_back(now_);
      if (static_cast<int>(told_.size()) >= in_a_run_) settle();
    } catch (const std::exception& error) {
      throw std::runtime_error(now_ + ": " + error.what() + '\n' + end_of_log());
    }
    if (tally_.lost + tally_.doubled > lost) std::printf("  before or after %s\n", now_.c_str());
  }

  /// The run goes on to its end; what was made to fail in it is told where it was not kept.
  void settle() {
    const Tally before = tally_;
    if (!has_run_) return;
    runs_.settle(tally_, {});
    has_run_ = false;
    const bool kept = tally_.lost == before.lost && tally_.doubled == before.doubled &&
                      tally_.ended_alike + tally_.given_up > before.ended_alike + before.given_up;
    if (!kept) {
      std::printf("run %s has lost or doubled an answer, or ends otherwise. Failed in it:\n",
                  runs_.run().c_str());
      for (const std::string& one : told_) std::printf("  %s\n", one.c_str());
      std::printf("%s\n", end_of_log().c_str());
    }
    told_.clear();
  }

  /// Whether everything was kept and told. How soon the daemon was ready is printed and no part of that.
  bool print(const char* what) const {
    const bool kept = tally_.lost == 0 && tally_.doubled == 0 && untold_ == 0 &&
                      tally_.ended_alike + tally_.given_up == tally_.runs;
    const double longest = percentile(tally_.ready_ms, 1.0);
    std::printf(
        "%s: %d calls, %d of them failed, %d daemons ended by it, %d without a word, in %d runs: %d answered "
        "touches lost, %d doubled; %d runs ended as the undisturbed one, %d were given up; %d answers were "
        "left "
        "to the controller, %d were no measurement; ready with its link p50 %.0f, longest %.0f ms  (wanted: "
        "0 "
        "without a word, 0, 0, %.0f ms: %s)\n",
        what, tally_.broken, failed_, ended_, untold_, tally_.runs, tally_.lost, tally_.doubled,
        tally_.ended_alike, tally_.given_up, tally_.unacknowledged, tally_.discarded,
        percentile(tally_.ready_ms, 0.5), longest, kReadyMaxMs,
        kept && longest <= kReadyMaxMs ? "met" : "MISSED");
    return kept;
  }

 private:
  [[nodiscard]] std::string end_of_log() const {
    constexpr std::size_t kShown = 60'000;
    const std::string log = runs_.log_of_run();
    return log.size() <= kShown ? log : "...\n" + log.substr(log.size() - kShown);
  }
  void arm(const Failure& failure) {
    auto& calls = cell_.calls();
    calls.call = FailingCall::kNone;
    calls.allocations = calls.writes = calls.syncs = calls.failed = 0;
    calls.at = failure.at;
    calls.call = failure.call;
  }
  void disarm() {
    auto& calls = cell_.calls();
    calls.call = FailingCall::kNone;
    made_ = {calls.allocations, calls.writes, calls.syncs};  // what the next daemon makes is no part of it
  }

  /// A request whose memory failed has no answer.
  std::optional<json> status() const {
    const PlainAnswer answer = cell_.get("/api/v1/status");
    if (answer.status != 200) return std::nullopt;
    return json::parse(answer.body);
  }
  /// RESETTING is on its way to IDLE: a daemon that started behind a run that had ended.
  static bool is_over(const std::string& state) {
    return state == "COMPLETE" || state == "ABORTED" || state == "STOPPED" || state == "RESETTING" ||
           state == "IDLE";
  }

  /// The daemon's state. One that its failed call ends is seen running for a while, but answers no more: then
  /// it is the next one's.
  std::string state_of_who_goes_on() {
    const auto deadline = Clock::now() + kStepPatience;
    for (;;) {
      if (!cell_.daemon_is_running()) judge_end(false);
      if (const auto told = status()) return told->at("state");
      if (Clock::now() > deadline) throw std::runtime_error("no status");
      pause_ms(kPauseMs);
    }
  }

  void be_in_a_run() {
    if (has_run_ && is_over(state_of_who_goes_on())) settle();
    if (has_run_) return;
    runs_.start();
    has_run_ = true;
  }

  /// Whether this start or end finds the run in a touch.
  bool is_in_a_touch() { return restarts_++ % restarts_for_a_plan_ == 0; }

  /// Sets `act` off with the next touch command; a run on hold is resumed until there is one. False where the
  /// run is over before.
  bool at_next_touch(const std::function<void()>& act) {
    std::atomic<bool> came = false;
    runs_.at_next_touch([&] {
      act();
      came = true;
    });
    const auto deadline = Clock::now() + kStepPatience;
    while (!came) {
      if (Clock::now() > deadline) throw std::runtime_error("no touch comes: " + cell_.status().dump());
      const auto told = status();  // `act` may have come meanwhile, and what it arms fails for this request
      const std::string state = told ? told->at("state").get<std::string>() : "";
      if (is_over(state) && !came) break;
      if (state == "HELD") (void)cell_.post("/api/v1/runs/" + runs_.run() + "/resume");
      pause_ms(kPauseMs);
    }
    runs_.at_next_touch(nullptr);
    return came;
  }

  /// The daemon that is killed in a touch, or has no state, starts.
  void start(const Failure& failure) {
    if (failure.step == Step::kStart && is_in_a_touch()) at_next_touch([] {});
    cell_.kill_daemon();
    if (failure.step == Step::kFirstStart) std::filesystem::remove_all(cell_.state());
    arm(failure);
    runs_.keep_log();
    const bool is_up = cell_.try_to_start_daemon();
    const auto deadline = Clock::now() + kStepPatience;
    while (is_up && cell_.daemon_is_running()) {
      const auto now = status();
      if (now && now->at("controller_connected") == true) break;
      if (Clock::now() > deadline) throw std::runtime_error("no link: " + (now ? now->dump() : ""));
      pause_ms(kPauseMs);
    }
    disarm();
    if (!is_up) judge_end(false);
    (void)state_of_who_goes_on();
    if (failure.step == Step::kFirstStart && failure.call != FailingCall::kNone) settle();
  }

  void touch(const Failure& failure) {
    if (!at_next_touch([&] { arm(failure); })) return;
    const int commands = runs_.seen_touch_commands();
    int at_failure = commands;
    const auto deadline = Clock::now() + kStepPatience;
    for (;;) {
      if (!cell_.daemon_is_running()) break;
      const int now = runs_.seen_touch_commands();
      if (failure.call == FailingCall::kNone && now > commands) break;
      if (cell_.calls().failed == 0) at_failure = now;
      if (now >= at_failure + 2 || now >= commands + kTouchesAtOnce) break;
      const auto told = status();
      const std::string state = told ? told->at("state").get<std::string>() : "";
      if (is_over(state) || state == "HELD") break;
      if (Clock::now() > deadline) throw std::runtime_error("hangs: " + (told ? told->dump() : ""));
      pause_ms(kPauseMs);
    }
    disarm();
    (void)state_of_who_goes_on();
  }

  void end(const Failure& failure) {
    const auto act = [&] {
      arm(failure);
      cell_.signal_daemon(SIGTERM);
    };
    if (!is_in_a_touch() || !at_next_touch(act)) act();
    judge_end(true);
  }

  /// Of a daemon that has ended, or is to, by itself or `in_order`; the next one starts.
  void judge_end(bool in_order) {
    const Finished finished = cell_.wait_for_daemons_end();
    disarm();
    const bool was_killed = finished.exit_code == 128 + SIGKILL;
    if (!in_order || finished.exit_code != 0) ++ended_;
    // What is thrown before main() or where no exception may pass is told by the C++ library.
    const bool aborted_with_a_word =
        finished.exit_code == 128 + SIGABRT && finished.err.find("terminate called") != std::string::npos;
    const bool told =
        (in_order && finished.exit_code == 0) || was_killed || aborted_with_a_word ||
        ((finished.exit_code == cell::kExitFailed || finished.exit_code == cell::kExitBadInput) &&
         !finished.err.empty());
    if (!told) {
      ++untold_;
      std::printf("%s: the daemon ended with %d and says no reason:\n%s\n", now_.c_str(), finished.exit_code,
                  finished.err.c_str());
    }
    runs_.restart(tally_);
  }

  const int in_a_run_, restarts_for_a_plan_;
  WatchedRuns runs_{true};
  MeasuredCell& cell_ = runs_.cell();
  Tally tally_;
  std::array<Counts, kSteps.size()> counts_;
  Counts made_;  // since it was armed last
  std::string now_;
  std::vector<std::string> told_;  // of the run
  bool has_run_ = false;
  int failed_ = 0, ended_ = 0, untold_ = 0, restarts_ = 0;
};

}  // namespace bench
