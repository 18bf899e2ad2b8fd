#include <spdlog/fmt/fmt.h>

#include <array>
#include <nlohmann/json.hpp>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

constexpr std::array kKinds{"alpha", "d", "theta", "r", "beta"};
const Row kKindHeading{"j", "Δα rad", "Δd mm", "Δθ rad", "Δr mm", "Δβ rad"};

/// An entry of a table of errors by frame: the number, or the mark of its absence.
std::string entry(const Json& parameters, int frame, const std::string& kind, const char* field,
                  const char* length_format, const char* angle_format) {
  for (const Json& parameter : parameters) {
    if (part(parameter, "frame").get<int>() != frame || !is(part(parameter, "kind"), kind)) continue;
    if (part(parameter, field).is_number())
      return figure_text(part(parameter, field),
                         is(part(parameter, "unit"), "mm") ? length_format : angle_format);
    const Json& status = part(parameter, "status");
    if (is(status, "no_effect")) return "×";
    return is(status, "grouped") ? "/" : is(status, "weak") ? "○" : "–";
  }
  return "";
}

std::vector<Row> by_frame(const Json& parameters, const char* field, const char* length_format,
                          const char* angle_format) {
  std::vector<Row> rows;
  const int frames = parameters.empty() ? -1 : part(parameters.back(), "frame").get<int>();
  for (int frame = 0; frame <= frames; ++frame) {
    Row row{std::to_string(frame)};
    for (const char* kind : kKinds)
      row.push_back(entry(parameters, frame, kind, field, length_format, angle_format));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string repetition_table(const Json& repetition, const char* caption) {
  if (!repetition.is_object()) return html::paragraph(fmt::format("{}: unknown.", caption));
  if (!part(repetition, "done").get<bool>())
    return html::paragraph(
        fmt::format("{}: not made. {}", caption, text_or_unknown(part(repetition, "why_not"))));
  return html::table(fmt::format("{} ({} touches, {} iterations)", caption,
                                 figure_text(part(repetition, "touch_count"), "{:.0f}"),
                                 figure_text(part(repetition, "iterations"), "{:.0f}")),
                     kKindHeading,
                     by_frame(part(repetition, "parameters"), "new_error", "{:+.1e}", "{:+.1e}"));
}

std::string distance_table(const Json& planes, const char* caption) {
  std::vector<Row> rows;
  for (const Json& plane : planes) {
    rows.push_back({figure_text(part(plane, "plane"), "d{:.0f}"),
                    figure_text(part(plane, "touch_count"), "{:.0f}"),
                    figure_text(part(plane, "reference_mm"), "{:.3f}"),
                    figure_text(part(plane, "nominal_mean_mm"), "{:.3f}"),
                    figure_text(part(plane, "calibrated_mean_mm"), "{:.3f}"),
                    figure_text(part(plane, "nominal_agreement_percent"), "{:.2f}"),
                    figure_text(part(plane, "nominal_rms_mm"), "{:.3f}"),
                    figure_text(part(plane, "calibrated_rms_mm"), "{:.3f}"),
                    figure_text(part(plane, "error_removed_percent"), "{:.2f}")});
  }
  return html::table(caption,
                     {"plane", "touches", "reference mm", "nominal mm", "calibrated mm", "agreement %",
                      "nominal rms mm", "calibrated rms mm", "error removed %"},
                     rows);
}

/// "theta4 × 1.00", the first ones of a list.
std::string carriers(const Json& grouped_with) {
  std::string words;
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < grouped_with.size() && i < kShown; ++i)
    words += fmt::format("{}{} × {}", i == 0 ? "carried by " : ", ",
                         text_or_unknown(part(grouped_with[i], "name")),
                         figure_text(part(grouped_with[i], "factor"), "{:.4g}"));
  return grouped_with.size() > kShown ? words + ", ..." : words;
}

std::string status_words(const Json& parameter) {
  const std::string status = text_or_unknown(part(parameter, "status"));
  if (status == "grouped") return carriers(part(parameter, "grouped_with"));
  if (is(status, "no_effect")) return "no effect on the touches";
  if (status == "weak") return "too weak to tell from noise, held at nominal";
  return status;
}

std::string interval_words(const Json& interval, const char* format) {
  if (!interval.is_array() || interval.size() != 2) return "";
  return fmt::format("{} to {}", figure_text(interval[0], format), figure_text(interval[1], format));
}

}  // namespace

std::string errors_table(const Json& result) {
  return html::table("Table III. Errors of the kinematic parameters", kKindHeading,
                     by_frame(part(result, "parameters"), "error", "{:+.4f}", "{:+.6f}")) +
         html::paragraph(
             "Marks: – left out on purpose; / carried by other errors, which the list below names; × without "
             "effect "
             "on the touches; ○ too weak to tell from noise. The paper's tables use / and × in this way; its "
             "legend "
             "gives them the other way round.");
}

std::string intervals_table(const Json& result) {
  std::vector<Row> rows;
  for (const Json& parameter : part(result, "parameters")) {
    const bool is_length = is(part(parameter, "unit"), "mm");
    const char* format = is_length ? "{:+.4f}" : "{:+.6f}";
    rows.push_back({text_or_unknown(part(parameter, "name")), text_or_unknown(part(parameter, "unit")),
                    figure_text(part(parameter, "nominal"), is_length ? "{:.3f}" : "{:.6f}"),
                    figure_if_known(part(parameter, "error"), format),
                    figure_if_known(part(parameter, "std_uncertainty"), is_length ? "{:.4f}" : "{:.6f}"),
                    interval_words(part(parameter, "interval95"), format), status_words(parameter)});
  }
  return html::table("Errors with their uncertainty",
                     {"error of", "unit", "nominal", "error", "std. uncertainty", "95 % interval", "status"},
                     rows);
}

std::string repetition_tables(const Json& result) {
  const Json& validation = part(result, "validation");
  return repetition_table(part(validation, "same_touches"),
                          "Table IV. New errors from the calibrated arm with the same touches") +
         repetition_table(part(validation, "other_touches"),
                          "Table V. New errors from the calibrated arm with the held-out touches");
}

std::string distance_tables(const Json& result) {
  return distance_table(part(result, "planes"), "Table VI. Distances of the touches that were used") +
         distance_table(part(result, "planes_held_out"), "Table VII. Distances of the held-out touches") +
         (part(result, "planes_proof").empty()
              ? std::string()
              : distance_table(part(result, "planes_proof"), "Distances of the proof touches"));
}

std::string block_and_probe_table(const Json& result) {
  std::vector<Row> rows;
  for (const Json& parameter : part(result, "artefact_parameters")) {
    const char* format = is(part(parameter, "unit"), "rad") ? "{:.6f}" : "{:.4f}";
    rows.push_back({text_or_unknown(part(parameter, "name")), text_or_unknown(part(parameter, "unit")),
                    figure_text(part(parameter, "nominal"), format),
                    figure_text(part(parameter, "value"), format),
                    figure_text(part(parameter, "std_uncertainty"), format),
                    is(part(parameter, "status"), "prior") ? "as written down" : "found by the touches"});
  }
  return html::table("Block and probe", {"of", "unit", "written", "value", "std. uncertainty", "status"},
                     rows);
}

}  // namespace cell
