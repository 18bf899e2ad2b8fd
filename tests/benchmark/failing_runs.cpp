// Runs in which a call of touchcald fails, or ends it: the n-th allocation finds no memory, the n-th write to
// a file no space or only half of it, the n-th fsync fails, or SIGKILL comes in the middle of the n-th write.
// A start with an empty state directory, a start behind a kill, a touch, the end at SIGTERM. What the
// controller answered is held against the store, results against that of an undisturbed run; whoever ends has
// said why, and the next daemon is ready in a second.
//   failing_runs steps [EACH [CALL [PART PARTS]]]   of each kind of call in each step the first so many, the
//     last so many, and as many between; all: 0. Of one kind of call, or `all`. PART of PARTS, from 1: for
//     several programs side by side
//   failing_runs drawn [COUNT [SEED]]   so many by lot over whole runs; 1,000
//   failing_runs one STEP CALL AT [COUNT]   the same place again and again, each in a run of its own; once.
//     STEP: first_start, start, touch, end; CALL: allocation, write, short_write, sync, kill; an AT below 0
//     counts from the last call that an undisturbed step makes, which is -1
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>
#include <set>
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
constexpr std::array<std::string_view, kSteps.size()> kStepWords{"first_start", "start", "touch", "end"};
constexpr std::array<std::string_view, kCalls.size()> kCallWords{"allocation", "write", "short_write", "sync",
                                                                 "kill"};
constexpr int kFailuresInARun = 5;  // of those by lot
/// A run that goes on behind a restart is planned again, which takes longer than all the rest: in `steps`
/// only one of so many starts and ends is in a touch, and finds the run on hold else.
constexpr int kRestartsForAPlan = 8;
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

  void be_in_a_run() {
    if (has_run_ && is_over(cell_.status().at("state"))) settle();
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

/// Throws what std::stoll throws, and std::invalid_argument for a name that is none.
template <class Names>
std::size_t place_in(const Names& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw std::invalid_argument("there is no '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

struct Part {
  std::int64_t number = 1, of = 1;
};

/// Of 1 to `count` the first and the last `each`, and as many between, evenly; all of them: 0.
std::vector<std::int64_t> places_of(std::int64_t count, std::int64_t each) {
  std::set<std::int64_t> places;
  for (std::int64_t i = 1; i <= (each == 0 ? count : std::min(each, count)); ++i) {
    places.insert(i);
    places.insert(count + 1 - i);
    if (each > 0) places.insert(1 + (i - 1) * count / each);
  }
  return {places.begin(), places.end()};
}

bool fail_in_steps(std::int64_t each, const std::optional<FailingCall>& only, const Part& part) {
  FailingRuns runs(kWatchedTouches, kRestartsForAPlan);
  for (const Step step : kSteps) {
    for (const FailingCall call : kCalls) {
      if (only && call != *only) continue;
      const std::int64_t count = runs.counts(step).of(call);
      const std::vector<std::int64_t> places = places_of(count, each);
      std::size_t made = 0;
      for (auto i = static_cast<std::size_t>(part.number - 1); i < places.size();
           i += static_cast<std::size_t>(part.of), ++made)
        runs.make({step, call, places[i]});
      std::printf("%-11s %s: %zu of %lld\n", kStepNames[static_cast<std::size_t>(step)],
                  kCallNames[static_cast<std::size_t>(call)], made, static_cast<long long>(count));
      std::fflush(stdout);
    }
  }
  runs.settle();
  return runs.print("steps");
}

bool fail_in_steps(const std::vector<std::string>& words) {
  const std::int64_t each = words.empty() ? 0 : std::stoll(words[0]);
  std::optional<FailingCall> only;
  if (words.size() > 1 && words[1] != "all") only = kCalls.at(place_in(kCallWords, words[1]));
  Part part;
  if (words.size() > 3) part = {std::stoll(words[2]), std::stoll(words[3])};
  if (each < 0 || part.number < 1 || part.number > part.of)
    throw std::invalid_argument("give EACH from 0, PART from 1 to PARTS");
  return fail_in_steps(each, only, part);
}

bool fail_by_lot(int count, std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  FailingRuns runs(kFailuresInARun);
  std::vector<Failure> failures;
  for (int i = 0; i < count; ++i) {
    // Every other one in a touch or those behind it.
    const std::size_t drawn = std::uniform_int_distribution<std::size_t>(0, 2 * kSteps.size() - 1)(chance);
    const Step step = drawn < kSteps.size() ? kSteps[drawn] : Step::kTouch;
    const FailingCall call = kCalls[std::uniform_int_distribution<std::size_t>(0, kCalls.size() - 1)(chance)];
    const std::int64_t last = std::max<std::int64_t>(1, runs.counts(step).of(call)) *
                              (step == Step::kTouch ? kTouchesAtOnce - 1 : 1);
    failures.push_back({step, call, std::uniform_int_distribution<std::int64_t>(1, last)(chance)});
  }
  // A state directory that is new has no plan, and the planner takes longer than a run: those come together.
  std::ranges::stable_partition(failures, [](const Failure& one) { return one.step == Step::kFirstStart; });
  for (const Failure& failure : failures) runs.make(failure);
  runs.settle();
  return runs.print("by lot");
}

bool fail_one(const std::vector<std::string>& words) {
  if (words.size() < 3) throw std::invalid_argument("give STEP CALL AT [COUNT]");
  Failure failure{kSteps.at(place_in(kStepWords, words[0])), kCalls.at(place_in(kCallWords, words[1])),
                  std::stoll(words[2])};
  const int count = words.size() > 3 ? std::stoi(words[3]) : 1;
  FailingRuns runs(1);
  if (failure.at < 0) failure.at += runs.counts(failure.step).of(failure.call) + 1;
  for (int i = 0; i < count; ++i) runs.make(failure);
  runs.settle();
  return runs.print("one");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // what came before is seen where it ends by a hang
  const std::string what = argc > 1 ? argv[1] : "drawn";
  const std::uint64_t seed = what == "drawn" && argc > 3 ? std::stoull(argv[3]) : 1;
  try {
    if (what == "steps") return bench::fail_in_steps({argv + 2, argv + argc}) ? 0 : 1;
    if (what == "drawn") return bench::fail_by_lot(argc > 2 ? std::stoi(argv[2]) : 1'000, seed) ? 0 : 1;
    if (what == "one") return bench::fail_one({argv + 2, argv + argc}) ? 0 : 1;
    std::fprintf(stderr, "failing_runs: there is no '%s'; give steps, drawn or one\n", what.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failing_runs: seed %llu: %s\n", static_cast<unsigned long long>(seed),
                 error.what());
  }
  return 2;
}
