#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "service/documents/plane_places.hpp"
#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

constexpr std::array kKinds{"alpha", "d", "theta", "r", "beta"};
const Row kKindHeading{"j", "Δα rad", "Δd mm", "Δθ rad", "Δr mm", "Δβ rad"};

/// Less than this, in mm or rad, is what the arithmetic leaves of nothing.
constexpr double kRoundingMax = 1e-9;

/// An entry of a table of errors by frame: the number, or the mark of its absence.
std::string entry(std::optional<double> figure, std::optional<calib::ParameterStatus> status,
                  const char* format) {
  if (figure && std::abs(*figure) < kRoundingMax) return "0";
  if (figure) return figure_text(figure, format);
  if (!status) return "–";
  switch (*status) {
    case calib::ParameterStatus::kNoEffect:
      return "×";
    case calib::ParameterStatus::kGrouped:
      return "/";
    case calib::ParameterStatus::kWeak:
      return "○";
    case calib::ParameterStatus::kIdentified:
    case calib::ParameterStatus::kExcluded:
      break;
  }
  return "–";
}

/// A row for each frame; `figure` is the member that is shown.
template <class Shown>
std::vector<Row> by_frame(const std::vector<Shown>& parameters, std::optional<double> Shown::*figure,
                          const char* length_format, const char* angle_format) {
  std::vector<Row> rows;
  const int frames = parameters.empty() ? -1 : parameters.back().frame;
  for (int frame = 0; frame <= frames; ++frame) {
    Row row{std::to_string(frame)};
    for (const char* kind : kKinds) {
      const auto found = std::ranges::find_if(
          parameters, [&](const Shown& one) { return one.frame == frame && one.kind == kind; });
      row.push_back(found == parameters.end() ? std::string()
                                              : entry((*found).*figure, found->status,
                                                      found->unit == "mm" ? length_format : angle_format));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string repetition_table(const RepetitionDocument* repetition, const char* caption) {
  if (!repetition) return html::paragraph(fmt::format("{}: unknown.", caption));
  if (!repetition->done)
    return html::paragraph(fmt::format("{}: not made. {}", caption, text_or_unknown(repetition->why_not)));
  return html::table(
      fmt::format("{} ({} touches, {} iterations)", caption, repetition->touch_count, repetition->iterations),
      kKindHeading,
      by_frame(repetition->parameters, &RepetitionDocument::NewError::new_error, "{:+.1e}", "{:+.1e}"));
}

std::string distance_table(const std::vector<PlaneDistances>& planes, const PlanePlaces& places,
                           const char* caption) {
  std::vector<Row> rows;
  for (const PlaneDistances& plane : planes) {
    rows.push_back(
        {"d" + plane_text(plane.plane, places), std::to_string(plane.touch_count),
         figure_text(plane.reference_mm, "{:.3f}"), figure_if_known(plane.estimated_offset_mm, "{:.3f}"),
         figure_text(plane.nominal_mean_mm, "{:.3f}"), figure_text(plane.calibrated_mean_mm, "{:.3f}"),
         figure_text(plane.nominal_agreement_percent, "{:.2f}"), figure_text(plane.nominal_rms_mm, "{:.3f}"),
         figure_text(plane.calibrated_rms_mm, "{:.3f}"), figure_text(plane.error_removed_percent, "{:.2f}")});
  }
  return html::table(caption,
                     {"plane", "touches", "reference mm", "estimated mm", "nominal mm", "calibrated mm",
                      "agreement %", "nominal rms mm", "calibrated rms mm", "error removed %"},
                     rows);
}

/// "theta4 × 1.00", the first ones of a list.
std::string carriers(const std::vector<CarriedError>& grouped_with) {
  std::string words;
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < grouped_with.size() && i < kShown; ++i)
    words += fmt::format("{}{} × {}", i == 0 ? "carried by " : ", ", text_or_unknown(grouped_with[i].name),
                         figure_text(grouped_with[i].factor, "{:.4g}"));
  return grouped_with.size() > kShown ? words + ", ..." : words;
}

std::string status_words(const Parameter& parameter) {
  if (!parameter.status) return "unknown";
  switch (*parameter.status) {
    case calib::ParameterStatus::kGrouped:
      return carriers(parameter.grouped_with);
    case calib::ParameterStatus::kNoEffect:
      return "no effect on the touches";
    case calib::ParameterStatus::kWeak:
      return "too weak to tell from noise, held at nominal";
    case calib::ParameterStatus::kIdentified:
    case calib::ParameterStatus::kExcluded:
      break;
  }
  return std::string(word_of(*parameter.status));
}

std::string interval_words(const decltype(Parameter::interval95)& interval, const char* format) {
  if (!interval) return "";
  return fmt::format("{} to {}", figure_text((*interval)[0], format), figure_text((*interval)[1], format));
}

}  // namespace

std::string errors_table(const ResultDocument& result) {
  return html::table("Table III. Errors of the kinematic parameters", kKindHeading,
                     by_frame(result.parameters, &Parameter::error, "{:+.4f}", "{:+.6f}")) +
         html::paragraph(
             "Marks: – left out on purpose; / carried by other errors, which the list below names; × without "
             "effect "
             "on the touches; ○ too weak to tell from noise. The paper's tables use / and × in this way; its "
             "legend "
             "gives them the other way round.");
}

std::string intervals_table(const ResultDocument& result) {
  std::vector<Row> rows;
  for (const Parameter& parameter : result.parameters) {
    const bool is_length = parameter.unit == "mm";
    const char* format = is_length ? "{:+.4f}" : "{:+.6f}";
    rows.push_back({text_or_unknown(parameter.name), text_or_unknown(parameter.unit),
                    figure_text(parameter.nominal, is_length ? "{:.3f}" : "{:.6f}"),
                    figure_if_known(parameter.error, format),
                    figure_if_known(parameter.std_uncertainty, is_length ? "{:.4f}" : "{:.6f}"),
                    interval_words(parameter.interval95, format), status_words(parameter)});
  }
  return html::table("Errors with their uncertainty",
                     {"error of", "unit", "nominal", "error", "std. uncertainty", "95 % interval", "status"},
                     rows);
}

std::string repetition_tables(const ResultDocument& result) {
  const auto& validation = result.validation;
  return repetition_table(validation ? &validation->same_touches : nullptr,
                          "Table IV. New errors from the calibrated arm with the same touches") +
         repetition_table(validation ? &validation->other_touches : nullptr,
                          "Table V. New errors from the calibrated arm with the held-out touches");
}

std::string distance_tables(const ResultDocument& result) {
  const PlanePlaces places = plane_places_of(result);
  return distance_table(result.planes, places, "Table VI. Distances of the touches that were used") +
         distance_table(result.planes_held_out, places, "Table VII. Distances of the held-out touches") +
         (result.planes_proof.empty()
              ? std::string()
              : distance_table(result.planes_proof, places, "Distances of the proof touches"));
}

std::string model_table(const ResultDocument& result) {
  if (result.nongeometric_parameters.empty()) return "";
  std::vector<Row> rows;
  for (const NongeometricParameter& parameter : result.nongeometric_parameters) {
    rows.push_back(
        {text_or_unknown(parameter.name), text_or_unknown(parameter.unit),
         figure_text(parameter.value, "{:.3g}"), figure_text(parameter.std_uncertainty, "{:.2g}"),
         parameter.status == ArtefactStatus::kPrior ? "as the arm's file says" : "found by the touches"});
  }
  return html::table("Beside rigid kinematics", {"of", "unit", "value", "std. uncertainty", "status"}, rows);
}

std::string block_and_probe_table(const ResultDocument& result) {
  std::vector<Row> rows;
  for (const ArtefactParameter& parameter : result.artefact_parameters) {
    const char* format = parameter.unit == "rad" ? "{:.6f}" : "{:.4f}";
    rows.push_back({text_or_unknown(parameter.name), text_or_unknown(parameter.unit),
                    figure_text(parameter.nominal, format), figure_text(parameter.value, format),
                    figure_text(parameter.std_uncertainty, format),
                    parameter.status == ArtefactStatus::kPrior ? "as written down" : "found by the touches"});
  }
  return html::table("Block and probe", {"of", "unit", "written", "value", "std. uncertainty", "status"},
                     rows);
}

}  // namespace cell
