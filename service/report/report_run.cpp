// What stands of the run itself in the report of every kind.
#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

/// The place of the block: that of the cell's file, or the located one.
std::string place_text(const Words& words, const ConditionsDocument& conditions) {
  if (!conditions.place) return words("unknown");
  const std::optional<PlaceDocument>& place = *conditions.place;
  if (!place) return words("as the cell's file has it");
  std::string shift;
  for (const double mm : place->shift_mm) shift += words(" {:+.2f}", mm);
  return words("located {}, shifted by{} mm from where the cell's file has it",
               words.known(place->located_at), shift);
}

/// The block's temperature with who told it, and when it was measured.
std::string temperature_text(const Words& words, const std::optional<double>& celsius,
                             const ConditionsDocument& conditions) {
  std::string told =
      words.figure(celsius, "{:.1f} °C") + words.if_known(conditions.std_temperature_k, " ± {:.1f} K (std)");
  if (conditions.block_temperature_source == "run") told += words(", given with the run");
  if (conditions.block_temperature_source == "file") told += words(", from the block's file");
  if (conditions.block_temperature_at)
    told += words(", measured {}", words.known(conditions.block_temperature_at));
  return told;
}

}  // namespace

std::string run_section(const Words& words, std::string_view caption, const ReportHead& head,
                        const ConditionsDocument& conditions) {
  const ReportHead::OfRun& run = head.run;
  const ConditionsDocument::Versions& versions = conditions.versions;
  return section(
      words("Run and conditions"),
      pairs_table(
          words, caption,
          {{words("run"), words.known(run.id)},
           {words("recipe"), words.known(run.recipe)},
           {words("block's temperature"), temperature_text(words, run.block_temperature_c, conditions)},
           {words("arm had moved"), words.figure(conditions.arm_moving_min, "{:.0f} min before the run")},
           {words("place of the block"), place_text(words, conditions)},
           {words("touches made"), words(words.known(conditions.touch_mode))},
           {words("started, ended"), words.known(run.started_at) + ", " + words.known(run.ended_at)},
           {words("touches"),
            std::to_string(run.touches_done) + words.if_known(run.touches_total, " of {:.0f}")},
           {words("outcome"), words(word_of(run.outcome))},
           {words("versions"),
            words("touchcal {}, protocol {}, controller's application {}", words.known(head.touchcal_version),
                  words.figure(versions.protocol, "{:.0f}"), words.known(versions.controller_application))},
           {words("plan"), words.known(run.plan_id)},
           {words("digest of the configuration"), words.known(run.config_digest)},
           {words("digest of the raw data"), words("{} (SHA-256 over {})", words.known(head.raw_data.sha256),
                                                   words(words.known(head.raw_data.of)))}}));
}

std::string made_again_table(const Words& words, const ReportHead& head) {
  std::vector<Row> rows;
  for (const ReportHead::Superseded& touch : head.touched_again)
    rows.push_back({std::to_string(touch.number), std::to_string(touch.plane),
                    stored_text(words, touch.reason), words.known(touch.captured_at)});
  return html::table(words, words("Touches that were made again"),
                     {words("touch"), words("plane"), words("reason"), words("first made")}, rows);
}

std::string incident_tables(const Words& words, const ReportHead& head) {
  std::vector<Row> refused;
  for (const ReportHead::Refused& contact : head.refused_contacts)
    refused.push_back(
        {words.known(contact.at), words.numbers(contact.joints_deg), stored_text(words, contact.reason)});
  std::vector<Row> faults;
  for (const ReportHead::RaisedFault& fault : head.faults)
    faults.push_back({words.known(fault.at), words.known(fault.code), stored_text(words, fault.message)});
  return html::table(words, words("Refused contacts"), {words("when"), words("joints °"), words("why")},
                     refused) +
         html::table(words, words("Faults during the run"), {words("when"), words("code"), words("what")},
                     faults);
}

}  // namespace cell
