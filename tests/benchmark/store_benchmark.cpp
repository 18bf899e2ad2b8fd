// How long a touch takes from the controller's answer in hand to durable, beside a bare SQLite commit of one
// row in the same run: WAL and synchronous FULL both. Prints the 99th percentiles of each round and their
// medians; ends with 1 when the median is not under the promised time and --judge is given.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "service/store/run_store.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRounds = 5;
constexpr int kTouches = 1000;
constexpr double kPromisedMs = 1.0;

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Work>
double timed_ms(const Work& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct Round {
  std::vector<double> touch_ms, bare_ms;
};

Round make_round(const std::filesystem::path& folder) {
  cell::RunStore store(folder / "touchcal.sqlite");
  const std::int64_t run =
      store.begin_run({.recipe = "edf-25", .touches_total = kTouches, .started_at = "t"});
  SQLite::Database bare((folder / "bare.sqlite").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  bare.exec(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; CREATE TABLE rows(number INTEGER, a, b, c)");
  SQLite::Statement insert(bare, "INSERT INTO rows VALUES(?, 1, 2, 3)");
  const std::string command(1200, 'x');  // as long as a touch command's text
  Round round;
  for (int number = 1; number <= kTouches; ++number) {
    const auto sequence = static_cast<std::uint32_t>(number);
    store.set_open_command(run, {.session = 1, .sequence = sequence, .touch_json = command});
    store.make_durable(run);
    const cell::StoredTouch touch{.number = number,
                                  .plane = 1 + number % 4,
                                  .joints = {number, -2, 3, -4, 5, -6},
                                  .captured_at = "2026-01-31T08:15:30.250Z",
                                  .session = 1,
                                  .sequence = sequence};
    round.touch_ms.push_back(timed_ms([&] { store.append_touch(run, touch); }));
    insert.reset();
    insert.bind(1, number);
    round.bare_ms.push_back(timed_ms([&] { insert.exec(); }));
  }
  return round;
}

}  // namespace

int main(int argc, char** argv) {
  const bool judge = argc > 1 && std::strcmp(argv[1], "--judge") == 0;
  std::vector<double> touch_ms, bare_ms;
  for (int i = 0; i < kRounds; ++i) {
    std::string name = (std::filesystem::temp_directory_path() / "touchcal-store-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return 2;
    const Round round = make_round(name);
    std::filesystem::remove_all(name);
    touch_ms.push_back(percentile(round.touch_ms, 0.99));
    bare_ms.push_back(percentile(round.bare_ms, 0.99));
    std::printf("round %d: touch p50 %.3f p99 %.3f ms, bare commit p50 %.3f p99 %.3f ms\n", i + 1,
                percentile(round.touch_ms, 0.5), touch_ms.back(), percentile(round.bare_ms, 0.5),
                bare_ms.back());
  }
  const double median_ms = percentile(touch_ms, 0.5);
  std::printf("median of %d p99: touch %.3f ms, bare commit %.3f ms (promised: under %.1f ms)\n", kRounds,
              median_ms, percentile(bare_ms, 0.5), kPromisedMs);
  return judge && median_ms >= kPromisedMs ? 1 : 0;
}
