#include "service/report/report_document.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>

#include "cs8_protocol/names.hpp"
#include "service/base/digest.hpp"
#include "service/base/version.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/json_view.hpp"

namespace cell {
namespace {

/// An integer of 10^-6 degrees as degrees, without rounding.
std::string degrees_text(std::int64_t microdegrees) {
  constexpr std::int64_t kPerDegree = 1'000'000;
  const std::int64_t size = std::abs(microdegrees);
  return fmt::format("{}{}.{:06}", microdegrees < 0 ? "-" : "", size / kPerDegree, size % kPerDegree);
}

RunReport::OfRun of_run(const StoredRun& run) {
  return {
      .id = std::to_string(run.id),
      .recipe = run.recipe,
      .operator_name = run.operator_name,
      .started_at = run.started_at,
      .ended_at = run.ended_at,
      .outcome = run.outcome,
      .verdict = run.verdict,
      .touches_done = run.touches_done,
      .touches_total = run.touches_total > 0 ? std::optional(run.touches_total) : std::nullopt,
      .fault_code = run.fault_code,
      .fault_message = run.fault_message,
      .plan_id = run.plan_id,
      .config_digest = run.config_digest,
      .block_temperature_c = run.block_temperature ? finite(run.block_temperature->celsius) : std::nullopt};
}

/// Each touch with the entry of the result at the same index, if there is one.
std::vector<RunReport::Touch> touches_of(const RunRecord& record, const ResultDocument& result) {
  std::vector<RunReport::Touch> list;
  for (std::size_t i = 0; i < record.touches.size(); ++i) {
    const StoredTouch& stored = record.touches[i];
    RunReport::Touch& touch = list.emplace_back();
    touch.touch = static_cast<int>(i) + 1;
    touch.plane = stored.plane;
    touch.role = stored.role;
    for (const auto joint : stored.joints) touch.joints_deg.push_back(degrees_text(joint));
    touch.source = cs8::name(stored.source);
    touch.captured_at = stored.captured_at;
    if (i >= result.touches.size()) continue;
    touch.use = result.touches[i].use;
    touch.nominal_mm = result.touches[i].nominal_mm;
    touch.calibrated_mm = result.touches[i].calibrated_mm;
  }
  return list;
}

}  // namespace

std::string raw_data_text(const std::vector<StoredTouch>& touches) {
  std::string lines;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    lines += fmt::format("{},{},{}", i + 1, touches[i].plane, word_of(touches[i].role));
    for (const auto joint : touches[i].joints) lines += "," + degrees_text(joint);
    lines += "\n";
  }
  return lines;
}

std::string report_document(const RunRecord& record) {
  RunReport report{.touchcal_version = kVersion,
                   .run = of_run(record.run),
                   .raw_data = {.sha256 = sha256_hex(raw_data_text(record.touches)),
                                .of = "the first nine columns of the CSV form, without its heading"},
                   .touches = touches_of(
                       record, record.result_json ? read_result(*record.result_json) : ResultDocument())};
  for (const SupersededTouch& again : record.superseded) {
    report.touched_again.push_back({.number = again.touch.number,
                                    .plane = again.touch.plane,
                                    .reason = again.reason,
                                    .captured_at = again.touch.captured_at});
  }
  for (const ReferenceTouch& reference : record.references) {
    report.reference_touches.push_back({.touches_done = reference.touches_done,
                                        .drift_mm = finite(reference.drift_mm),
                                        .captured_at = reference.captured_at});
  }
  for (const RefusedResult& refused : record.refused) {
    RunReport::Refused& told = report.refused_contacts.emplace_back();
    told.sequence = refused.sequence;
    for (const auto joint : refused.joints) told.joints_deg.push_back(degrees_text(joint));
    told.reason = refused.reason;
    told.at = refused.at;
  }
  for (auto fault = record.faults.rbegin(); fault != record.faults.rend(); ++fault)
    report.faults.push_back({.at = fault->at, .code = fault->code, .message = fault->message});
  if (record.result_json) report.result.emplace().text = *record.result_json;
  return document_text(report);
}

std::string report_csv(const RunReport& report) {
  std::string lines =
      "touch,plane,role,joint1_deg,joint2_deg,joint3_deg,joint4_deg,joint5_deg,joint6_deg,use,nominal_mm,"
      "calibrated_mm,captured_at\n";
  const auto figure = [](std::optional<double> value) { return value ? fmt::format("{:.6f}", *value) : ""; };
  for (const RunReport::Touch& touch : report.touches) {
    lines += fmt::format("{},{},{}", touch.touch, touch.plane, word_of(touch.role));
    for (const std::string& joint : touch.joints_deg) lines += "," + joint;
    lines += fmt::format(",{},{},{},{}\n", touch.use ? word_of(*touch.use) : "", figure(touch.nominal_mm),
                         figure(touch.calibrated_mm), touch.captured_at);
  }
  return lines;
}

}  // namespace cell
