#include "config/truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using calib::metres_from_mm;
using nlohmann::json;
using testing::HasSubstr;

using TruthFile = CopiedConfig;

TEST_F(TruthFile, OfVersion1HidesErrorsOnly) {
  const Truth truth = read_truth(path(kTruth));
  EXPECT_GT(truth.errors.norm(), 0.0);
  EXPECT_EQ(true_model(truth, read().arm).compliance_rad_per_nm, read().arm.model.compliance_rad_per_nm);
  const Block block = read().block;
  const auto solids = true_solids(truth, block);
  ASSERT_EQ(solids.size(), block.solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    EXPECT_EQ(solids[i].min_m, block.solids[i].min_m);
    EXPECT_EQ(solids[i].max_m, block.solids[i].max_m);
  }
  for (const Ripple& ripple : truth.ripple) EXPECT_EQ(ripple.amplitude_rad, 0.0);
  EXPECT_TRUE(truth.backlash_rad.isZero(0.0));
  EXPECT_TRUE(truth.repeatability_rad.isZero(0.0));
  EXPECT_EQ(truth.encoder_step_rad, 0.0);
  EXPECT_EQ(truth.warming.arm_rise_k, 0.0);
  EXPECT_FALSE(truth.probe.noise_m || truth.probe.stylus_radius_m || truth.probe.pretravel_m);
}

TEST_F(TruthFile, CalledRealHasEveryEffect) {
  const Truth truth = read_truth(path(kRealTruth));
  const json file = json_of(path(kRealTruth));
  EXPECT_EQ(truth.droop.value().compliance_rad_per_nm[2],
            file["/droop/compliance_rad_per_nm/1"_json_pointer]);
  for (const Ripple& ripple : truth.ripple) EXPECT_GT(ripple.amplitude_rad * ripple.periods_per_turn, 0.0);
  EXPECT_DOUBLE_EQ(truth.ripple[1].phase_rad,
                   calib::radians_from_degrees(file["/ripple/joints/1/phase_deg"_json_pointer]));
  EXPECT_GT(truth.backlash_rad.minCoeff(), 0.0);
  EXPECT_GT(truth.repeatability_rad.minCoeff(), 0.0);
  EXPECT_GT(truth.warming.arm_expansion_per_k * truth.warming.arm_rise_k, 0.0);
  EXPECT_NE(truth.warming.block_warmer_k, 0.0);
  EXPECT_EQ(truth.face_offsets_m.size(), read().block.faces.size());
  EXPECT_DOUBLE_EQ(truth.face_offsets_m[3], metres_from_mm(file["/block/offsets_mm/3"_json_pointer]));
  EXPECT_TRUE(truth.probe.stylus_radius_m && truth.probe.pretravel_m && truth.probe.noise_m);
  EXPECT_NE(truth.probe.pretravel_tilt_m, 0.0);
  EXPECT_NE(truth.probe.lobes_m, 0.0);
  EXPECT_DOUBLE_EQ(truth.encoder_step_rad, calib::radians_from_degrees(1e-4));
}

/// What one effect adds to a truth without any: its numbers, one after the other.
std::vector<double> numbers_of(const Truth& truth) {
  std::vector<double> numbers = truth.face_offsets_m;
  for (const Ripple& ripple : truth.ripple) numbers.push_back(ripple.amplitude_rad);
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    numbers.push_back(truth.backlash_rad[joint]);
    numbers.push_back(truth.repeatability_rad[joint]);
  }
  for (const double number :
       {truth.droop.value_or(Droop{}).compliance_rad_per_nm[1], truth.warming.arm_rise_k, truth.probe.lobes_m,
        truth.probe.noise_m.value_or(0.0), truth.encoder_step_rad})
    numbers.push_back(number);
  return numbers;
}

TEST_F(TruthFile, SwitchesEachEffectOnAndOff) {
  json bare = json_of(path(kRealTruth));
  for (const char* name :
       {"droop", "ripple", "backlash", "thermal", "block", "probe", "repeatability", "encoder"})
    bare.erase(name);
  const auto none = numbers_of(read_truth(folder_.write("bare.json", bare.dump())));
  const json whole = json_of(path(kRealTruth));
  for (const auto& [name, effect] : whole.items()) {
    if (!effect.is_object() || name == "errors") continue;
    json document = bare;
    document[name] = effect;
    document[name].erase("on");
    EXPECT_NE(numbers_of(read_truth(folder_.write("one.json", document.dump()))), none) << name;
    document[name]["on"] = false;
    EXPECT_EQ(numbers_of(read_truth(folder_.write("one.json", document.dump()))), none) << name;
    document[name]["on"] = true;
    EXPECT_NE(numbers_of(read_truth(folder_.write("one.json", document.dump()))), none) << name;
  }
}

TEST_F(TruthFile, MovesTheSidesThatTheFacesLieOn) {
  Truth truth;
  truth.face_offsets_m = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3};
  const Block block = read().block;
  const auto solids = true_solids(truth, block);
  EXPECT_EQ(solids[0].name, "block");
  // Outwards of planes 1 to 4: -z, -x, -y, +z of the block; of plane 5: -y of the plate.
  EXPECT_TRUE((solids[0].min_m - block.solids[0].min_m).isApprox(Eigen::Vector3d(-2e-3, -3e-3, -1e-3)));
  EXPECT_TRUE((solids[0].max_m - block.solids[0].max_m).isApprox(Eigen::Vector3d(0.0, 0.0, 4e-3)));
  EXPECT_TRUE((solids[1].min_m - block.solids[1].min_m).isApprox(Eigen::Vector3d(0.0, -5e-3, 0.0)));
  EXPECT_TRUE((solids[1].max_m - block.solids[1].max_m).isZero());
}

TEST_F(TruthFile, ABlockStandsAsWarmAsItsFileSaysAndTheTruthAdds) {
  Block block = read().block;
  block.temperature_c = 23.0;
  Truth truth;
  truth.warming.block_warmer_k = 2.0;
  const auto solids = true_solids(truth, block);
  EXPECT_NEAR(solids[0].min_m.y(), -0.15 * (1.0 + 5.0 * block.thermal_expansion_per_k.value()), 1e-12);
}

TEST_F(TruthFile, ThatDoesNotFitTheCellIsRefusedWithItsPlace) {
  edit(kRealTruth, [](json& document) { document["block"]["offsets_mm"].erase(4); });
  const Truth short_one = read_truth(path(kRealTruth));
  const ConfigError count = error_of([&] { static_cast<void>(true_solids(short_one, read().block)); });
  EXPECT_EQ(count.pointer(), "/block/offsets_mm");
  EXPECT_THAT(count.message(), HasSubstr("5 planes"));
  EXPECT_EQ(count.source(), path(kRealTruth).string());

  Truth all = short_one;
  all.face_offsets_m.assign(5, 1e-5);
  Block block = read().block;
  block.solids.erase(block.solids.begin());
  const ConfigError side = error_of([&] { static_cast<void>(true_solids(all, block)); });
  EXPECT_EQ(side.pointer(), "/block/offsets_mm/0");

  Arm arm = read().arm;
  arm.model.masses = {};
  const ConfigError masses = error_of([&] { static_cast<void>(true_model(all, arm)); });
  EXPECT_EQ(masses.pointer(), "/droop");
  EXPECT_THAT(masses.message(), HasSubstr("no masses"));
}

}  // namespace
}  // namespace cell
