// How many lines of VAL3 the machine carries out in a second: simple ones, calls, structures and strings.
#include <benchmark/benchmark.h>

#include "tests/val3/running.hpp"

namespace val3 {
namespace {

void run_lines(benchmark::State& state, const std::string& lines, const std::string& declared = "") {
  SmallProject project;
  project.number("n", 4).flag("b").data("s", "string", "", 2).data("j", "jointRx", "", 2);
  project.program("add", "x_nSum=x_nSum+x_nPart",
                  SmallProject::parameters(
                      SmallProject::parameter("x_nPart", "num", "xsi:type=\"element\"") +
                      SmallProject::parameter("x_nSum", "num", "xsi:type=\"element\" use=\"reference\"")));
  project.program("start", "while true\n" + lines + "\nendWhile", declared);
  Running run(project, {.lines_per_tick = 100'000});
  const std::uint64_t before = run.machine().lines();
  for ([[maybe_unused]] auto _ : state) run.machine().tick();
  state.counters["lines"] =
      benchmark::Counter(static_cast<double>(run.machine().lines() - before), benchmark::Counter::kIsRate);
}

void BM_SimpleLines(benchmark::State& state) {
  run_lines(state, "l_n=l_n+1\nn[1]=n[0]*2-l_n\nb=l_n>5 and n[1]<=7\nif b\nn[2]=n[2]+1\nendIf",
            SmallProject::local("l_n", "num"));
}
BENCHMARK(BM_SimpleLines);

void BM_Calls(benchmark::State& state) { run_lines(state, "call add(3,n[0])"); }
BENCHMARK(BM_Calls);

void BM_Structures(benchmark::State& state) {
  run_lines(state, "j[0]=j[0]+{1,0,0,0,0,0}\nj[1].j3=j[0].j1\ns[0]=left(\"text\",2)+s[1]");
}
BENCHMARK(BM_Structures);

}  // namespace
}  // namespace val3

BENCHMARK_MAIN();
