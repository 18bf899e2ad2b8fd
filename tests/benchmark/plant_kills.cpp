// Calibrations during which the daemon, the broker and the archive's server are killed at random moments
// (SIGKILL; the server as at a power cut). Afterwards every fact of the cell is in the archive and at a
// subscriber of the broker, once.
//   plant_kills [COUNT [SEED]]      1,000 kills
#include <array>
#include <cstdio>
#include <pqxx/pqxx>
#include <random>
#include <stdexcept>

#include "service/archive/archive_reader.hpp"
#include "service/store/outbox.hpp"
#include "tests/benchmark/plant_beside.hpp"
#include "tests/benchmark/plant_reader.hpp"
#include "tests/benchmark/watched_runs.hpp"

namespace bench {
namespace {

using nlohmann::json;

constexpr int kKillsInARun = 5;
constexpr std::chrono::seconds kFramePatience{10};
/// What the broker holds for the reader is there by then.
constexpr std::chrono::seconds kHearPatience{30};
/// What was killed may be away so long.
constexpr int kAwayMaxMs = 300;
/// Longer than the longest pause between two tries of a sink.
constexpr std::chrono::seconds kSinkPatience{150};
constexpr int kFactsMax = 10'000'000;

constexpr std::array kVictims{"daemon", "broker", "database"};

class PlantKills {
 public:
  explicit PlantKills(std::uint64_t seed) : seed_(seed), chance_(seed), runs_(false, daemon_options()) {}

  void kill(int count) {
    while (killed() < count) {
      runs_.start();
      for (int kills = 0; kills < kKillsInARun && killed() < count; ++kills)
        if (!kill_once()) break;
      runs_.settle(tally_, {});
      // Half of the kills meet sinks that are connected, the others those that try to be.
      if (draw(0, 1) == 1)
        wait_for_sinks(
            [](const json& now, const std::string& sink) { return now.at(sink + "_trouble").is_null(); });
    }
    wait_for_sinks([](const json& now, const std::string& sink) {
      return now.at(sink + "_behind") == 0 && now.at(sink + "_trouble").is_null();
    });
  }

  /// Prints what came of it; whether all is where it belongs, once.
  bool judge() {
    const std::vector<cell::Fact> facts =
        cell::OutboxReader(cell_.state() / "touchcal.sqlite").next(0, kFactsMax);
    // The status may tell of none behind for half a second after the last were written.
    const auto deadline = Clock::now() + kHearPatience;
    while ((reader_.heard().size() < facts.size() || archived().size() < facts.size()) &&
           Clock::now() < deadline)
      pause_ms(20);
    const auto told = archived();
    const auto heard = reader_.heard();
    int not_archived = 0, not_heard = 0, contradicted = reader_.contradicted();
    const auto look = [&](const auto& there, const cell::Fact& fact, int& missing) {
      const auto found = there.find(fact.seq);
      if (found == there.end()) return void(++missing);
      if (found->second != fact.sha256) ++contradicted;
    };
    for (std::size_t i = 0; i < facts.size(); ++i)
      if (facts[i].seq != static_cast<std::int64_t>(i) + 1) ++contradicted;
    for (const cell::Fact& fact : facts) {
      look(told, fact, not_archived);
      look(heard, fact, not_heard);
    }
    contradicted +=
        static_cast<int>(told.size() > facts.size()) + static_cast<int>(heard.size() > facts.size());
    const auto damage = cell::look_at_archive(plant_.database.url()).damage;
    for (const std::string& line : damage) std::printf("archive: %s\n", line.c_str());
    const bool met = not_archived == 0 && not_heard == 0 && contradicted == 0 && damage.empty() &&
                     tally_.lost == 0 && tally_.doubled == 0 && tally_.ended_alike == tally_.runs;
    std::printf(
        "%d kills (%d of the daemon, %d of the broker, %d of the database) in %d runs, %zu facts: %d not in "
        "the "
        "archive, %d not at the subscriber (to whom %d came again), %d doubled or another; %d answered "
        "touches "
        "lost, %d doubled, %d runs ended as the undisturbed one  (wanted: 0, 0, 0; 0, 0, all: %s; seed "
        "%llu)\n",
        killed(), kills_[0], kills_[1], kills_[2], tally_.runs, facts.size(), not_archived, not_heard,
        reader_.repeated(), contradicted, tally_.lost, tally_.doubled, tally_.ended_alike,
        met ? "met" : "MISSED", static_cast<unsigned long long>(seed_));
    return met;
  }

 private:
  [[nodiscard]] int killed() const { return kills_[0] + kills_[1] + kills_[2]; }
  int draw(int from, int to) { return std::uniform_int_distribution(from, to)(chance_); }

  std::vector<std::string> daemon_options() {
    plant_.broker.save();  // the subscription of the reader
    return plant_.daemon_options();
  }

  /// False where the run was over.
  bool kill_once() {
    const int done = runs_.seen_frames();
    const int left = std::max(1, runs_.frames_of_undisturbed() - done);
    if (runs_.wait_for_frames(done + draw(0, left), kFramePatience))
      runs_.pass_time(std::chrono::microseconds(draw(0, 3'000)));
    const int victim = draw(0, static_cast<int>(kVictims.size()) - 1);
    ++kills_[static_cast<std::size_t>(victim)];
    const std::chrono::milliseconds away(draw(0, kAwayMaxMs));
    if (victim == 0) {
      cell_.kill_daemon();
      runs_.restart(tally_);
      if (cell_.status().at("state") != "HELD") return false;
      cell_.command("/api/v1/runs/" + runs_.run() + "/resume");
    } else if (victim == 1) {
      plant_.broker.kill();
      runs_.pass_time(away);
      plant_.broker.start();
    } else {
      plant_.database.kill();
      runs_.pass_time(away);
      plant_.database.start();
    }
    return true;
  }

  template <class Holds>
  void wait_for_sinks(const Holds& holds) {
    cell_.wait_until([&](const json& now) { return holds(now, "mqtt") && holds(now, "archive"); },
                     kSinkPatience);
  }

  std::map<std::int64_t, std::string> archived() {
    pqxx::connection connection(plant_.database.url());
    pqxx::read_transaction read(connection);
    std::map<std::int64_t, std::string> facts;
    for (const pqxx::row& row : read.exec("SELECT seq, sha256 FROM event WHERE cell = 'edf'"))
      facts.emplace(row[0].as<std::int64_t>(), row[1].as<std::string>());
    return facts;
  }

  std::uint64_t seed_;
  std::mt19937_64 chance_;
  PlantBeside plant_{"edf"};
  PlantReader reader_{plant_.broker.options_of("plant-reader")};
  WatchedRuns runs_;
  MeasuredCell& cell_ = runs_.cell();
  Tally tally_;
  std::array<int, kVictims.size()> kills_{};
};

bool kill_and_judge(int count, std::uint64_t seed) {
  PlantKills plant(seed);
  plant.kill(count);
  return plant.judge();
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 2 ? std::stoull(argv[2]) : 1;
  try {
    return bench::kill_and_judge(argc > 1 ? std::stoi(argv[1]) : 1000, seed) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plant_kills: seed %llu: %s\n", static_cast<unsigned long long>(seed), error.what());
    return 2;
  }
}
