// What the controller's side costs: a message there and back through the codec, and all that the simulated
// controller works out for a touch at --speed max (its 4 ms ticks, drives, hidden truth, probe, bodies).
// The figures at the end are those of issue 4.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "tests/cs8_protocol/samples.hpp"
#include "tests/sim_controller/bench.hpp"

namespace bench {
namespace {

using sim::testing::Bench;

constexpr double kRoundTripMaxNs = 200.0;
constexpr double kTouchMaxMs = 5.0;
constexpr int kTouches = 100;

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void round_trip(benchmark::State& state, const cs8::Message& message) {
  std::vector<std::uint8_t> buffer;
  for (auto _ : state) {
    buffer.clear();
    cs8::encode(message, buffer);
    benchmark::DoNotOptimize(cs8::decode_frame(buffer));
  }
}

/// Processor time of one touch from the park posture, milliseconds: the longest of kTouches.
double touch_ms(const std::string& truth) {
  const std::string folder = sim::testing::cell_folder("demo");
  const cell::Cell cell = cell::read_cell(folder + "/cell.json");
  cs8::Touch command = sim::testing::touch_command(sim::testing::aimed_touch(cell, {}).motion);
  command.second_speed_um_s = 2'000;
  command.second_backoff_dmm = 20'000;
  Bench bench =
      Bench::ready(sim::make_plant(cell, cell::read_truth(folder + "/" + truth)), {.speed = sim::kSpeedMax});
  double longest_s = 0.0;
  std::uint32_t sequence = 0;
  for (int i = 0; i < kTouches; ++i) {
    const double before_s = processor_s();
    bench.answer<cs8::Accepted>(++sequence, command);
    bench.happen(sim::Tick{});
    longest_s = std::max(longest_s, processor_s() - before_s);
    if (bench.result<cs8::TouchResult>().outcome != cs8::Outcome::kContact)
      throw std::logic_error("no contact");
    bench.send(0, cs8::ResultAcknowledge{sequence});
    bench.answer<cs8::Accepted>(++sequence, sim::testing::travel_command(bench.plant.start_joints));
    bench.result<cs8::MoveResult>();
    bench.send(0, cs8::ResultAcknowledge{sequence});
  }
  return 1e3 * longest_s;
}

/// Nanoseconds of the slowest message there and back.
double slowest_round_trip_ns() {
  double slowest_s = 0.0;
  for (const cs8::Message& message : cs8::one_of_each()) {
    constexpr int kTimes = 100'000;
    std::vector<std::uint8_t> buffer;
    const double before_s = processor_s();
    for (int i = 0; i < kTimes; ++i) {
      buffer.clear();
      cs8::encode(message, buffer);
      benchmark::DoNotOptimize(cs8::decode_frame(buffer));
    }
    slowest_s = std::max(slowest_s, (processor_s() - before_s) / kTimes);
  }
  return 1e9 * slowest_s;
}

void tell(const char* what, double value, double limit, const char* unit) {
  std::printf("%-62s %8.2f %s  (at most %g: %s)\n", what, value, unit, limit,
              value <= limit ? "met" : "MISSED");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  for (const cs8::Message& message : cs8::one_of_each()) {
    benchmark::RegisterBenchmark(("round_trip/" + std::string(cs8::name(cs8::type_of(message)))).c_str(),
                                 bench::round_trip, message);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  bench::tell("codec, slowest message there and back", bench::slowest_round_trip_ns(), bench::kRoundTripMaxNs,
              "ns");
  bench::tell("touch at --speed max, truth.json, longest of 100", bench::touch_ms("truth.json"),
              bench::kTouchMaxMs, "ms");
  bench::tell("touch at --speed max, truth-real.json, longest of 100", bench::touch_ms("truth-real.json"),
              bench::kTouchMaxMs, "ms");
}
