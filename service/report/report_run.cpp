// What stands of the run itself in the report of every kind.
#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

/// The place of the block: that of the cell's file, or the located one.
std::string place_text(const ConditionsDocument& conditions) {
  if (!conditions.place) return "unknown";
  const std::optional<PlaceDocument>& place = *conditions.place;
  if (!place) return "as the cell's file has it";
  std::string words = "located " + text_or_unknown(place->located_at) + ", shifted by";
  for (const double shift : place->shift_mm) words += figure_text(shift, " {:+.2f}");
  return words + " mm from where the cell's file has it";
}

/// The block's temperature with who told it, and when it was measured.
std::string temperature_text(const std::optional<double>& celsius, const ConditionsDocument& conditions) {
  std::string words =
      figure_text(celsius, "{:.1f} °C") + figure_if_known(conditions.std_temperature_k, " ± {:.1f} K (std)");
  if (conditions.block_temperature_source == "run") words += ", given with the run";
  if (conditions.block_temperature_source == "file") words += ", from the block's file";
  if (conditions.block_temperature_at)
    words += ", measured " + text_or_unknown(conditions.block_temperature_at);
  return words;
}

}  // namespace

std::string run_section(std::string_view caption, const ReportHead& head,
                        const ConditionsDocument& conditions) {
  const ReportHead::OfRun& run = head.run;
  const ConditionsDocument::Versions& versions = conditions.versions;
  return section(
      "Run and conditions",
      pairs_table(
          caption,
          {{"run", text_or_unknown(run.id)},
           {"recipe", text_or_unknown(run.recipe)},
           {"block's temperature", temperature_text(run.block_temperature_c, conditions)},
           {"arm had moved", figure_text(conditions.arm_moving_min, "{:.0f} min before the run")},
           {"place of the block", place_text(conditions)},
           {"touches made", text_or_unknown(conditions.touch_mode)},
           {"started, ended", text_or_unknown(run.started_at) + ", " + text_or_unknown(run.ended_at)},
           {"touches", std::to_string(run.touches_done) + figure_if_known(run.touches_total, " of {:.0f}")},
           {"outcome", std::string(word_of(run.outcome))},
           {"versions",
            fmt::format("touchcal {}, protocol {}, controller's application {}",
                        text_or_unknown(head.touchcal_version), figure_text(versions.protocol, "{:.0f}"),
                        text_or_unknown(versions.controller_application))},
           {"plan", text_or_unknown(run.plan_id)},
           {"digest of the configuration", text_or_unknown(run.config_digest)},
           {"digest of the raw data", text_or_unknown(head.raw_data.sha256) + " (SHA-256 over " +
                                          text_or_unknown(head.raw_data.of) + ")"}}));
}

std::string made_again_table(const ReportHead& head) {
  std::vector<Row> rows;
  for (const ReportHead::Superseded& touch : head.touched_again)
    rows.push_back({std::to_string(touch.number), std::to_string(touch.plane), text_or_unknown(touch.reason),
                    text_or_unknown(touch.captured_at)});
  return html::table("Touches that were made again", {"touch", "plane", "reason", "first made"}, rows);
}

std::string incident_tables(const ReportHead& head) {
  std::vector<Row> refused;
  for (const ReportHead::Refused& contact : head.refused_contacts)
    refused.push_back({text_or_unknown(contact.at), fmt::format("{}", fmt::join(contact.joints_deg, ", ")),
                       text_or_unknown(contact.reason)});
  std::vector<Row> faults;
  for (const ReportHead::RaisedFault& fault : head.faults)
    faults.push_back(
        {text_or_unknown(fault.at), text_or_unknown(fault.code), text_or_unknown(fault.message)});
  return html::table("Refused contacts", {"when", "joints °", "why"}, refused) +
         html::table("Faults during the run", {"when", "code", "what"}, faults);
}

}  // namespace cell
