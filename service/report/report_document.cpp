#include "service/report/report_document.hpp"

#include <spdlog/fmt/fmt.h>

#include "cs8_protocol/names.hpp"
#include "service/documents/figures.hpp"
#include "service/report/internal/report_data.hpp"

namespace cell {
namespace {

/// Each touch with the entry of the result at the same index, if there is one.
std::vector<RunReport::Touch> touches_of(const RunRecord& record, const ResultDocument& result) {
  std::vector<RunReport::Touch> list;
  for (std::size_t i = 0; i < record.touches.size(); ++i) {
    const StoredTouch& stored = record.touches[i];
    RunReport::Touch& touch = list.emplace_back();
    touch.touch = static_cast<int>(i) + 1;
    touch.plane = stored.plane;
    touch.role = stored.role;
    touch.joints_deg = degrees_texts(stored.joints);
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
  RunReport report{head_of(record)};
  report.touches =
      touches_of(record, record.result_json ? read_result(*record.result_json) : ResultDocument());
  for (const ReferenceTouch& reference : record.references) {
    report.reference_touches.push_back({.touches_done = reference.touches_done,
                                        .drift_mm = finite(reference.drift_mm),
                                        .captured_at = reference.captured_at});
  }
  if (record.result_json) report.result.emplace().text = *record.result_json;
  for (const StoredRun& proof : record.proofs)
    report.proofs.push_back(
        {.run = std::to_string(proof.id), .ended_at = proof.ended_at.value_or(""), .verdict = proof.verdict});
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
