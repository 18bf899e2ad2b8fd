#include "service/documents/verification_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/internal/qualification_view.hpp"
#include "service/documents/internal/tool_view.hpp"
#include "service/documents/internal/verdict_word.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

constexpr double kPerMillion = 1e-6;
constexpr double kMilliradians = 1e3;

std::array<double, 3> listed(const Eigen::Vector3d& values) { return {values.x(), values.y(), values.z()}; }

std::optional<CarriedJson> carried(const std::string& conditions) {
  return conditions.empty() ? std::nullopt : std::optional(CarriedJson{conditions});
}

/// What the head of both documents says.
template <class Document>
Document headed(const TipRegions& regions, const Run& run, const VerificationContext& context) {
  Document document;
  document.arm = regions.cell().arm.name;
  document.of_run = std::to_string(run.verification()->of_run.value());
  document.touch_count = run.touches_done();
  document.complete = context.complete;
  document.conditions = carried(context.conditions);
  return document;
}

void tell_power(const TipRegions& regions, const Verification& verification,
                const std::vector<calib::Touch>& touches, ProofDocument& document) {
  const auto alternatives = calib::proof_alternatives(*verification.record, regions.tip().workspace_box);
  for (const calib::ProofPower& power : calib::proof_power(
           *verification.record, alternatives, verification.place, touches, verification.proof_limits))
    document.power.push_back({.alternative = power.name, .power = finite(power.power)});
}

void tell_proof(const calib::ProofVerdict& verdict, const std::vector<calib::Touch>& touches,
                ProofDocument& document) {
  document.verdict = {.accepted = verdict.passed, .reasons = verdict.reasons};
  document.rms_mm = finite(mm_from_metres(verdict.rms_m));
  document.chi_square = finite(verdict.chi_square);
  document.degrees_of_freedom = finite(verdict.degrees_of_freedom);
  document.p = finite(verdict.p);
  const Eigen::AngleAxisd turn(verdict.calibrated_from_block.linear());
  document.moved_mm = listed(verdict.calibrated_from_block.translation() * mm_from_metres(1.0));
  document.turned_deg = listed(calib::degrees_from_radians(turn.angle()) * turn.axis());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    document.touches.push_back(
        {.touch = static_cast<int>(i) + 1,
         .plane = touches[i].face + 1,
         .distance_mm = finite(mm_from_metres(verdict.distances_m[static_cast<Eigen::Index>(i)]))});
  }
}

VerificationResult proof_result(const TipRegions& regions, const Run& run,
                                const VerificationContext& context) {
  const Verification& verification = *run.verification();
  auto document = headed<ProofDocument>(regions, run, context);
  document.rms_max_mm = finite(mm_from_metres(verification.proof_limits.rms_max_m));
  document.p_min = finite(verification.proof_limits.p_min);
  document.noise_um = finite(calib::um_from_metres(verification.record->noise().std_m));
  const std::vector<calib::Touch> touches = verifying_touches(run.touches());
  const auto outcome =
      calib::prove(*verification.record, verification.place, touches, verification.proof_limits);
  if (const auto* refusal = std::get_if<calib::ProofRefusal>(&outcome)) {
    document.verdict.reasons = {refusal->message};
  } else {
    tell_proof(std::get<calib::ProofVerdict>(outcome), touches, document);
    tell_power(regions, verification, touches, document);
  }
  return {document_text(document), verdict_of(document.verdict)};
}

std::string cause_name(calib::CheckCause cause) {
  switch (cause) {
    case calib::CheckCause::kJoint:
      return "joint";
    case calib::CheckCause::kBlock:
      return "block";
    case calib::CheckCause::kStylus:
      return "stylus";
    case calib::CheckCause::kNone:
    case calib::CheckCause::kUnknown:
      break;
  }
  return "unknown";
}

std::string alarm_words(const calib::CheckVerdict& verdict) {
  switch (verdict.cause) {
    case calib::CheckCause::kJoint: {
      const auto joint = std::ranges::find(verdict.joints, verdict.joint, &calib::CheckedJoint::joint);
      return fmt::format(
          "joint {} has changed by {:.3f} mrad since the reference: look for a collision, a slipped coupling "
          "or a lost zero of that joint; mend it, or calibrate anew",
          verdict.joint, kMilliradians * joint->offset_rad);
    }
    case calib::CheckCause::kBlock:
      return "the block has moved since the reference: fasten it, find it with touchcal locate and calibrate "
             "anew; of the arm this check says nothing";
    case calib::CheckCause::kStylus:
      return "the stylus has bent or was changed since the reference: qualify or replace it, and check again";
    case calib::CheckCause::kNone:
    case calib::CheckCause::kUnknown:
      break;
  }
  return "the cell has changed since the reference, and no single joint, the block or the stylus explains "
         "it: "
         "check again; if it stays, calibrate anew";
}

