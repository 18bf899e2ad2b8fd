// How fast the identification is: alone, against Ceres on the same residuals, against its own factorisations.
// All in one run on one core, but for the simulated calibrations, which take two. The figures at the end are
// those of issue 14.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "service/base/freed_memory.hpp"
#include "tests/benchmark/bare_factorisations.hpp"
#include "tests/benchmark/ceres_identify.hpp"
#include "tests/benchmark/demo_study.hpp"
#include "tests/calib_core/block_study.hpp"

namespace bench {
namespace {

using calib::IdentificationProblem;
using calib::IdentificationResult;
using calib::IdentificationStatus;
using calib::UniformChance;

constexpr int kCalibrations = 10'000;
constexpr int kThreads = 2;
constexpr double kSameErrors = 1e-6;  // metres and radians

/// One arm with all 37 errors and its exact touches.
struct Study {
  std::vector<calib::study::ExactTouch> exact;
  IdentificationProblem problem;  // 148 noisy touches
  calib::IdentificationOptions options;
};

/// A cell is made a problem once; its touches change.
IdentificationProblem problem_of(std::vector<calib::Touch> touches) {
  static const IdentificationProblem of_cell = [] {
    IdentificationProblem problem{.nominal = calib::paper::nominal(),
                                  .artefact = calib::exact_artefact(calib::paper::planes()),
                                  .touch_noise_m = calib::study::kTouchNoiseMetres};
    for (std::size_t i = 0; i < problem.tolerances.size(); ++i) {
      problem.tolerances[i] = calib::error_parameters()[i].is_length() ? 0.3e-3 : 2e-3;
    }
    problem.attainable = calib::attainable_parameters(problem, {.tried_last = calib::paper::tried_last()});
    return problem;
  }();
  IdentificationProblem problem = of_cell;
  problem.touches = std::move(touches);
  return problem;
}

const Study& study() {
  static const Study made = [] {
    UniformChance chance(1);
    const auto truth = calib::apply(calib::paper::nominal(), calib::study::draw_errors(chance));
    Study study;
    study.exact = calib::study::exact_touches(truth, calib::study::kTouchesPerFace, chance);
    study.problem =
        problem_of(calib::study::with_noise(study.exact, calib::study::kTouchNoiseMetres, chance));
    study.options.identifiability.tried_last = calib::paper::tried_last();
    return study;
  }();
  return made;
}

/// What every benchmark works on; throws unless it is the problem that the figures speak of.
const IdentificationResult& identified() {
  static const IdentificationResult result = [] {
    const IdentificationResult made = identify(study().problem, study().options);
    if (made.status != IdentificationStatus::kConverged) throw std::runtime_error(made.message);
    if (made.identifiable.columns.size() != kIdentifiedCount) throw std::runtime_error("not 25 identified");
    return made;
  }();
  return result;
}

CeresResult solve_with_ceres(CeresForm form, Covariance covariance) {
  static const std::vector<calib::ContactSurface> planes = calib::paper::planes();
  return ceres_identify(study().problem.nominal, planes, study().problem.touches,
                        identified().identifiable.columns, form, covariance);
}

void identify_whole(benchmark::State& state) {
  state.counters["iterations"] = static_cast<double>(identified().iterations.size());
  state.counters["identified"] = static_cast<double>(identified().identifiable.columns.size());
  // The result replaces the one before it, as everywhere; freed first, its memory would go back to the
  // system.
  IdentificationResult latest;
  for (auto _ : state) {
    latest = identify(study().problem, study().options);
    benchmark::DoNotOptimize(latest);
  }
}

void identify_demo(benchmark::State& state, bool rigid) {
  const DemoStudy demo = demo_study(rigid);
  IdentificationResult latest = identify(demo.problem, demo.options);
  if (latest.status != IdentificationStatus::kConverged) throw std::runtime_error(latest.message);
  state.counters["iterations"] = static_cast<double>(latest.iterations.size());
  state.counters["unknowns"] = unknown_count(latest);
  for (auto _ : state) {
    latest = identify(demo.problem, demo.options);
    benchmark::DoNotOptimize(latest);
  }
}

/// Problem and solver are made anew each time, as identify() does; a fair fight ends at the same errors.
void ceres_same_problem(benchmark::State& state, CeresForm form, Covariance covariance) {
  const CeresResult result = solve_with_ceres(form, covariance);
  const double apart =
      (result.errors - identified().errors.head<calib::kErrorParameterCount>()).cwiseAbs().maxCoeff();
  if (!result.converged || !(apart < kSameErrors)) {
    throw std::runtime_error("Ceres ends elsewhere: errors differ by " + std::to_string(apart));
  }
  state.counters["iterations"] = result.iterations;
  state.counters["apart"] = apart;
  for (auto _ : state) benchmark::DoNotOptimize(solve_with_ceres(form, covariance));
}

void bare_factorisations(benchmark::State& state) {
  const Matrices matrices =
      matrices_of(study().problem.nominal, calib::paper::planes(), study().problem.touches, identified());
  for (auto _ : state) benchmark::DoNotOptimize(factorise(matrices));
}

/// What cell::Run::add does once the touch is stored.
void live_after_one_touch(benchmark::State& state) {
  IdentificationProblem problem = study().problem;
  IdentificationResult latest;
  const calib::Touch last = problem.touches.back();
  constexpr double kTurn = 2.0;  // radians; half the range of the postures asked for
  const calib::JointRanges ranges{calib::JointVector::Constant(-kTurn), calib::JointVector::Constant(kTurn)};
  const calib::TipRegion region = calib::region_over_joint_ranges(problem.nominal, ranges, {}, 500);
  for (auto _ : state) {
    problem.touches.pop_back();
    problem.touches.push_back(last);
    latest = identify(problem, study().options);
    benchmark::DoNotOptimize(region.rms_m(latest.uncertainty->covariance()));
  }
}

/// Counts the calibrations that do not converge to 25 parameters, of every kThreads-th seed.
int calibrate_seeds(int first) {
  int failed = 0;
  for (int seed = first; seed < kCalibrations; seed += kThreads) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    const IdentificationResult result =
        identify(problem_of(calib::study::with_noise(study().exact, calib::study::kTouchNoiseMetres, chance)),
                 study().options);
    const bool good = result.status == IdentificationStatus::kConverged &&
                      result.identifiable.columns.size() == kIdentifiedCount;
    failed += good ? 0 : 1;
  }
  return failed;
}

void ten_thousand_calibrations(benchmark::State& state) {
  study();
  for (auto _ : state) {
    std::array<int, kThreads> failed{};
    {
      std::vector<std::jthread> threads;
      for (int i = 0; i < kThreads; ++i) {
        threads.emplace_back([&failed, i] { failed[static_cast<std::size_t>(i)] = calibrate_seeds(i); });
      }
    }
    state.counters["failed"] = std::accumulate(failed.begin(), failed.end(), 0);
  }
}

BENCHMARK(identify_whole)->Name("IdentifyWhole")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ceres_same_problem, usual, CeresForm::kUsual, Covariance::kYes)
    ->Name("CeresSameProblem")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ceres_same_problem, usual, CeresForm::kUsual, Covariance::kNo)
    ->Name("CeresWithoutCovariance")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ceres_same_problem, tuned, CeresForm::kTuned, Covariance::kYes)
    ->Name("CeresTuned")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ceres_same_problem, analytic, CeresForm::kAnalytic, Covariance::kYes)
    ->Name("CeresAnalytic")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(identify_demo, rigid, true)->Name("IdentifyDemoRigid")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(identify_demo, shipped, false)->Name("IdentifyDemo")->Unit(benchmark::kMicrosecond);
