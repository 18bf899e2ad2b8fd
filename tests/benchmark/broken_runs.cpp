// Runs that are broken again and again: touchcald killed (SIGKILL) or told to end (SIGTERM) at random
// moments, the link cut, the door opened, the emergency stop pressed, the power lost, the controller
// restarted in each phase of a touch. What the controller answered on the wire is compared with the store,
// the result with that of an undisturbed run.
//   broken_runs [CAUSE [COUNT [SEED]]]      CAUSE: all, kill, end, link, door, emergency_stop, power,
//   restart; 100 each
#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <stdexcept>

#include "tests/benchmark/watched_runs.hpp"

namespace bench {
namespace {

using nlohmann::json;

constexpr int kKillsInARun = 5;
/// A run of which no such frame comes any more is over.
constexpr std::chrono::seconds kFramePatience{10};
constexpr std::array kPhases{"travel", "approach", "search", "retract"};

struct Cause {
  std::string name;
  std::string fault;                  // as a line of the simulator's control connection has it
  std::vector<std::string> remedies;  // what a person then does, in order
};

const std::vector<Cause> kCauses{
    {"link", "close", {}},
    // Whoever was inside may have changed the stylus: it is tested once more, away from the block, since a
    // stylus that lies at a face cannot be.
    {"door",
     "open_cell",
     {"power_off", "jog_home", "touch_stylus", "release_stylus", "close_cell", "power_on"}},
    {"emergency_stop",
     "emergency_stop",
     {"release_emergency_stop", "acknowledge_emergency_stop", "power_on"}},
    {"power", "power_off", {"power_on"}},
    // The application that begins anew does not know that the stylus lies at a face.
    {"restart", "restart", {"power_off", "jog_home", "power_on"}}};

class BrokenRuns {
 public:
  explicit BrokenRuns(std::uint64_t seed) : chance_(seed) {}

  /// touchcald goes at random moments, `in_order` or not.
  Tally kill(int count, bool in_order) {
    Tally tally;
    while (tally.broken < count) {
      runs_.start();
      for (int kills = 0; kills < kKillsInARun && tally.broken < count; ++kills) {
        kill_once(in_order);
        ++tally.broken;
        runs_.restart(tally);
        if (cell_.status().at("state") != "HELD") break;  // the run was over
        cell_.command("/api/v1/runs/" + runs_.run() + "/resume");
      }
      runs_.settle(tally, {});
    }
    return tally;
  }

  Tally cause(const Cause& cause, int count) {
    Tally tally;
    for (int i = 0; i < count; ++i) {
      const int touch = std::uniform_int_distribution(1, kWatchedTouches)(chance_);
      cell_.inject(json{{"fault", cause.fault},
                        {"touch", touch},
                        {"phase", kPhases[static_cast<std::size_t>(i) % kPhases.size()]}}
                       .dump());
      runs_.start();
      ++tally.broken;
      runs_.settle(tally, cause.remedies);
    }
    return tally;
  }

 private:
  /// Waits for a frame by lot and a little longer; then the daemon goes.
  void kill_once(bool in_order) {
    const int done = runs_.seen_frames();
    const int left = std::max(1, runs_.frames_of_undisturbed() - done);
    const int wanted = done + std::uniform_int_distribution(0, left)(chance_);
    const std::chrono::microseconds more(std::uniform_int_distribution(0, 3'000)(chance_));
    if (runs_.wait_for_frames(wanted, kFramePatience)) runs_.pass_time(more);
    if (in_order) {
      cell_.end_daemon();
    } else {
      cell_.kill_daemon();
    }
  }

  std::mt19937_64 chance_;
  WatchedRuns runs_;
  MeasuredCell& cell_ = runs_.cell();
};

/// Whether the runs kept what they had. How soon the daemon was ready is printed and no part of that: a busy
/// machine makes nobody's run worse.
bool print(const std::string& cause, const Tally& tally) {
  const bool kept = tally.lost == 0 && tally.doubled == 0 && tally.ended_alike == tally.runs;
  const bool met = kept && percentile(tally.ready_ms, 1.0) <= kReadyMaxMs;
  std::printf(
      "%-15s broken %d times in %d runs: %d answered touches lost, %d doubled; %d ended as the undisturbed "
      "one, %d were given up",
      cause.c_str(), tally.broken, tally.runs, tally.lost, tally.doubled, tally.ended_alike, tally.given_up);
  if (!tally.ready_ms.empty())
    std::printf(
        "; %d reference touches made again; answers again p50 %.0f, longest %.0f ms, ready with its link p50 "
        "%.0f, longest %.0f ms",
        tally.references_again, percentile(tally.answers_ms, 0.5), percentile(tally.answers_ms, 1.0),
        percentile(tally.ready_ms, 0.5), percentile(tally.ready_ms, 1.0));
  std::printf("  (wanted: 0, 0, all, 0, %.0f ms: %s)\n", kReadyMaxMs, met ? "met" : "MISSED");
  std::fflush(stdout);
  return kept;
}

bool break_runs(const std::string& wanted, int count, std::uint64_t seed) {
  BrokenRuns runs(seed);
  bool kept = true, known = false;
  for (const char* name : {"kill", "end"}) {
    if (wanted != "all" && wanted != name) continue;
    known = true;
    kept = print(name, runs.kill(count, name == std::string("end"))) && kept;
  }
  for (const Cause& cause : kCauses) {
    if (wanted != "all" && wanted != cause.name) continue;
    known = true;
    kept = print(cause.name, runs.cause(cause, count)) && kept;
  }
  if (!known) throw std::runtime_error("there is no cause " + wanted);
  return kept;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 3 ? std::stoull(argv[3]) : 1;
  try {
    return bench::break_runs(argc > 1 ? argv[1] : "all", argc > 2 ? std::stoi(argv[2]) : 100, seed) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "broken_runs: seed %llu: %s\n", static_cast<unsigned long long>(seed), error.what());
    return 2;
  }
}
