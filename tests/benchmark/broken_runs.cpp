// Runs that are broken again and again: touchcald killed (SIGKILL) or told to end (SIGTERM) at random
// moments, the link cut, the door opened, the emergency stop pressed, the power lost, the controller
// restarted in each phase of a touch. What the controller answered on the wire is compared with the store,
// the result with that of an undisturbed run.
//   broken_runs [CAUSE [COUNT [SEED]]]      CAUSE: all, kill, end, link, door, emergency_stop, power,
//   restart; 100 each
#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "service/store/run_store.hpp"
#include "tests/benchmark/measured_cell.hpp"

namespace bench {
namespace {

using nlohmann::json;

constexpr int kTouches = 4 * (7 + 1);
constexpr int kKillsInARun = 5;
/// A run of which no such frame comes any more is over.
constexpr std::chrono::seconds kFramePatience{10};
constexpr int kHandMs = 100;  // a person's hand does one thing after the other
constexpr double kReadyMaxMs = 1'000.0;
/// A run that was held looks at its reference place once more, which tells more of the noise: its result is
/// of the same touches, weighed a little differently.
constexpr double kShareOfStd = 0.1;
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

/// How broken runs came out.
struct Tally {
  int broken = 0, runs = 0, ended_alike = 0, given_up = 0;
  int lost = 0, doubled = 0;
  int references_again = 0;  // reference touches whose answer was not stored: no part of the fit, made again
  std::vector<double> answers_ms, ready_ms;
};

json short_recipe() {
  return {{"schema", "touchcal/recipe/1"},
          {"name", "short"},
          {"description", "just enough touches"},
          {"reference_every", 10},
          {"touches", {{"planes", "all"}, {"fit_per_plane", 7}, {"held_out_per_plane", 1}}},
          {"identification",
           {{"formulation", "signed_distance"}, {"tried_last", json::array()}, {"excluded", json::array()}}}};
}

/// A touch that the controller answered: application's session and sequence.
using Answered = std::map<std::pair<std::uint32_t, std::uint32_t>, cs8::JointsMicrodeg>;

class BrokenRuns {
 public:
  explicit BrokenRuns(std::uint64_t seed)
      : chance_(seed),
        cell_({.heartbeat_timeout_ms = 2'000, .noise = false, .recipes = json::array({short_recipe()})}) {
    cell_.wire().on_frame([this](const SeenFrame& frame) { note(frame); });
    cell_.wait_until_state("IDLE");
    start();
    if (wait_for_end() != "COMPLETE") throw std::runtime_error("undisturbed: " + cell_.status().dump());
    frames_in_a_run_ = seen_frames();
    undisturbed_ = result();
    std::printf("an undisturbed run: %d frames, %zu contacts\n", frames_in_a_run_, answered_.size());
    std::fflush(stdout);
  }

  /// touchcald goes at random moments, `in_order` or not.
  Tally kill(int count, bool in_order) {
    Tally tally;
    while (tally.broken < count) {
      start();
      for (int kills = 0; kills < kKillsInARun && tally.broken < count; ++kills) {
        kill_once(in_order);
        ++tally.broken;
        restart(tally);
        if (cell_.status().at("state") != "HELD") break;  // the run was over
        cell_.command("/api/v1/runs/" + run_ + "/resume");
      }
      settle(tally, {});
    }
    return tally;
  }

  Tally cause(const Cause& cause, int count) {
    Tally tally;
    for (int i = 0; i < count; ++i) {
      const int touch = std::uniform_int_distribution(1, kTouches)(chance_);
      cell_.inject(json{{"fault", cause.fault},
                        {"touch", touch},
                        {"phase", kPhases[static_cast<std::size_t>(i) % kPhases.size()]}}
                       .dump());
      start();
      ++tally.broken;
      settle(tally, cause.remedies);
    }
    return tally;
  }

 private:
  void note(const SeenFrame& frame) {
    const std::lock_guard lock(mutex_);
    ++frames_;
    if (const auto* welcome = std::get_if<cs8::Welcome>(&frame.message.payload)) session_ = welcome->session;
    const auto* touch = std::get_if<cs8::TouchResult>(&frame.message.payload);
    if (touch && touch->outcome == cs8::Outcome::kContact)
      answered_[{session_, frame.message.sequence}] = touch->contact;
    seen_.notify_all();
  }
  int seen_frames() {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

  void start() {
    {
      const std::lock_guard lock(mutex_);
      answered_.clear();
      frames_ = 0;
    }
    run_ = cell_.command("/api/v1/runs", R"({"recipe":"short"})").at("id");
  }

  /// Waits for a frame by lot and a little longer; then the daemon goes.
  void kill_once(bool in_order) {
    const int done = seen_frames();
    const int left = std::max(1, frames_in_a_run_ - done);
    const int wanted = done + std::uniform_int_distribution(0, left)(chance_);
    const std::chrono::microseconds more(std::uniform_int_distribution(0, 3'000)(chance_));
    {
      std::unique_lock lock(mutex_);
      const bool came = seen_.wait_for(lock, kFramePatience, [&] { return frames_ >= wanted; });
      if (came) seen_.wait_for(lock, more, [] { return false; });
    }
    if (in_order) {
      cell_.end_daemon();
    } else {
      cell_.kill_daemon();
    }
  }

  /// The next daemon, until it tells what became of the run, and until it has its link as well.
  void restart(Tally& tally) {
    const auto begin = Clock::now();
    cell_.start_daemon();
    const std::string state = cell_.status().at("state");
    tally.answers_ms.push_back(milliseconds(Clock::now() - begin));
    cell_.wait_until([](const json& now) { return now.at("controller_connected") == true; });
    tally.ready_ms.push_back(milliseconds(Clock::now() - begin));
    if (tally.ready_ms.back() > kReadyMaxMs)
      std::printf("run %s: ready after %.0f ms, at first in %s:\n%s\n", run_.c_str(), tally.ready_ms.back(),
                  state.c_str(), cell_.log().c_str());
  }

  std::string wait_for_end() {
    return cell_
        .wait_until([this](const json& now) {
          const std::string state = now.at("state");
          if (state == "IDLE") return true;  // of a daemon that found the run ended
          const bool is_over = state == "COMPLETE" || state == "ABORTED" || state == "STOPPED";
          return (is_over || state == "HELD") && now.at("run_id") == run_;
        })
        .at("state");
  }

  /// A person takes the cause away and says that it goes on, until the run is over; then it is judged.
  void settle(Tally& tally, const std::vector<std::string>& remedies) {
    constexpr int kWordsMax = 100;
    std::string state = wait_for_end();
    for (int words = 0; state == "HELD" && words < kWordsMax; ++words, state = wait_for_end()) {
      remove(remedies);
      if (cell_.post("/api/v1/runs/" + run_ + "/resume").status != 202) pause_ms(100);
    }
    ++tally.runs;
    judge(tally);
    if (state == "COMPLETE" || state == "IDLE") return;
    remove(remedies);
    if (state == "HELD") (void)cell_.post("/api/v1/runs/" + run_ + "/abort");
    cell_.wait_until([](const json& now) { return now.at("controller_connected") == true; });
    cell_.wait_until([this](const json& now) {
      const std::string at = now.at("state");
      if (at == "ABORTED") (void)cell_.post("/api/v1/cell/clear");
      if (at == "STOPPED") (void)cell_.post("/api/v1/cell/reset");
      return at == "IDLE";
    });
  }

  /// What a person does at the cell, each some simulated time after the other.
  void remove(const std::vector<std::string>& remedies) {
    for (const std::string& remedy : remedies) {
      cell_.inject("{\"fault\":\"" + remedy + "\"}");
      pause_ms(kHandMs);
    }
  }

  json result() const { return json::parse(cell_.get("/api/v1/runs/" + run_ + "/result").body); }

  /// Holds the store against the wire, and the result against the undisturbed one.
  void judge(Tally& tally) {
    Answered answered;
    {
      const std::lock_guard lock(mutex_);
      answered = answered_;
    }
    const cell::RunStore store(cell_.state() / "touchcal.sqlite");
    const std::int64_t id = std::stoll(run_);
    std::set<std::pair<std::uint32_t, std::uint32_t>> stored;
    std::set<int> numbers;
    const auto note_stored = [&](const cell::StoredTouch& touch) {
      if (!stored.insert({touch.session, touch.sequence}).second) ++tally.doubled;
    };
    for (const cell::StoredTouch& touch : store.touches(id)) {
      note_stored(touch);
      if (!numbers.insert(touch.number).second) ++tally.doubled;
    }
    for (const cell::SupersededTouch& old : store.superseded_touches(id)) note_stored(old.touch);
    // Reference touches and repetitions are stored without the command that they answer.
    std::vector<cs8::JointsMicrodeg> without_command;
    for (const cell::ReferenceTouch& touch : store.references(id)) without_command.push_back(touch.joints);
    for (const auto& [command, joints] : answered) {
      if (stored.contains(command)) continue;
      const auto same = std::ranges::find(without_command, joints);
      if (same != without_command.end()) {
        without_command.erase(same);
      } else if (const auto references = store.references(id); std::ranges::any_of(
                     references, [&](const auto& one) { return are_near(one.joints, joints); })) {
        ++tally.references_again;
      } else {
        ++tally.lost;
        std::printf("run %s: the answer to command %u of session %u is not in the store\n", run_.c_str(),
                    command.second, command.first);
      }
    }
    tally.doubled += static_cast<int>(without_command.size());
    if (store.run(id)->outcome != cell::RunOutcome::kComplete) {
      ++tally.given_up;
    } else if (is_like_undisturbed(result())) {
      ++tally.ended_alike;
    }
  }

  /// The reference place is touched again and again; places of the plan are apart by more.
  static bool are_near(const cs8::JointsMicrodeg& a, const cs8::JointsMicrodeg& b) {
    constexpr std::int64_t kNearMicrodeg = 10'000;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::abs(std::int64_t{a[i]} - b[i]) > kNearMicrodeg) return false;
    return true;
  }

  bool is_like_undisturbed(const json& result) const {
    for (const char* key : {"touch_count", "complete", "converged", "identifiable_count", "rejected_touches"})
      if (result.at(key) != undisturbed_.at(key)) return false;
    if (result.at("verdict").at("accepted") != undisturbed_.at("verdict").at("accepted")) return false;
    for (std::size_t i = 0; i < undisturbed_.at("parameters").size(); ++i) {
      const json& ours = result.at("parameters")[i];
      const json& theirs = undisturbed_.at("parameters")[i];
      if (ours.at("status") != theirs.at("status")) return false;
      if (theirs.at("status") != "identified") continue;
      const double apart = ours.at("error").get<double>() - theirs.at("error").get<double>();
      if (std::abs(apart) > kShareOfStd * theirs.at("std_uncertainty").get<double>()) return false;
    }
    return true;
  }

  std::mt19937_64 chance_;
  std::mutex mutex_;
  std::condition_variable seen_;
  int frames_ = 0;
  std::uint32_t session_ = 0;
  Answered answered_;
  MeasuredCell cell_;
  std::string run_;
  int frames_in_a_run_ = 0;
  json undisturbed_;
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
