// Whole runs over loopback: what a customer sees when nothing goes wrong.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "calib_core/identification/identify.hpp"
#include "config/identification_problem.hpp"
#include "config/touches_file.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/result_view.hpp"
#include "service/run/run.hpp"
#include "service/run/run_repeats.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::State;

/// The cell `edf` has Table III for its truth, whose lengths are together far beyond the maker's tolerances.
bool is_flagged(const std::string& cell_name) { return cell_name == "edf"; }

class WholeRun : public ::testing::TestWithParam<const char*> {
 protected:
  WholeRun() : loop_(GetParam()) {
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
    run_id_ = loop_.start(kRecipe);
    loop_.run_until_over();
  }

  /// What the run has to be worth.
  static cell::Verdict expected_verdict() {
    return is_flagged(GetParam()) ? cell::Verdict::kRejected : cell::Verdict::kAccepted;
  }

  LoopbackCell loop_;
  std::int64_t run_id_ = 0;
};

TEST_P(WholeRun, EndsCompleteWithThePromisedFiguresAndOnlyTableThreeIsFlagged) {
  const cell::Status status = loop_.status();
  EXPECT_EQ(status.state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(status.verdict, expected_verdict());
  EXPECT_EQ(status.last_accepted_run_id.has_value(), !is_flagged(GetParam()));
  EXPECT_GT(status.predicted_tip_rms_m.value_or(0.0), 0.0);
  EXPECT_EQ(loop_.store().touches(run_id_).size(), static_cast<std::size_t>(kTouchCount));

  const calib::IdentificationResult& result = loop_.operation().run()->latest();
  EXPECT_EQ(result.identifiable.columns.size(), static_cast<std::size_t>(kRank));
  EXPECT_LE(result.iterations.size(), static_cast<std::size_t>(kIterationsMax));
  EXPECT_LT(result.iterations.back().condition_number, kConditionNumberMax);
  EXPECT_EQ(result.scale.value().warning.empty(), !is_flagged(GetParam())) << result.scale->warning;
  const HeldOut figures = held_out(result);
  EXPECT_EQ(figures.touch_count, kPlaneCount * kHeldOutPerPlane);
  EXPECT_LE(figures.mean_max_m, kHeldOutMeanMaxMetres);
  EXPECT_LE(figures.rms_m, kHeldOutRmsMaxPart * loop_.cell.touch_noise_m);
  EXPECT_GE(figures.rms_removed, kRmsRemovedMin);

  const auto stored = loop_.store().run(run_id_).value();
  EXPECT_EQ(stored.outcome, cell::RunOutcome::kComplete);
  EXPECT_EQ(stored.verdict, expected_verdict());
  EXPECT_EQ(stored.touches_total, kTouchCount);
  EXPECT_EQ(stored.touches_done, kTouchCount);
  EXPECT_FALSE(stored.fault_code);
}

TEST_P(WholeRun, ItTellsWhatMoreTouchesWouldBring) {
  EXPECT_THAT(loop_.status().touch_benefit.value_or(""),
              ::testing::MatchesRegex("8 more on plane [1-5]: .* to .* mm"));
}

TEST_P(WholeRun, ARunThatIsAccurateEnoughLeavesOutTheOtherTouchesToFitAndHoldsOutAll) {
  cell::Recipe recipe = loop_.cell.recipes.at(kRecipe);
  recipe.name = "enough";
  recipe.goal.tip_rms_max_m = 3.0 * loop_.status().predicted_tip_rms_m.value();
  LoopbackCell loop(GetParam());
  loop.cell.recipes.emplace(recipe.name, recipe);
  loop.serve();
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t run_id = loop.start(recipe.name);
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  const cell::Run& run = *loop.operation().run();
  EXPECT_LT(run.touches_total(), kTouchCount);
  EXPECT_EQ(run.touches_done(), run.touches_total());
  EXPECT_EQ(loop.store().run(run_id).value().touches_total, run.touches_total());
  EXPECT_EQ(held_out(run.latest()).touch_count, kPlaneCount * kHeldOutPerPlane);
  EXPECT_LE(loop.status().predicted_tip_rms_m.value_or(1.0), *recipe.goal.tip_rms_max_m);
}

TEST_P(WholeRun, AnotherStartsStraightFromItsEnd) {
  const std::int64_t second = loop_.start(kRecipe);
  EXPECT_NE(second, run_id_);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().verdict, expected_verdict());
  EXPECT_EQ(loop_.store().touches(second).size(), static_cast<std::size_t>(kTouchCount));
  EXPECT_EQ(loop_.store().touches(run_id_).size(), static_cast<std::size_t>(kTouchCount));
}

