#include "service/report/report_document.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cs8_protocol/names.hpp"
#include "service/base/digest.hpp"
#include "service/base/json_figures.hpp"
#include "service/base/version.hpp"
#include "service/documents/json_view.hpp"

namespace cell {
namespace {

/// An integer of 10^-6 degrees as degrees, without rounding.
std::string degrees_text(std::int64_t microdegrees) {
  constexpr std::int64_t kPerDegree = 1'000'000;
  const std::int64_t size = std::abs(microdegrees);
  return fmt::format("{}{}.{:06}", microdegrees < 0 ? "-" : "", size / kPerDegree, size % kPerDegree);
}

Json recorded_run_json(const StoredRun& run) {
  return {{"id", std::to_string(run.id)},
          {"recipe", run.recipe},
          {"operator", value_or_null(run.operator_name)},
          {"started_at", run.started_at},
          {"ended_at", value_or_null(run.ended_at)},
          {"outcome", run_outcome_name(run.outcome)},
          {"verdict", verdict_name(run.verdict)},
          {"touches_done", run.touches_done},
          {"touches_total", run.touches_total > 0 ? Json(run.touches_total) : Json(nullptr)},
          {"fault_code", value_or_null(run.fault_code)},
          {"fault_message", value_or_null(run.fault_message)},
          {"plan_id", value_or_null(run.plan_id)},
          {"config_digest", value_or_null(run.config_digest)},
          {"block_temperature_c", number(run.block_temperature_c)}};
}

/// The entry of the result for the touch at this index; an empty object if there is none.
Json verdict_on(const Json& result, std::size_t index) {
  static const Json nothing = Json::object();
  if (!result.is_object() || !result.contains("touches")) return nothing;
  const Json& touches = result["touches"];
  return index < touches.size() ? touches[index] : nothing;
}

Json touches_json(const RunRecord& record, const Json& result) {
  Json list = Json::array();
  for (std::size_t i = 0; i < record.touches.size(); ++i) {
    const StoredTouch& touch = record.touches[i];
    const Json found = verdict_on(result, i);
    Json joints = Json::array();
    for (const auto joint : touch.joints) joints.push_back(degrees_text(joint));
    list.push_back({{"touch", i + 1},
                    {"plane", touch.plane},
                    {"role", role_name(touch.role)},
                    {"joints_deg", joints},
                    {"source", cs8::name(touch.source)},
                    {"captured_at", touch.captured_at},
                    {"use", found.value("use", Json(nullptr))},
                    {"nominal_mm", found.value("nominal_mm", Json(nullptr))},
                    {"calibrated_mm", found.value("calibrated_mm", Json(nullptr))}});
  }
  return list;
}

}  // namespace

std::string raw_data_text(const std::vector<StoredTouch>& touches) {
  std::string lines;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    lines += fmt::format("{},{},{}", i + 1, touches[i].plane, role_name(touches[i].role));
    for (const auto joint : touches[i].joints) lines += "," + degrees_text(joint);
    lines += "\n";
  }
  return lines;
}

Json report_json(const RunRecord& record) {
  const Json result = record.result_json ? Json::parse(*record.result_json) : Json(nullptr);
  Json superseded = Json::array();
  for (const SupersededTouch& again : record.superseded) {
    superseded.push_back({{"number", again.touch.number},
                          {"plane", again.touch.plane},
                          {"reason", again.reason},
                          {"captured_at", again.touch.captured_at}});
  }
  Json references = Json::array();
  for (const ReferenceTouch& reference : record.references) {
    references.push_back({{"touches_done", reference.touches_done},
                          {"drift_mm", number(reference.drift_mm)},
                          {"captured_at", reference.captured_at}});
  }
  Json faults = Json::array();
  for (auto fault = record.faults.rbegin(); fault != record.faults.rend(); ++fault)
    faults.push_back({{"at", fault->at}, {"code", fault->code}, {"message", fault->message}});
  return {{"schema", "touchcal/report/1"},
          {"touchcal_version", kVersion},
          {"run", recorded_run_json(record.run)},
          {"raw_data",
           {{"sha256", sha256_hex(raw_data_text(record.touches))},
            {"of", "the first nine columns of the CSV form, without its heading"}}},
          {"touches", touches_json(record, result)},
          {"touched_again", superseded},
          {"reference_touches", references},
          {"faults", faults},
          {"result", result}};
}

std::string report_csv(const Json& report) {
  std::string lines =
      "touch,plane,role,joint1_deg,joint2_deg,joint3_deg,joint4_deg,joint5_deg,joint6_deg,use,nominal_mm,"
      "calibrated_mm,captured_at\n";
  const auto text = [](const Json& value) { return value.is_string() ? value.get<std::string>() : ""; };
  const auto figure = [](const Json& value) {
    return value.is_number() ? fmt::format("{:.6f}", value.get<double>()) : "";
  };
  for (const Json& touch : report.at("touches")) {
    lines += fmt::format("{},{},{}", touch.at("touch").get<int>(), touch.at("plane").get<int>(),
                         text(touch.at("role")));
    for (const Json& joint : touch.at("joints_deg")) lines += "," + text(joint);
    lines += fmt::format(",{},{},{},{}\n", text(touch.at("use")), figure(touch.at("nominal_mm")),
                         figure(touch.at("calibrated_mm")), text(touch.at("captured_at")));
  }
  return lines;
}

}  // namespace cell
