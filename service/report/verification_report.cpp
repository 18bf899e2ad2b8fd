#include "service/report/verification_report.hpp"

#include <spdlog/fmt/fmt.h>

#include "cs8_protocol/names.hpp"
#include "service/base/digest.hpp"
#include "service/documents/document_error.hpp"
#include "service/report/internal/report_data.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

VerificationReport::Calibration calibration_of(const VerificationRecord& record) {
  VerificationReport::Calibration told;
  if (record.own.run.of_run) told.id = std::to_string(*record.own.run.of_run);
  if (!record.calibration) return told;
  told.recipe = record.calibration->recipe;
  told.started_at = record.calibration->started_at;
  told.ended_at = record.calibration->ended_at;
  told.verdict = record.calibration->verdict;
  told.raw_data_sha256 = sha256_hex(raw_data_text(record.calibration_touches));
  return told;
}

}  // namespace

FoundVerification read_verification(std::string_view result) {
  FoundVerification found;
  try {
    const std::string schema = schema_of(result);
    if (schema == ProofDocument().schema) {
      found.proof = read_proof(result);
    } else if (schema == CheckDocument().schema) {
      found.check = read_check(result);
    } else if (schema == QualificationDocument().schema) {
      found.qualification = read_qualification(result);
    } else if (schema == ToolDocument().schema) {
      found.tool = read_tool(result);
    } else {
      found.unreadable =
          fmt::format("'{}' is no schema of a proof, a check, a qualification or a tool", schema);
    }
  } catch (const DocumentError& error) {
    found.unreadable = error.what();
  }
  return found;
}

std::map<int, std::optional<double>> deviations_of(const FoundVerification& found) {
  std::map<int, std::optional<double>> deviations;
  if (found.proof) {
    for (const ProofDocument::TouchDistance& touch : found.proof->touches)
      deviations[touch.touch] = touch.distance_mm;
  }
  if (found.check) {
    for (const CheckDocument::TouchChange& touch : found.check->touches)
      deviations[touch.touch] = touch.change_mm;
  }
  if (found.tool) {
    for (const ProofDocument::TouchDistance& touch : found.tool->touches)
      deviations[touch.touch] = touch.distance_mm;
  }
  if (found.qualification) {
    for (const QualificationDocument::TouchDeviation& touch : found.qualification->touches)
      deviations[touch.touch] = touch.deviation_mm;
  }
  return deviations;
}

std::string verification_report_document(const VerificationRecord& record) {
  const RunRecord& own = record.own;
  VerificationReport report{head_of(own)};
  report.kind = run_kind_name(own.run.kind);
  report.cell = record.cell;
  report.calibration = calibration_of(record);
  const auto deviations =
      deviations_of(own.result_json ? read_verification(*own.result_json) : FoundVerification());
  for (const StoredTouch& stored : own.touches) {
    VerificationReport::Touch& touch = report.touches.emplace_back();
    touch.touch = static_cast<int>(report.touches.size());
    touch.plane = stored.plane;
    touch.role = stored.role;
    touch.joints_deg = degrees_texts(stored.joints);
    touch.source = cs8::name(stored.source);
    touch.captured_at = stored.captured_at;
    if (const auto known = deviations.find(touch.touch); known != deviations.end())
      touch.deviation_mm = known->second;
  }
  if (own.run.conditions_json) report.conditions.emplace().text = *own.run.conditions_json;
  if (own.result_json) report.result = CarriedJson{*own.result_json};
  report.checks = record.checks;
  return document_text(report);
}

std::string verification_report_csv(const VerificationReport& report) {
  std::string lines =
      "touch,plane,role,joint1_deg,joint2_deg,joint3_deg,joint4_deg,joint5_deg,joint6_deg,deviation_mm,"
      "captured_at\n";
  for (const VerificationReport::Touch& touch : report.touches) {
    lines += fmt::format("{},{},{}", touch.touch, touch.plane, word_of(touch.role));
    for (const std::string& joint : touch.joints_deg) lines += "," + joint;
    lines += fmt::format(",{},{}\n", touch.deviation_mm ? fmt::format("{:.6f}", *touch.deviation_mm) : "",
                         touch.captured_at);
  }
  return lines;
}

}  // namespace cell
