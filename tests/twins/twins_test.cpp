// The two programs for one controller, driven by the same scenarios: what a host sees is the same, but for
// what is listed.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim_controller/fault_names.hpp"
#include "tests/twins/comparison.hpp"
#include "tests/twins/host.hpp"
#include "tests/twins/known_differences.hpp"
#include "tests/twins/scenarios.hpp"
#include "tests/twins/twin.hpp"

namespace twins {
namespace {

using Group = std::vector<Scenario> (*)();
constexpr Group kGroups[] = {whole_runs,
                             measurements,
                             interrupted_touches,
                             interrupted_second_touches,
                             interrupted_ways_back,
                             sequences,
                             fields,
                             links,
                             permits};

void expect_alike(const std::vector<Scenario>& scenarios) {
  for (const Scenario& scenario : scenarios) {
    SCOPED_TRACE(scenario.name);
    const Record fast = carry_out(scenario, *make_fast_twin(scenario));
    const Record val3 = carry_out(scenario, *make_val3_twin(scenario));
    bool is_told = false;
    for (const Difference& found : differences(fast, val3)) {
      if (known(scenario, found) != nullptr) continue;
      ADD_FAILURE() << scenario.name << ": " << found.where << ": C++ " << found.fast << ", VAL3 "
                    << found.val3 << (is_told ? std::string() : "\n" + side_by_side(fast, val3));
      is_told = true;
    }
  }
}

TEST(Twins, WholeRunsAreAlike) { expect_alike(whole_runs()); }
TEST(Twins, MeasurementsAreAlike) { expect_alike(measurements()); }
TEST(Twins, InterruptedTouchesAreAlike) { expect_alike(interrupted_touches()); }
TEST(Twins, InterruptedSecondTouchesAreAlike) { expect_alike(interrupted_second_touches()); }
TEST(Twins, InterruptedWaysBackAreAlike) { expect_alike(interrupted_ways_back()); }
TEST(Twins, SequencesAreAlike) { expect_alike(sequences()); }
TEST(Twins, RefusedFieldsAreAlike) { expect_alike(fields()); }
TEST(Twins, LinksAreAlike) { expect_alike(links()); }
TEST(Twins, PermitsAreAlike) { expect_alike(permits()); }

std::vector<cs8::TouchResult> touch_results(const Record& record) {
  std::vector<cs8::TouchResult> results;
  for (const Entry& entry : record.entries) {
    const auto* message = std::get_if<cs8::Message>(&entry.what);
    if (message == nullptr) continue;
    if (const auto* result = std::get_if<cs8::TouchResult>(&message->payload)) results.push_back(*result);
  }
  return results;
}

TEST(Twins, MeasurementsDoWhatTheirNamesSay) {
  for (const Scenario& scenario : measurements()) {
    SCOPED_TRACE(scenario.name);
    const Record record = carry_out(scenario, *make_val3_twin(scenario));
    const std::vector<cs8::TouchResult> results = touch_results(record);
    EXPECT_TRUE(record.unfired.empty());
    for (const Entry& entry : record.entries) {
      const auto* noted = std::get_if<Noted>(&entry.what);
      EXPECT_FALSE(noted != nullptr && noted->what.starts_with("no jog")) << noted->what;
    }
    ASSERT_FALSE(results.empty());
    const bool meets_nothing = scenario.name.find("meets nothing") != std::string::npos;
    EXPECT_EQ(results.front().outcome == cs8::Outcome::kNoContact, meets_nothing);
    if (scenario.name.find("stopped") == std::string::npos) {
      EXPECT_EQ(results.back().outcome, cs8::Outcome::kContact) << "the last one is made";
    }
    const bool is_guided =
        scenario.name.find("hand") != std::string::npos || scenario.name.find("jogs") != std::string::npos;
    EXPECT_EQ(std::ranges::any_of(record.states,
                                  [](const Record::SeenState& seen) {
                                    return seen.state.mode == cs8::WorkingMode::kManual &&
                                           (seen.state.flags & cs8::kProbeTouched) != 0;
                                  }),
              is_guided);
  }
}

TEST(Twins, AreDrivenByEveryFaultOrSomethingSaysWhyNot) {
  std::set<std::string> names;
  for (const Group group : kGroups) {
    for (const Scenario& scenario : group()) {
      EXPECT_TRUE(names.insert(scenario.name).second) << scenario.name << " is there twice";
    }
  }
  EXPECT_GE(names.size(), 300u);
  for (const std::string& fault : sim::fault_names()) {
    const bool is_struck =
        std::ranges::any_of(names, [&](const std::string& name) { return name.starts_with(fault + " "); });
    const bool is_left_out = std::ranges::find(left_out(), fault, &LeftOut::fault) != left_out().end();
    EXPECT_NE(is_struck, is_left_out) << fault;
  }
}

TEST(Twins, EveryKnownDifferenceIsStillThere) {
  std::set<const KnownDifference*> seen;
  for (const Group group : kGroups) {
    for (const Scenario& scenario : group()) {
      const Record fast = carry_out(scenario, *make_fast_twin(scenario));
      const Record val3 = carry_out(scenario, *make_val3_twin(scenario));
      for (const Difference& found : differences(fast, val3)) seen.insert(known(scenario, found));
    }
  }
  for (const KnownDifference& known : known_differences())
    EXPECT_TRUE(seen.contains(&known)) << known.scenario << ": " << known.where << " differs no more";
}

}  // namespace
}  // namespace twins
