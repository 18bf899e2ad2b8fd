// From a touch's result to the next command, as the cable between touchcald and cs8sim sees it: whole runs of
// the cell `edf` with the shipped heartbeat: quiet, with a broker and an archive that are told of it, with
// both of them hanging, and with a disk that stalls for a second every ten touches. Beside them, in the same
// runs, a bare fdatasync in the daemon's folder.
//   wire_benchmark [RUNS [RECIPE]]      2 runs of edf-25 each
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>

#include "tests/benchmark/measured_cell.hpp"
#include "tests/benchmark/plant_beside.hpp"

namespace bench {
namespace {

constexpr double kOverSyncMs = 1.0;
constexpr double kStallMs = 1000.0;
constexpr double kOverStallMs = 2.0;
constexpr int kTouchesBetweenStalls = 10;
constexpr int kSyncEveryMs = 20;
/// Of the simulated arm: a touch still takes longer than the arithmetic that goes on while the arm moves, as
/// it does at a real one. At "max" the answer comes at once, and that arithmetic would be counted.
constexpr const char* kSpeed = "30";

/// Puts a block on the disk again and again while it lives, and keeps how long each took.
class SyncClock {
 public:
  explicit SyncClock(const std::filesystem::path& folder)
      : file_(::open((folder / "bare").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)),
        thread_([this] { sync_again_and_again(); }) {}
  ~SyncClock() {
    if (thread_.joinable()) end();
    ::close(file_);
  }
  SyncClock(const SyncClock&) = delete;
  SyncClock& operator=(const SyncClock&) = delete;

  std::vector<double> end() {
    ends_ = true;
    thread_.join();
    return times_ms_;
  }

 private:
  void sync_again_and_again() {
    const std::array<char, 4096> block{};
    while (!ends_) {
      const auto begin = Clock::now();
      if (::pwrite(file_, block.data(), block.size(), 0) < 0 || ::fdatasync(file_) != 0) return;
      times_ms_.push_back(milliseconds(Clock::now() - begin));
      pause_ms(kSyncEveryMs);
    }
  }

  int file_;
  std::atomic<bool> ends_ = false;
  std::vector<double> times_ms_;
  std::thread thread_;
};

/// From each touch's result to the touch that follows it with nothing but acknowledgements in between.
std::vector<double> answers_ms(const std::vector<SeenFrame>& frames) {
  std::vector<double> found;
  const SeenFrame* result = nullptr;
  for (const SeenFrame& frame : frames) {
    const cs8::Payload& payload = frame.message.payload;
    if (std::holds_alternative<cs8::TouchResult>(payload)) {
      result = &frame;
    } else if (std::holds_alternative<cs8::ResultAcknowledge>(payload) ||
               std::holds_alternative<cs8::Accepted>(payload)) {
      continue;
    } else {
      if (result != nullptr && std::holds_alternative<cs8::Touch>(payload))
        found.push_back(milliseconds(frame.at - result->at));
      result = nullptr;
    }
  }
  return found;
}

struct Figures {
  std::vector<double> answers_ms, syncs_ms;
  int links = 0;
  std::string states;  // in which the runs ended
  bool are_whole = false;
};

Figures measure(MeasuredCell& cell, int runs, const std::string& recipe) {
  Figures figures;
  cell.wait_until_state("IDLE");
  for (int run = 0; run < runs; ++run) {
    cell.wire().take();
    const std::string id = cell.command("/api/v1/runs", nlohmann::json{{"recipe", recipe}}.dump()).at("id");
    cell.wait_until([&](const auto& now) { return now.at("run_id") == id && now.at("touches_done") >= 1; });
    SyncClock syncs(cell.state());
    const auto over = cell.wait_until([](const auto& now) {
      const std::string state = now.at("state");
      return state == "COMPLETE" || state == "ABORTED" || state == "HELD" || state == "STOPPED";
    });
    for (const double ms : syncs.end()) figures.syncs_ms.push_back(ms);
    for (const double ms : answers_ms(cell.wire().take())) figures.answers_ms.push_back(ms);
    figures.states += (run == 0 ? "" : ", ") + over.at("state").get<std::string>();
    figures.are_whole = over.at("state") == "COMPLETE";
    if (figures.are_whole) continue;
    figures.states += " (" + over.at("fault_message").dump() + ")";
    break;
  }
  figures.links = cell.wire().links();
  return figures;
}

void tell_median(const char* what, const Figures& figures) {
  std::printf(
      "%-14s %5zu answers: p50 %.2f ms, p99 %.2f ms, longest %.2f ms; fdatasync p50 %.2f, p99 %.2f ms; "
      "runs ended %s\n",
      what, figures.answers_ms.size(), percentile(figures.answers_ms, 0.5),
      percentile(figures.answers_ms, 0.99), percentile(figures.answers_ms, 1.0),
      percentile(figures.syncs_ms, 0.5), percentile(figures.syncs_ms, 0.99), figures.states.c_str());
}

bool measure_quiet(int runs, const std::string& recipe) {
  MeasuredCell cell({.speed = kSpeed});
  const Figures figures = measure(cell, runs, recipe);
  tell_median("quiet", figures);
  return tell("answer to a touch, quiet, p99", percentile(figures.answers_ms, 0.99),
              percentile(figures.syncs_ms, 0.99) + kOverSyncMs) &&
         figures.are_whole;
}

/// The broker and the archive of a plant, which hang where they are asked to.
bool measure_with_plant(int runs, const std::string& recipe, bool hangs) {
  PlantBeside plant("edf");
  MeasuredCell cell({.speed = kSpeed, .daemon_options = plant.daemon_options()});
  cell.wait_until([](const auto& now) {
    return now.at("mqtt_trouble").is_null() && now.at("archive_trouble").is_null();
  });
  if (hangs) plant.hang();
  const Figures figures = measure(cell, runs, recipe);
  const char* const what = hangs ? "hanging plant" : "with a plant";
  tell_median(what, figures);
  return tell("answer to a touch, " + std::string(what) + ", p99", percentile(figures.answers_ms, 0.99),
              percentile(figures.syncs_ms, 0.99) + kOverSyncMs) &&
         figures.are_whole;
}

bool measure_stalled(int runs, const std::string& recipe) {
  MeasuredCell cell({.speed = kSpeed, .can_stall = true});
  int results = 0;
  cell.wire().on_frame([&](const SeenFrame& frame) {
    if (!std::holds_alternative<cs8::TouchResult>(frame.message.payload)) return;
    if (++results % kTouchesBetweenStalls == 0) cell.stall_disk();
  });
  const Figures figures = measure(cell, runs, recipe);
  cell.wire().on_frame({});
  tell_median("stalling disk", figures);
  const bool kept = figures.links == 1 && figures.are_whole;
  std::printf("link and run with a stalling disk: %s (%d links)\n", kept ? "kept" : "LOST", figures.links);
  if (!kept) return false;  // the answers of a run that was lost say nothing
  return tell("answer to a touch, stalling disk, p99", percentile(figures.answers_ms, 0.99),
              kStallMs + kOverStallMs);
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::stoi(argv[1]) : 2;
  const std::string recipe = argc > 2 ? argv[2] : "edf-25";
  try {
    const bool quiet = bench::measure_quiet(runs, recipe);
    const bool told = bench::measure_with_plant(runs, recipe, false);
    const bool hanging = bench::measure_with_plant(runs, recipe, true);
    const bool stalled = bench::measure_stalled(runs, recipe);
    return quiet && told && hanging && stalled ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wire_benchmark: %s\n", error.what());
    return 2;
  }
}