TEST_P(WholeRun, ItsTouchesReadBackFromAFileGiveTheSameResultToTheBit) {
  const std::string document =
      cell::touches_document(loop_.cell, loop_.store().touches(run_id_), loop_.store().references(run_id_));
  const cell::TouchesFile file =
      cell::touches_from_json("the run's touches", document, cell::kTouchesSizeMax, loop_.cell);
  EXPECT_EQ(file.repeats.two_speed.size(), file.touches.size()) << "each was touched at two speeds";
  EXPECT_EQ(file.repeats.reference_times_s.size(), file.repeats.references.size());
  const cell::Recipe& recipe = loop_.cell.recipes.at(kRecipe);
  calib::IdentificationProblem problem = cell::identification_problem(loop_.cell, recipe);
  problem.touches = file.touches;
  cell::note_repeats(file.repeats, problem);
  const calib::IdentificationResult again = calib::identify(problem, recipe.identification);
  const calib::IdentificationResult& live = loop_.operation().run()->latest();
  EXPECT_TRUE((again.errors.array() == live.errors.array()).all());
  const auto& two_speed = problem.repeat_sources.two_speed;
  ASSERT_TRUE(two_speed.noise);
  EXPECT_EQ(two_speed.noise->degrees_of_freedom, static_cast<double>(kTouchCount - kPlaneCount));
  EXPECT_LT(two_speed.noise->std_m, 0.5 * loop_.cell.touch_noise_m) << "one trigger's noise is in both";
  EXPECT_FALSE(two_speed.used);
  const cell::TipRegions regions(loop_.cell);
  const auto stored = loop_.store().run(run_id_);
  const cell::ResultContext context{.warnings = {}, .conditions = stored->conditions_json.value()};
  EXPECT_TRUE(cell::result_document(regions, recipe, problem, again, context) ==
              loop_.store().result_json(run_id_));
}

TEST(Conditions, AreKeptWithTheRunWhenItStarts) {
  LoopbackCell loop;
  loop.serve();
  loop.launch();
  loop.run_until(State::kIdle);
  const auto started = std::get<cell::Started>(
      loop.ask_to_start({.recipe = kShortRecipe, .idempotency_key = {}, .operator_name = "A. Turing"}));
  const cell::StoredRun stored = loop.store().run(started.run.id).value();
  const auto kept = nlohmann::json::parse(stored.conditions_json.value());
  EXPECT_EQ(kept.at("operator"), "A. Turing");
  EXPECT_EQ(kept.at("config_digest"), stored.config_digest.value());
  EXPECT_EQ(kept.at("block_temperature_c"), loop.cell.block.temperature_c.value());
  EXPECT_EQ(kept.at("block").at("name"), loop.cell.block.name);
  EXPECT_THAT(kept.at("versions").at("controller_application").get<std::string>(),
              ::testing::MatchesRegex("touchcal [0-9.]+, VAL3 s[0-9.]+"));
  EXPECT_TRUE(kept.at("controller_session").is_number_unsigned());
  EXPECT_EQ(nlohmann::json::parse(cell::run_document(stored)).at("conditions"), kept);
}

TEST(Conditions, ATemperatureThatComesWithTheRunIsUsedInAllOfItAndForNoOther) {
  LoopbackCell loop("demo");
  loop.serve();
  loop.launch();
  loop.run_until(State::kIdle);
  const auto now = std::chrono::system_clock::now();
  const auto started = std::get<cell::Started>(
      loop.ask_to_start({.recipe = kShortRecipe,
                         .idempotency_key = {},
                         .operator_name = {},
                         .block_temperature = cell::BlockTemperature{25.0, 0.5, now}}));
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  const auto warm = loop.operation().run()->problem().artefact.contact_planes;
  const std::int64_t next = loop.start();  // at once: the link ages while this thread computes

  const auto result = nlohmann::json::parse(loop.store().result_json(started.run.id).value());
  EXPECT_EQ(result.at("conditions").at("block_temperature_c"), 25.0);
  EXPECT_EQ(result.at("conditions").at("std_temperature_k"), 0.5);
  EXPECT_EQ(result.at("conditions").at("block_temperature_source"), "run");

  const cell::Recipe& recipe = loop.cell.recipes.at(kShortRecipe);
  const auto cool = cell::identification_problem(loop.cell, recipe).artefact.contact_planes;
  const cell::Probe& probe = loop.cell.probe;
  const double ball_m = probe.stylus.radius_m - probe.stylus.pretravel_m;
  for (std::size_t i = 0; i < warm.size(); ++i)
    EXPECT_NEAR(warm[i].offset_m - ball_m, (cool[i].offset_m - ball_m) * (1.0 + 5.0 * 2.36e-5), 1e-9) << i;

  const cell::StoredRun stored = loop.store().run(started.run.id).value();
  EXPECT_EQ(stored.block_temperature.value().celsius, 25.0);
  EXPECT_EQ(stored.block_temperature->std_k, 0.5);
  EXPECT_EQ(stored.block_temperature->source, "run");
  EXPECT_TRUE(stored.block_temperature->measured_at);
  EXPECT_EQ(loop.store().run(next)->block_temperature->source, "file");
  EXPECT_EQ(loop.operation().run()->problem().artefact.contact_planes.front().offset_m,
            cool.front().offset_m);
}

INSTANTIATE_TEST_SUITE_P(Cells, WholeRun, ::testing::Values("edf", "demo"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace touchcal::testing
