#include <gmock/gmock.h>

#include <set>

#include "config/fault_file.hpp"
#include "sim_controller/fault_names.hpp"
#include "tests/simulation/invariants.hpp"
#include "tests/simulation/shrinking.hpp"
#include "tests/simulation/world.hpp"

namespace simulation {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using namespace std::chrono_literals;

/// The end of the journal: what a person reads first.
std::string last_lines(const std::string& journal) {
  constexpr std::size_t kShown = 6'000;
  return journal.size() <= kShown ? journal : "...\n" + journal.substr(journal.size() - kShown);
}

void expect_unbroken(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Scenario scenario = scenario_of(seed);
    const Outcome outcome = run_world(scenario);
    if (!outcome.broken.empty()) ADD_FAILURE() << last_lines(broken_report(scenario, outcome));
  }
}

/// A sample for who works on it; touchcal-sim runs thousands (README.md there), also before a change lands.
TEST(Seeds, OneToFortyBreakNoInvariant) { expect_unbroken(1, 40); }

TEST(World, OfOneSeedIsTheSameToTheByte) {
  for (const std::uint64_t seed : {3U, 7U, 10U, 24U}) {
    const Outcome first = run_world(scenario_of(seed));
    const Outcome again = run_world(scenario_of(seed));
    EXPECT_GT(first.journal.size(), 1000u);
    EXPECT_EQ(first.journal, again.journal) << "seed " << seed;
  }
}

TEST(World, WithoutFaultsMakesEachTouchOnceAndHasAResult) {
  const Outcome outcome = run_world(scenario_of(10));
  const RunRecord& run = outcome.record.stores.back().runs.back();
  EXPECT_EQ(run.run.outcome, cell::RunOutcome::kComplete);
  EXPECT_EQ(static_cast<int>(run.touches.size()), scenario_of(10).touch_count);
  EXPECT_EQ(outcome.record.acknowledged.size(), run.touches.size());
  EXPECT_TRUE(run.result_json);
}

/// Else what every accepted run keeps would be asked of none.
TEST(World, OfAWholePlanIsAcceptedWhenNothingGoesWrong) {
  for (const std::uint64_t seed : {99U, 199U, 299U}) {
    const Outcome outcome = run_world(with_only(scenario_of(seed), {}));
    const RunRecord& run = outcome.record.stores.back().runs.front();
    EXPECT_EQ(run.run.verdict, cell::Verdict::kAccepted) << last_lines(outcome.journal);
    EXPECT_EQ(run.touches.size(), setting().plan->touches.touches.size());
  }
}

TEST(World, WhoseDiskLosesWhatItSaidWasSyncedIsFound) {
  Scenario scenario{.seed = 1, .touch_count = 8};
  scenario.faults.push_back({.at = 100s, .kind = FaultKind::kPowerFails, .number = 1});
  scenario.sabotage = [](Disk& disk) { disk.trouble = DiskTrouble::kSyncLies; };
  scenario.sabotaged_at = 50s;
  EXPECT_THAT(run_world(scenario).broken, Contains(StartsWith("answered_touches_are_durable")));
}

/// Its command was not durable once: the contact that the controller still had was acknowledged and lost.
TEST(World, WhosePowerFailsAtAnyWriteOfATouchLosesNoAnswer) {
  for (int write = 1; write <= 10; ++write) {
    Scenario scenario{.seed = 1, .touch_count = kTouchesMin, .speed = kQuickSpeed};
    scenario.faults.push_back({.at = 30s, .kind = FaultKind::kPowerFails, .number = write});
    const Outcome outcome = run_world(scenario);
    EXPECT_THAT(outcome.broken, IsEmpty()) << "write " << write << "\n" << last_lines(outcome.journal);
    EXPECT_THAT(outcome.journal, HasSubstr("the power of the daemon's machine fails"));
  }
}

/// A contact that was no measurement was acknowledged, the power failed, and the daemon asked for its answer
/// again: the second acknowledgement was taken for one of a touch that was lost.
TEST(World, WhosePowerFailsBehindAContactThatIsNoMeasurementLosesNoAnswer) {
  const Outcome outcome = run_world(with_only(scenario_of(1661), {2, 3, 4}));
  EXPECT_THAT(outcome.broken, IsEmpty()) << last_lines(outcome.journal);
  EXPECT_THAT(outcome.journal, HasSubstr("the power of the daemon's machine fails"));
}

TEST(World, WhoseDaemonDiesAtAnyWriteOfAStartLosesNoAnswer) {
  for (const FaultKind kind : {FaultKind::kKilledAtStart, FaultKind::kPowerFailsAtStart}) {
    for (const Time at : {Time{0}, Time{30s}}) {  // the first start makes the store
      for (const int write : {1, 2, 3, 5, 8, 20, 60, 150, 400, 1000}) {
        Scenario scenario{.seed = 1, .touch_count = kTouchesMin, .speed = kQuickSpeed};
        scenario.faults.push_back({.at = at, .kind = kind, .number = write});
        const Outcome outcome = run_world(scenario);
        EXPECT_THAT(outcome.broken, IsEmpty()) << fault_text(scenario.faults.front()) << "\n"
                                               << last_lines(outcome.journal);
        EXPECT_THAT(outcome.journal, HasSubstr("while it starts")) << fault_text(scenario.faults.front());
      }
    }
  }
}

/// The person once looked at the probe where the arm stood at a face, and never again.
TEST(World, WhoseProbeIsTouchedAndItsCableCutIsMendedByThePerson) {
  Scenario scenario = scenario_of(1171);
  const auto of_controller = [&scenario](Time at, const char* line) {
    scenario.faults.push_back({.at = at, .kind = FaultKind::kController, .line = line});
  };
  scenario.faults.clear();
  of_controller(21'585ms, R"({"fault":"contact_short"})");
  of_controller(64'254ms, R"({"fault":"probe_touched"})");
  of_controller(67'081ms, R"({"fault":"loop_cut"})");
  const Outcome outcome = run_world(scenario);
  EXPECT_THAT(outcome.broken, IsEmpty()) << last_lines(outcome.journal);
}

TEST(DrawnFaults, AreOfEveryKindAndEveryLineOfTheController) {
  std::set<FaultKind> kinds;
  std::set<std::string> lines;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    for (const DrawnFault& fault : draw_faults(seed, 12)) {
      kinds.insert(fault.kind);
      if (fault.kind == FaultKind::kController) lines.insert(fault.line);
    }
  }
  EXPECT_EQ(kinds.size(), static_cast<std::size_t>(FaultKind::kCommand) + 1);
  EXPECT_EQ(lines.size(), controller_lines().size());
}

TEST(DrawnFaults, OfTheControllerAreAsTheSimulatorWantsThem) {
  for (const std::string& line : controller_lines())
    EXPECT_NO_THROW(sim::planned(std::get<cell::DeclaredFault>(cell::parse_control_line(line)))) << line;
}

}  // namespace
}  // namespace simulation