void tell_check(const calib::CheckVerdict& verdict, const std::vector<calib::Touch>& touches,
                const Cell& cell, CheckDocument& document) {
  document.verdict.accepted = !verdict.alarm;
  if (verdict.alarm) {
    document.verdict.reasons = {alarm_words(verdict)};
    document.cause = cause_name(verdict.cause);
    if (verdict.cause == calib::CheckCause::kJoint) document.joint = verdict.joint;
  }
  document.chi_square = finite(verdict.chi_square);
  document.degrees_of_freedom = finite(verdict.degrees_of_freedom);
  document.p = finite(verdict.p);
  document.joint_p = finite(verdict.joint_p);
  document.rms_mm = finite(mm_from_metres(verdict.rms_m));
  for (const calib::CheckedJoint& joint : verdict.joints)
    document.joints.push_back({.joint = joint.joint,
                               .offset_mrad = finite(kMilliradians * joint.offset_rad),
                               .std_offset_mrad = finite(kMilliradians * joint.std_rad)});
  document.growth_ppm = finite(verdict.growth / kPerMillion);
  document.std_growth_ppm = finite(verdict.std_growth / kPerMillion);
  if (cell.arm.growth) document.warmer_k = finite(verdict.warmer_k(cell.arm.growth->expansion_per_k));
  for (std::size_t i = 0; i < touches.size(); ++i) {
    document.touches.push_back(
        {.touch = static_cast<int>(i) + 1,
         .plane = touches[i].face + 1,
         .change_mm = finite(mm_from_metres(verdict.changes_m[static_cast<Eigen::Index>(i)]))});
  }
}

/// Of a check that was made while the reference was not whole, and is the newest of `candidates`.
Verdict tell_reference(const Verification& verification, const calib::KinematicModel& arm,
                       const std::vector<ReferenceCandidate>& candidates, CheckDocument& document) {
  const auto chosen = reference_among(arm, candidates);
  document.reference.count = static_cast<int>(std::ssize(chosen));
  if (chosen.empty() || chosen.back() + 1 != candidates.size()) {
    document.verdict.reasons = {fmt::format("{} touches: a check has {}; make those of its plan",
                                            candidates.back().time.touches.size(), calib::kCheckTouchCount)};
    return Verdict::kIncomplete;
  }
  std::vector<calib::ReferenceTime> times;
  for (const std::size_t i : chosen) times.push_back(candidates[i].time);
  if (const auto refusal = calib::why_no_reference(*verification.record, times)) {
    document.verdict.reasons = {refusal->message};
    return Verdict::kIncomplete;
  }
  const bool begins_anew = times.size() == 1 && candidates.size() > 1;
  document.verdict.reasons = {
      begins_anew ? "this check did not make the touches of the reference checks before it, so that one of "
                    "them is of another place or plan: check again; the reference goes on with whichever "
                    "two agree"
                  : fmt::format("reference check {} of {}: the checks after them are held against their mean",
                                document.reference.count, document.reference.needed)};
  const auto reference = calib::make_reference(*verification.record, times);
  if (const auto* whole = std::get_if<calib::CheckReference>(&reference))
    document.noise_um = finite(calib::um_from_metres(whole->noise.std_m));
  return Verdict::kNone;
}

VerificationResult check_result(const TipRegions& regions, const Run& run,
                                const VerificationContext& context) {
  const Verification& verification = *run.verification();
  const calib::KinematicModel& arm = regions.cell().arm.model;
  auto document = headed<CheckDocument>(regions, run, context);
  if (const auto every = regions.cell().check_every) document.every_days = static_cast<int>(every->count());
  const bool is_whole = !verification.references.empty();
  std::vector<ReferenceCandidate> candidates = verification.candidates;
  document.reference = {
      .count = is_whole ? calib::kReferenceCount : static_cast<int>(reference_among(arm, candidates).size()),
      .needed = calib::kReferenceCount};
  document.p_min = finite(calib::kCheckAlarmP);
  std::vector<calib::Touch> touches = verifying_touches(run.touches());
  if (!context.complete) {
    document.verdict.reasons = {"the check is not complete: it is judged by all of its touches"};
    return {document_text(document), Verdict::kIncomplete};
  }
  if (!is_whole) {
    candidates.push_back({run.id(), {std::move(touches)}});
    const Verdict verdict = tell_reference(verification, arm, candidates, document);
    return {document_text(document), verdict};
  }
  const auto reference = calib::make_reference(*verification.record, verification.references);
  const auto* refused = std::get_if<calib::CheckRefusal>(&reference);
  const auto checked =
      refused ? std::variant<calib::CheckVerdict, calib::CheckRefusal>(*refused)
              : calib::check(*verification.record, std::get<calib::CheckReference>(reference), touches);
  if (const auto* refusal = std::get_if<calib::CheckRefusal>(&checked)) {
    document.verdict.reasons = {refusal->message};
  } else {
    document.noise_um = finite(calib::um_from_metres(std::get<calib::CheckReference>(reference).noise.std_m));
    tell_check(std::get<calib::CheckVerdict>(checked), touches, regions.cell(), document);
  }
  return {document_text(document), verdict_of(document.verdict)};
}

}  // namespace

VerificationResult verification_result(const TipRegions& regions, const Run& run,
                                       const VerificationContext& context) {
  switch (run.kind()) {
    case RunKind::kQualification:
      return qualification_result(regions.cell(), run, context);
    case RunKind::kTool:
      return tool_result(regions, run, context);
    case RunKind::kProof:
      return proof_result(regions, run, context);
    case RunKind::kCheck:
    case RunKind::kCalibration:
      break;
  }
  return check_result(regions, run, context);
}

}  // namespace cell
