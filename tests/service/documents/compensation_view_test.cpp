#include "service/documents/compensation_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using calib::CompensationReason;
using calib::CompensationStatus;
using nlohmann::json;
using ::testing::HasSubstr;

calib::CompensatedTarget refused_for(CompensationReason reason, int joint = 0, double angle_deg = 0.0) {
  return {.reason = reason, .joint = joint, .angle_rad = calib::radians_from_degrees(angle_deg)};
}

std::string reason_of(const calib::CompensatedTarget& result) {
  const auto document = compensation_of(edf(), {Target{.name = "p"}}, {result}, "");
  return document.targets.at(0).reason.value_or("none");
}

TEST(CompensationView, IsTheDocumentOfTheContractInItsUnits) {
  const calib::JointVector joints = calib::kRadiansPerDegree * calib::JointVector::LinSpaced(1.0, 6.0);
  const std::vector<Target> targets{Target{.name = "p1"}, Target{.name = "p2"}};
  const std::vector<calib::CompensatedTarget> results{{.status = CompensationStatus::kOk,
                                                       .joints = joints,
                                                       .moved_m = 1.8e-3,
                                                       .residual_m = 0.02e-6,
                                                       .tip_std_m = 0.03e-3},
                                                      refused_for(CompensationReason::kNominalOutOfReach)};
  const json document = json::parse(document_text(compensation_of(edf(), targets, results, "abc")));
  EXPECT_EQ(document.at("schema"), "touchcal/compensated/1");
  EXPECT_EQ(document.at("model"), "abc");
  const json& ok = document.at("targets").at(0);
  EXPECT_EQ(ok.at("name"), "p1");
  EXPECT_EQ(ok.at("status"), "ok");
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(ok.at("joints_deg").at(i).get<double>(), 1.0 + static_cast<double>(i), 1e-12);
  EXPECT_NEAR(ok.at("moved_mm").get<double>(), 1.8, 1e-12);
  EXPECT_NEAR(ok.at("residual_um").get<double>(), 0.02, 1e-12);
  EXPECT_NEAR(ok.at("tip_uncertainty_mm").get<double>(), 0.03, 1e-12);
  EXPECT_TRUE(ok.at("reason").is_null());
  const json& refused = document.at("targets").at(1);
  EXPECT_EQ(refused.at("status"), "refused");
  for (const char* key : {"joints_deg", "moved_mm", "residual_um", "tip_uncertainty_mm"})
    EXPECT_TRUE(refused.at(key).is_null()) << key;
  EXPECT_THAT(refused.at("reason").get<std::string>(), HasSubstr("out of reach"));
}

TEST(CompensationView, SaysWhyATargetIsRefusedOrWarnedOf) {
  EXPECT_EQ(reason_of({.status = CompensationStatus::kOk}), "none");
  EXPECT_EQ(
      reason_of(refused_for(CompensationReason::kStraightWrist, 0, 1.25)),
      "the wrist is within 1.25 deg of straight: under 2 deg a correction turns joints far; choose another "
      "posture");
  calib::CompensatedTarget warned = refused_for(CompensationReason::kStretchedElbow, 0, 7.5);
  warned.status = CompensationStatus::kWarned;
  EXPECT_EQ(reason_of(warned),
            "the elbow is within 7.5 deg of stretched: under 8 deg a correction turns joints far");
  EXPECT_EQ(reason_of(refused_for(CompensationReason::kOutOfRange, 5, 140.25)),
            "the correction would have joint 5 at 140.250000 deg, outside its range of -115 to 140 deg");
  EXPECT_EQ(reason_of(refused_for(CompensationReason::kNominalOutOfRange, 3, -145.5)),
            "the target itself has joint 3 at -145.500000 deg, outside its range of -145 to 145 deg");
  EXPECT_THAT(reason_of(refused_for(CompensationReason::kOutOfReach)), HasSubstr("of the calibrated arm"));
  EXPECT_THAT(reason_of(refused_for(CompensationReason::kOtherConfiguration)), HasSubstr("configuration"));
}

TEST(CompensationView, TheDigestHangsOnEveryFigureOfTheArmAndNotOnItsLayout) {
  const std::string arm = bytes_of(kSourceDir / "config/arms/tx90.json");
  const std::string digest = arm_digest("arm.json", arm);
  EXPECT_EQ(digest.size(), 64U);
  EXPECT_EQ(arm_digest("arm.json", json::parse(arm).dump(7)), digest);
  json other = json::parse(arm);
  other["frames"][3]["d_mm"] = 425.0001;
  EXPECT_NE(arm_digest("arm.json", other.dump()), digest);
  EXPECT_EQ(error_of([] { arm_digest("arm.json", "{"); }).source(), "arm.json");
}

}  // namespace
}  // namespace cell
