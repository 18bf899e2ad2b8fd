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

/// The end of a straight line from "start".
PathTarget line_end(calib::LineCorrection line, CompensationStatus status = CompensationStatus::kRefused) {
  PathTarget end{.name = "end", .result = {.status = status}, .line_from = "start"};
  if (status != CompensationStatus::kRefused) end.result.joints = calib::JointVector::Zero();
  end.line = std::move(line);
  return end;
}
std::string line_reason_of(const PathTarget& end) {
  return compensation_of(edf(), {end}, "").targets.at(0).reason.value_or("none");
}

TEST(CompensationView, OfVersion2SaysWhatALineLeaves) {
  PathTarget point{.name = "end.1", .result = {.status = CompensationStatus::kOk}, .is_inserted = true};
  const json document = json::parse(document_text(
      compensation_of(edf(), {point, line_end({.deviation_m = 12e-6}, CompensationStatus::kOk)}, "abc")));
  EXPECT_EQ(document.at("schema"), "touchcal/compensated/2");
  EXPECT_EQ(document.at("targets").at(0).at("inserted"), true);
  EXPECT_TRUE(document.at("targets").at(0).at("line_deviation_mm").is_null());
  EXPECT_EQ(document.at("targets").at(1).at("inserted"), false);
  EXPECT_NEAR(document.at("targets").at(1).at("line_deviation_mm").get<double>(), 0.012, 1e-12);
  EXPECT_TRUE(document.at("targets").at(1).at("reason").is_null());
}

TEST(CompensationView, SaysWhyAStraightLineCannotBeHeldAndWhatToDo) {
  using calib::LineReason;
  const auto part_of = [](calib::LineCorrection line) { return line_reason_of(line_end(std::move(line))); };
  EXPECT_EQ(part_of({.reason = LineReason::kOtherConfiguration}),
            "the straight line from start cannot be held: the configuration of shoulder, elbow or wrist "
            "changes on it; reach the target by a joint move, or split the line by a target between");
  EXPECT_THAT(part_of({.reason = LineReason::kHalfTurn, .angle_rad = calib::radians_from_degrees(179.5)}),
              HasSubstr("turns by 179.5 deg on it"));
  EXPECT_THAT(part_of({.reason = LineReason::kOtherTurns, .joint = 6, .angle_rad = 0.0}),
              HasSubstr("leads joint 6 to 0.000000 deg"));
  EXPECT_THAT(part_of({.reason = LineReason::kJointTurnsFar,
                       .share = 0.25,
                       .joint = 4,
                       .angle_rad = calib::radians_from_degrees(170)}),
              HasSubstr("at 25 % of the way joint 4 turns by 170 deg at once"));
  EXPECT_THAT(part_of({.reason = LineReason::kPosture,
                       .share = 0.5,
                       .point = refused_for(CompensationReason::kStraightWrist, 0, 1.5)}),
              HasSubstr("at 50 % of the way the wrist is within 1.5 deg of straight"));
  EXPECT_THAT(part_of({.reason = LineReason::kPoint,
                       .share = 0.5,
                       .point = refused_for(CompensationReason::kOutOfReach)}),
              HasSubstr("at 50 % of the way out of reach of the calibrated arm"));
  EXPECT_THAT(part_of({.reason = LineReason::kStaysOff, .share = 0.5, .deviation_m = 4e-6}),
              HasSubstr("the tool stays 0.0040 mm off, however many points there are"));
}

TEST(CompensationView, SaysOfALineThatItIsNotJudged) {
  PathTarget end = line_end({}, CompensationStatus::kWarned);
  end.line.reset();
  EXPECT_EQ(line_reason_of(end), "the straight line from start is not judged, since its start is refused");
  end.result.reason = CompensationReason::kStraightWrist;
  EXPECT_THAT(line_reason_of(end), HasSubstr("turns joints far; the straight line from start is not judged"));
  end.result = refused_for(CompensationReason::kOutOfReach);
  EXPECT_EQ(line_reason_of(end), "out of reach of the calibrated arm");
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
