#pragma once

#include <string>

#include "service/documents/qualification_document.hpp"
#include "service/documents/tool_document.hpp"
#include "service/documents/verification_document.hpp"
#include "service/report/verification_report.hpp"

/// Records of proofs and checks of calibration 7 as the store has them.
namespace cell {

inline const std::string kVerifiedConditions =
    R"({"arm_serial":"F09-1","block":{"name":"cube","serial":"B-3","certificate":{"laboratory":"LNE"}},)"
    R"("probe":{"name":"lp2","serial":null,"certificate":null},"touching":"automatic"})";

inline VerificationRecord verified_run(RunKind kind, const std::string& result) {
  VerificationRecord record{.own = {.run = {.id = 9,
                                            .kind = kind,
                                            .of_run = 7,
                                            .recipe = "quick",
                                            .touches_total = 3,
                                            .touches_done = 3,
                                            .started_at = "2026-02-03T08:15:30.250Z",
                                            .ended_at = "2026-02-03T08:17:30.250Z",
                                            .outcome = RunOutcome::kComplete,
                                            .operator_name = "M. Curie",
                                            .conditions_json = kVerifiedConditions},
                                    .result_json = result},
                            .cell = "hall 3",
                            .calibration = StoredRun{.id = 7,
                                                     .recipe = "best",
                                                     .started_at = "2026-01-31T08:15:30.250Z",
                                                     .ended_at = "2026-01-31T08:25:30.250Z",
                                                     .outcome = RunOutcome::kComplete,
                                                     .verdict = Verdict::kAccepted},
                            .calibration_touches = {{.number = 1, .plane = 2, .joints = {1, 2, 3, 4, 5, 6}}}};
  for (int number = 1; number <= 3; ++number)
    record.own.touches.push_back({.number = number,
                                  .plane = number == 3 ? 4 : 2,
                                  .role = calib::TouchRole::kProof,
                                  .joints = {1'500'000, 0, 0, 90'000'000, -179'999'999, -number},
                                  .captured_at = "2026-02-03T08:16:00.000Z"});
  return record;
}

inline ProofDocument made_proof() {
  ProofDocument proof{.arm = "tx90", .of_run = "7", .touch_count = 3, .complete = true};
  proof.verdict = {.accepted = true, .reasons = {}};
  proof.rms_mm = 0.0125;
  proof.rms_max_mm = 0.03;
  proof.chi_square = 5.25;
  proof.degrees_of_freedom = 6.0;
  proof.p = 0.512;
  proof.p_min = 0.01;
  proof.noise_um = 17.5;
  proof.moved_mm = {0.0, -300.0, 0.5};
  proof.turned_deg = {0.0, 0.25, 0.0};
  proof.power = {{.alternative = "droop", .power = 0.97}, {.alternative = "oval gears", .power = {}}};
  proof.touches = {{.touch = 1, .plane = 2, .distance_mm = 0.0125},
                   {.touch = 2, .plane = 2, .distance_mm = -0.02},
                   {.touch = 3, .plane = 4, .distance_mm = 0.005}};
  return proof;
}

inline CheckDocument made_check() {
  CheckDocument check{.arm = "tx90", .of_run = "7", .touch_count = 3, .complete = true};
  check.verdict = {.accepted = false, .reasons = {"joint 4 has changed by 0.200 mrad since the reference"}};
  check.reference = {.count = 3, .needed = 3};
  check.chi_square = 55.5;
  check.degrees_of_freedom = 11.0;
  check.p = 0.00012;
  check.joint_p = 0.25;
  check.p_min = 0.005;
  check.rms_mm = 0.04;
  check.noise_um = 17.5;
  check.cause = "joint";
  check.joint = 4;
  check.joints = {{.joint = 2, .offset_mrad = -0.004, .std_offset_mrad = 0.015},
                  {.joint = 4, .offset_mrad = 0.2, .std_offset_mrad = 0.031}};
  check.growth_ppm = 23.6;
  check.std_growth_ppm = 4.5;
  check.warmer_k = 1.0;
  check.touches = {{.touch = 1, .plane = 2, .change_mm = 0.05},
                   {.touch = 2, .plane = 2, .change_mm = -0.03},
                   {.touch = 3, .plane = 4, .change_mm = 0.01}};
  return check;
}

inline QualificationDocument made_qualification() {
  QualificationDocument made{
      .arm = "tx90", .probe = "lp2", .of_run = "7", .touch_count = 3, .complete = true};
  made.verdict = {.accepted = false, .reasons = {"the ball runs out by more than is allowed"}};
  made.scatter = {.std_um = 12.5, .degrees_of_freedom = 9.0, .low_um = 8.6, .high_um = 22.8};
  made.run_out = {.size_mm = 0.6, .std_mm = 0.0125, .direction_deg = 30.0};
  made.lengths = {{.planes = {3, 5}, .known_mm = 150.0, .error_mm = -0.0125, .std_mm = 0.02, .p = 0.625}};
  made.criteria = {
      {.name = "run_out", .unit = "mm", .value = 0.6, .limit = 0.5, .expanded = 0.025, .passed = false},
      {.name = "turns", .unit = "p", .value = 0.25, .limit = 0.001, .passed = true},
      {.name = "length_3_5", .unit = "mm", .value = 0.0125, .expanded = 0.04, .passed = true}};
  made.touches = {{.touch = 1, .plane = 2, .joint_6_deg = 0.0, .deviation_mm = 0.0125},
                  {.touch = 2, .plane = 2, .joint_6_deg = 45.0, .deviation_mm = -0.02},
                  {.touch = 3, .plane = 4, .joint_6_deg = 0.0, .deviation_mm = {}}};
  return made;
}

inline VerificationRecord proof_record(const ProofDocument& proof = made_proof()) {
  return verified_run(RunKind::kProof, document_text(proof));
}
inline VerificationRecord check_record(const CheckDocument& check = made_check()) {
  return verified_run(RunKind::kCheck, document_text(check));
}
inline ToolDocument made_tool() {
  ToolDocument made{.arm = "tx90", .tool = "gripper", .of_run = "7", .touch_count = 3, .complete = true};
  made.verdict = {.accepted = false, .reasons = {"the touches contradict each other"}};
  made.drawn_mm = {0.0, 0.0, 250.0};
  made.position_mm = {0.125, -0.25, 250.5};
  made.std_position_mm = {0.01, 0.02, 0.03};
  made.off_drawing_mm = 0.5728;
  made.box_rms_mm = 0.0625;
  made.rms_mm = 0.015;
  made.p = 0.0025;
  made.p_min = 0.01;
  made.touches = {{.touch = 1, .plane = 2, .distance_mm = 0.0125}};
  return made;
}

inline VerificationRecord qualification_record(const QualificationDocument& made = made_qualification()) {
  return verified_run(RunKind::kQualification, document_text(made));
}

/// Fourteen checks, of which the first three are the reference; limits from the last one on.
inline ChecksDocument charted_checks() {
  ChecksDocument checks;
  checks.of_run = "7";
  checks.count = 14;
  checks.reference = {.count = 3, .needed = 3};
  checks.base = {.count = 10, .needed = 10};
  ChecksDocument::Chart joint{.quantity = "joint_4", .unit = "mrad", .centre = 0.01, .points = {}};
  for (int run = 8; run < 22; ++run) {
    checks.checks.push_back({.run = std::to_string(run)});
    if (run > 10) joint.points.push_back({.run = std::to_string(run), .value = 0.02});
  }
  joint.points.back().shewhart_limit = 0.05;
  joint.points.back().weighted_mean = 0.015;
  checks.charts = {
      joint, {.quantity = "growth", .unit = "ppm", .centre = {}, .points = {{.run = "21", .value = 3.0}}}};
  return checks;
}

}  // namespace cell