BENCHMARK(bare_factorisations)->Name("BareFactorisations")->Unit(benchmark::kMicrosecond);
BENCHMARK(live_after_one_touch)->Name("LiveAfterOneTouch")->Unit(benchmark::kMicrosecond);
BENCHMARK(ten_thousand_calibrations)
    ->Name("TenThousandCalibrations")
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();

/// Prints what Google Benchmark prints and keeps the times: of the processor, as the machine may have other
/// work, or of the clock where a benchmark has threads.
class TimesReporter : public benchmark::ConsoleReporter {
 public:
  using ConsoleReporter::ConsoleReporter;

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const bool is_median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      if (run.error_occurred || !(is_median || run.run_type == Run::RT_Iteration)) continue;
      const bool of_the_clock = run.run_name.time_type == "real_time";
      seconds_[run.run_name.function_name] =
          (of_the_clock ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime()) /
          benchmark::GetTimeUnitMultiplier(run.time_unit);
    }
    ConsoleReporter::ReportRuns(runs);
  }

  /// With repetitions the median. NaN for what was filtered out.
  [[nodiscard]] double seconds(const std::string& name) const {
    const auto found = seconds_.find(name);
    return found == seconds_.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
  }

 private:
  std::map<std::string, double> seconds_;
};

void print_figures(const TimesReporter& times) {
  const auto print = [](const char* what, double value, const char* wanted) {
    if (!std::isnan(value)) std::printf("%-64s %8.2f   %s\n", what, value, wanted);
  };
  const double whole = times.seconds("IdentifyWhole");
  std::printf("\n");
  print("whole identification, ms", 1e3 * whole, "at most 0.45");
  print("times faster than Ceres", times.seconds("CeresSameProblem") / whole, "at least 28");
  print("times faster than Ceres without its covariance", times.seconds("CeresWithoutCovariance") / whole,
        "");
  print("times faster than Ceres with all that could be tuned", times.seconds("CeresTuned") / whole,
        "over 1");
  print("times faster than that with analytic derivatives", times.seconds("CeresAnalytic") / whole, "over 1");
  print("cell demo, rigid: 43 unknowns, ms", 1e3 * times.seconds("IdentifyDemoRigid"), "under 1.2");
  print("cell demo with all that it takes on, ms", 1e3 * times.seconds("IdentifyDemo"), "");
  print("times its bare factorisations", whole / times.seconds("BareFactorisations"), "at most 8");
  print("after one touch, ms", 1e3 * times.seconds("LiveAfterOneTouch"), "under 1");
  print("10,000 simulated calibrations on two cores, s", times.seconds("TenThousandCalibrations"),
        "under 3.5");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  cell::keep_freed_memory();  // as touchcal
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  bench::TimesReporter times(benchmark::ConsoleReporter::OO_Tabular);
  benchmark::RunSpecifiedBenchmarks(&times);
  bench::print_figures(times);
  return 0;
}
