// A block with a bored ring beside it, at a place that nobody knows: planned, touched by the simulator,
// identified.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "config/truth.hpp"
#include "service/base/exit_code.hpp"
#include "service/run/run.hpp"
#include "tests/config/cell_with_bore.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::State;
using ::testing::HasSubstr;

constexpr std::size_t kBore = 5;
constexpr double kBoreHeldOutRmsPart = 2.0;  // as with a ball: fewer touches for more parameters

TEST(WholeRunWithABore, FindsTheArmAndTheAxis) {
  const cell::Folder files;
  LoopbackCell loop("demo");
  cell::Recipe& recipe = loop.use(
      cell::read_cell(cell::write_demo_with(cell::block_with_ring(cell::bore_of_ring()), files)), 3'000);
  recipe.goal.fit_count = 60;
  const Eigen::Vector3d shift_m(1.1e-3, 0.4e-3, -0.8e-3), turn_rad(3e-3, 0, -4e-3);
  loop.run_whole(kFewCandidates,
                 {.errors = shipped_truth("demo"), .bore_shifts_m = {shift_m}, .bore_turns_rad = {turn_rad}});

  ASSERT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  EXPECT_EQ(loop.status().verdict, cell::Verdict::kAccepted);
  const calib::IdentificationProblem& problem = loop.operation().run()->problem();
  const calib::IdentificationResult& result = loop.operation().run()->latest();
  const auto in_bore = std::ranges::count(problem.touches, static_cast<int>(kBore), &calib::Touch::face);
  EXPECT_GE(in_bore, 12);  // 10 held out, and a few to fit
  EXPECT_TRUE(result.rejected.empty());
  EXPECT_LE(held_out(result).mean_max_m, loop.cell.acceptance.held_out_mean_max_m);
  EXPECT_LE(held_out(result).rms_m, kBoreHeldOutRmsPart * loop.cell.touch_noise_m);
  int of_bore = 0;
  for (std::size_t k = 0; k < problem.artefact.parameters.size(); ++k) {
    const calib::ArtefactParameter& parameter = problem.artefact.parameters[k];
    const bool is_axis = parameter.kind == calib::ArtefactKind::kBoreAxis;
    if (!is_axis && parameter.kind != calib::ArtefactKind::kBoreTilt) continue;
    ++of_bore;
    const calib::ArtefactParameter::Shift& shift = parameter.shifts[kBore];
    const auto index = static_cast<Eigen::Index>(k);
    const double true_error = is_axis ? shift_m.dot(shift.center) : turn_rad.dot(shift.turn);
    const double std = result.uncertainty->artefact_std[index];
    EXPECT_LE(std::abs(result.artefact_errors[index] - true_error), 4.0 * std) << parameter.name;
    EXPECT_LE(std, is_axis ? 0.1e-3 : 3e-3) << parameter.name;
  }
  EXPECT_EQ(of_bore, 4);
}

class CommandsWithABore : public ::testing::Test {
 protected:
  Finished plan(const nlohmann::json& bore) {
    const std::string cell = cell::write_demo_with(cell::block_with_ring(bore), files_).string();
    return Process({"touchcal", "plan", "--cell", cell, "--recipe", "quick", "--json"}, folder_ / "call.err")
        .wait();
  }
  cell::Folder files_;
  Folder folder_;
};

TEST_F(CommandsWithABore, PlanRefusesOneThatIsTooNarrowOrTooShallow) {
  nlohmann::json bore = cell::bore_of_ring();
  bore["radius_mm"] = 20;
  Finished finished = plan(bore);
  EXPECT_EQ(finished.exit_code, cell::kExitRefused) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("plane 6"));
  EXPECT_THAT(finished.err, HasSubstr("too narrow for the stylus ball"));
  EXPECT_THAT(finished.err, HasSubstr("it needs a radius of 27 mm"));
  bore["radius_mm"] = 27;
  finished = plan(bore);
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << "just as wide as was asked for: " << finished.err;
  bore = cell::bore_of_ring();
  bore["depth_mm"] = {2, 20};
  finished = plan(bore);
  EXPECT_EQ(finished.exit_code, cell::kExitRefused) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("depth_mm"));
}

TEST_F(CommandsWithABore, IdentifyTakesItsTouchesAndRefusesThoseOfOneSide) {
  const Finished planned = plan(cell::bore_of_ring());
  ASSERT_EQ(planned.exit_code, cell::kExitDone) << planned.err;
  nlohmann::json all{{"schema", "touchcal/touches/1"}, {"arm", "tx90"}, {"touches", nlohmann::json::array()}};
  nlohmann::json one_side = all;
  std::optional<std::array<double, 3>> first;
  const nlohmann::json plan_document = nlohmann::json::parse(planned.out);
  for (const nlohmann::json& touch : plan_document.at("touches")) {
    const nlohmann::json made{
        {"plane", touch.at("plane")}, {"joints_deg", touch.at("joints_deg")}, {"role", touch.at("role")}};
    all["touches"].push_back(made);
    const auto way = touch.at("search_direction").get<std::array<double, 3>>();
    if (touch.at("plane") == 6 && !first) first = way;
    const double along = first ? way[0] * first->at(0) + way[2] * first->at(2) : 0.0;
    if (touch.at("plane") != 6 || along > 0.99) one_side["touches"].push_back(made);
  }
  const auto identify = [&](const nlohmann::json& touches) {
    return Process({"touchcal", "identify", "--cell", (files_.path() / "cell.json").string(), "--recipe",
                    "quick", "--touches", files_.write("touches.json", touches.dump()).string(), "--json"},
                   folder_ / "call.err")
        .wait();
  };
  const Finished found = identify(all);
  ASSERT_TRUE(found.exit_code == cell::kExitDone || found.exit_code == cell::kExitLimitsMissed) << found.err;
  int of_axis = 0;
  const nlohmann::json result = nlohmann::json::parse(found.out);
  for (const nlohmann::json& parameter : result.at("artefact_parameters")) {
    if (!parameter.at("name").get<std::string>().starts_with("plane6_axis_")) continue;
    ++of_axis;
    EXPECT_EQ(parameter.at("unit"), "mm");
    EXPECT_EQ(parameter.at("status"), "identified");
    EXPECT_NEAR(parameter.at("value").get<double>(), parameter.at("nominal").get<double>(), 0.05);
  }
  EXPECT_EQ(of_axis, 2);
  const Finished refused = identify(one_side);
  EXPECT_EQ(refused.exit_code, cell::kExitRefused) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("touches.json"));
  EXPECT_THAT(refused.err, HasSubstr("on plane 6, a bore, are on one side of it only"));
  EXPECT_THAT(refused.err, HasSubstr("/faces/5/place"));
}

}  // namespace
}  // namespace touchcal::testing
