// Runs in which a call of touchcald fails, or ends it: the n-th allocation finds no memory, the n-th write to
// a file no space or only half of it, the n-th fsync fails, or SIGKILL comes in the middle of the n-th write.
// A start with an empty state directory, a start behind a kill, a touch, the end at SIGTERM. What the
// controller answered is held against the store, results against that of an undisturbed run; whoever ends has
// said why, and the next daemon is ready in a second.
//   failing_runs steps [EACH [SEED]]    so many places of each kind of call in each step, evenly; all: 0
//   failing_runs drawn [COUNT [SEED]]   so many by lot over whole runs; 1,000
//   failing_runs one STEP CALL AT [COUNT]   the same place again and again, each in a run of its own; once.
//     STEP: first_start, start, touch, end; CALL: allocation, write, short_write, sync, kill
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "service/base/exit_code.hpp"
#include "tests/benchmark/watched_runs.hpp"

namespace bench {
namespace {

using nlohmann::json;
using touchcal::testing::FailingCall;
using touchcal::testing::Finished;

enum class Step { kFirstStart, kStart, kTouch, kEnd };
constexpr std::array kSteps{Step::kFirstStart, Step::kStart, Step::kTouch, Step::kEnd};
constexpr std::array kStepNames{"first start", "start", "touch", "end"};
constexpr std::array kCalls{FailingCall::kAllocation, FailingCall::kWrite, FailingCall::kShortWrite,
                            FailingCall::kSync, FailingCall::kKill};
constexpr std::array kCallNames{"nothing", "allocation", "write", "short write", "sync", "kill in a write"};
constexpr int kFailuresInARun = 5;                 // of those by lot
constexpr int kTouchesAtOnce = 4;                  // a lot of a touch falls into these
constexpr std::chrono::seconds kStepPatience{40};  // of a run that neither goes on nor stands
constexpr int kPauseMs = 2;

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

class FailingRuns {
 public:
  /// `in_a_run`: a run is gone on with to its end after so many failures.
  explicit FailingRuns(int in_a_run) : in_a_run_(in_a_run) {
    for (const Step step : kSteps) {
      make({step, FailingCall::kNone, 0});
      const auto& calls = cell_.calls();
      Counts& counts = counts_[static_cast<std::size_t>(step)];
      counts = {calls.allocations, calls.writes, calls.syncs};
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
    if (tally_.lost + tally_.doubled > lost) std::printf("  behind or before %s\n", now_.c_str());
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
  void disarm() { cell_.calls().call = FailingCall::kNone; }

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

  void be_in_a_run() {
    if (has_run_ && is_over(cell_.status().at("state"))) settle();
    if (has_run_) return;
    runs_.start();
    has_run_ = true;
  }

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
      const std::string state = cell_.status().at("state");
      if (is_over(state) && !came) break;
      if (state == "HELD") (void)cell_.post("/api/v1/runs/" + runs_.run() + "/resume");
      pause_ms(kPauseMs);
    }
    runs_.at_next_touch(nullptr);
    return came;
  }

  /// The daemon that is killed in a touch, or has no state, starts.
  void start(const Failure& failure) {
    if (failure.step == Step::kStart) at_next_touch([] {});
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
    if (!is_up || !cell_.daemon_is_running()) judge_end(false);
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
    if (!cell_.daemon_is_running()) judge_end(false);
  }

  void end(const Failure& failure) {
    const auto act = [&] {
      arm(failure);
      cell_.signal_daemon(SIGTERM);
    };
    if (!at_next_touch(act)) act();
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

  const int in_a_run_;
  WatchedRuns runs_{true};
  MeasuredCell& cell_ = runs_.cell();
  Tally tally_;
  std::array<Counts, kSteps.size()> counts_;
  std::string now_;
  std::vector<std::string> told_;  // of the run
  bool has_run_ = false;
  int failed_ = 0, ended_ = 0, untold_ = 0;
};

bool fail_in_steps(std::int64_t each) {
  FailingRuns runs(kWatchedTouches);
  for (const Step step : kSteps) {
    for (const FailingCall call : kCalls) {
      const std::int64_t count = runs.counts(step).of(call);
      const std::int64_t made = each == 0 ? count : std::min(each, count);
      for (std::int64_t i = 0; i < made; ++i) runs.make({step, call, 1 + i * count / made});
      std::printf("%-11s %s: %lld of %lld\n", kStepNames[static_cast<std::size_t>(step)],
                  kCallNames[static_cast<std::size_t>(call)], static_cast<long long>(made),
                  static_cast<long long>(count));
      std::fflush(stdout);
    }
  }
  runs.settle();
  return runs.print("steps");
}

bool fail_by_lot(int count, std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  FailingRuns runs(kFailuresInARun);
  for (int i = 0; i < count; ++i) {
    // Every other one in a touch or those behind it.
    const std::size_t drawn = std::uniform_int_distribution<std::size_t>(0, 2 * kSteps.size() - 1)(chance);
    const Step step = drawn < kSteps.size() ? kSteps[drawn] : Step::kTouch;
    const FailingCall call = kCalls[std::uniform_int_distribution<std::size_t>(0, kCalls.size() - 1)(chance)];
    const std::int64_t last = std::max<std::int64_t>(1, runs.counts(step).of(call)) *
                              (step == Step::kTouch ? kTouchesAtOnce - 1 : 1);
    runs.make({step, call, std::uniform_int_distribution<std::int64_t>(1, last)(chance)});
  }
  runs.settle();
  return runs.print("by lot");
}

/// Throws what std::stoll throws, and std::invalid_argument for a name that is none.
template <class Names>
std::size_t place_in(const Names& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw std::invalid_argument("there is no '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

bool fail_one(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, kSteps.size()> kStepWords{"first_start", "start", "touch", "end"};
  constexpr std::array<std::string_view, kCalls.size()> kCallWords{"allocation", "write", "short_write",
                                                                   "sync", "kill"};
  if (words.size() < 3) throw std::invalid_argument("give STEP CALL AT [COUNT]");
  const Failure failure{kSteps.at(place_in(kStepWords, words[0])), kCalls.at(place_in(kCallWords, words[1])),
                        std::stoll(words[2])};
  const int count = words.size() > 3 ? std::stoi(words[3]) : 1;
  FailingRuns runs(1);
  for (int i = 0; i < count; ++i) runs.make(failure);
  runs.settle();
  return runs.print("one");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // what came before is seen where it ends by a hang
  const std::string what = argc > 1 ? argv[1] : "drawn";
  const std::uint64_t seed = what != "one" && argc > 3 ? std::stoull(argv[3]) : 1;
  try {
    if (what == "steps") return bench::fail_in_steps(argc > 2 ? std::stoll(argv[2]) : 0) ? 0 : 1;
    if (what == "drawn") return bench::fail_by_lot(argc > 2 ? std::stoi(argv[2]) : 1'000, seed) ? 0 : 1;
    if (what == "one") return bench::fail_one({argv + 2, argv + argc}) ? 0 : 1;
    std::fprintf(stderr, "failing_runs: there is no '%s'; give steps, drawn or one\n", what.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failing_runs: seed %llu: %s\n", static_cast<unsigned long long>(seed),
                 error.what());
  }
  return 2;
}
