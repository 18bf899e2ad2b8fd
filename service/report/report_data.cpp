// What the report of a run of any kind says of the run itself, from what is stored.
#include "service/report/internal/report_data.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>

#include "service/base/digest.hpp"
#include "service/base/version.hpp"
#include "service/documents/figures.hpp"

namespace cell {
namespace {

ReportHead::OfRun of_run(const StoredRun& run) {
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

}  // namespace

std::string degrees_text(std::int64_t microdegrees) {
  constexpr std::int64_t kPerDegree = 1'000'000;
  const std::int64_t size = std::abs(microdegrees);
  return fmt::format("{}{}.{:06}", microdegrees < 0 ? "-" : "", size / kPerDegree, size % kPerDegree);
}

std::vector<std::string> degrees_texts(const cs8::JointsMicrodeg& joints) {
  std::vector<std::string> texts;
  for (const auto joint : joints) texts.push_back(degrees_text(joint));
  return texts;
}

ReportHead head_of(const RunRecord& record) {
  ReportHead head{.touchcal_version = kVersion,
                  .run = of_run(record.run),
                  .raw_data = {.sha256 = sha256_hex(raw_data_text(record.touches)),
                               .of = "the first nine columns of the CSV form, without its heading"}};
  for (const SupersededTouch& again : record.superseded) {
    head.touched_again.push_back({.number = again.touch.number,
                                  .plane = again.touch.plane,
                                  .reason = again.reason,
                                  .captured_at = again.touch.captured_at});
  }
  for (const RefusedResult& refused : record.refused) {
    head.refused_contacts.push_back({.sequence = refused.sequence,
                                     .joints_deg = degrees_texts(refused.joints),
                                     .reason = refused.reason,
                                     .at = refused.at});
  }
  for (auto fault = record.faults.rbegin(); fault != record.faults.rend(); ++fault)
    head.faults.push_back({.at = fault->at, .code = fault->code, .message = fault->message});
  return head;
}

}  // namespace cell
