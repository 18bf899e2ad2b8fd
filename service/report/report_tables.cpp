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

Row kind_heading() { return {"j", "Δα rad", "Δd mm", "Δθ rad", "Δr mm", "Δβ rad"}; }

/// Less than this, in mm or rad, is what the arithmetic leaves of nothing.
constexpr double kRoundingMax = 1e-9;

/// An entry of a table of errors by frame: the number, or the mark of its absence.
std::string entry(const Words& words, std::optional<double> figure,
                  std::optional<calib::ParameterStatus> status, const char* format) {
  if (figure && std::abs(*figure) < kRoundingMax) return "0";
  if (figure) return words.figure(figure, format);
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
std::vector<Row> by_frame(const Words& words, const std::vector<Shown>& parameters,
                          std::optional<double> Shown::*figure, const char* length_format,
                          const char* angle_format) {
  std::vector<Row> rows;
  const int frames = parameters.empty() ? -1 : parameters.back().frame;
  for (int frame = 0; frame <= frames; ++frame) {
    Row row{std::to_string(frame)};
    for (const char* kind : kKinds) {
      const auto found = std::ranges::find_if(
          parameters, [&](const Shown& one) { return one.frame == frame && one.kind == kind; });
      row.emplace_back(found == parameters.end() ? std::string()
                                                 : entry(words, (*found).*figure, found->status,
                                                         found->unit == "mm" ? length_format : angle_format));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string repetition_table(const Words& words, const RepetitionDocument* repetition, const char* caption) {
  if (!repetition) return html::paragraph(words("{}: unknown.", words(caption)));
  if (!repetition->done)
    return html::paragraph(words("{}: not made.", words(caption))) +
           html::paragraph(stored_text(words, repetition->why_not.value_or("")));
  return html::table(words,
                     words("{} ({} touches, {} iterations)", words(caption), repetition->touch_count,
                           repetition->iterations),
                     kind_heading(),
                     by_frame(words, repetition->parameters, &RepetitionDocument::NewError::new_error,
                              "{:+.1e}", "{:+.1e}"));
}

std::string distance_table(const Words& words, const std::vector<PlaneDistances>& planes,
                           const PlanePlaces& places, const char* caption) {
  std::vector<Row> rows;
  for (const PlaneDistances& plane : planes) {
    rows.push_back(
        {"d" + plane_text(plane.plane, places), std::to_string(plane.touch_count),
         words.figure(plane.reference_mm, "{:.3f}"), words.if_known(plane.estimated_offset_mm, "{:.3f}"),
         words.figure(plane.nominal_mean_mm, "{:.3f}"), words.figure(plane.calibrated_mean_mm, "{:.3f}"),
         words.figure(plane.nominal_agreement_percent, "{:.2f}"),
         words.figure(plane.nominal_rms_mm, "{:.3f}"), words.figure(plane.calibrated_rms_mm, "{:.3f}"),
         words.figure(plane.error_removed_percent, "{:.2f}")});
  }
  return html::table(words, words(caption),
                     {words("plane"), words("touches"), words("reference mm"), words("estimated mm"),
                      words("nominal mm"), words("calibrated mm"), words("agreement %"),
                      words("nominal rms mm"), words("calibrated rms mm"), words("error removed %")},
                     rows);
}

/// "theta4 × 1.00", the first ones of a list.
std::string carriers(const Words& words, const std::vector<CarriedError>& grouped_with) {
  std::string told;
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < grouped_with.size() && i < kShown; ++i)
    told += fmt::format("{}{} × {}", i == 0 ? "" : ", ", words.known(grouped_with[i].name),
                        words.figure(grouped_with[i].factor, "{:.4g}"));
  return words("carried by {}", grouped_with.size() > kShown ? told + ", ..." : told);
}

std::string status_words(const Words& words, const Parameter& parameter) {
  if (!parameter.status) return words("unknown");
  switch (*parameter.status) {
    case calib::ParameterStatus::kGrouped:
      return carriers(words, parameter.grouped_with);
    case calib::ParameterStatus::kNoEffect:
      return words("no effect on the touches");
    case calib::ParameterStatus::kWeak:
      return words("too weak to tell from noise, held at nominal");
    case calib::ParameterStatus::kIdentified:
    case calib::ParameterStatus::kExcluded:
      break;
  }
  return words(word_of(*parameter.status));
}

std::string interval_words(const Words& words, const decltype(Parameter::interval95)& interval,
                           const char* format) {
  if (!interval) return "";
  return words("{} to {}", words.figure((*interval)[0], format), words.figure((*interval)[1], format));
}

}  // namespace

PlanePlaces places_of(const Words& words, const ResultDocument& result) {
  PlanePlaces places;
  for (const auto* planes : {&result.planes, &result.planes_held_out, &result.planes_proof}) {
    for (const PlaneDistances& plane : *planes) {
      std::string where = plane.place.value_or("");
      if (plane.tip) where += (where.empty() ? "" : ", ") + words("tip {}", *plane.tip);
      if (!where.empty()) places.emplace(plane.plane, where);
    }
  }
  return places;
}

std::string errors_table(const Words& words, const ResultDocument& result) {
  return html::table(words, words("Table III. Errors of the kinematic parameters"), kind_heading(),
                     by_frame(words, result.parameters, &Parameter::error, "{:+.4f}", "{:+.6f}")) +
         html::paragraph(words(
             "Marks: – left out on purpose; / carried by other errors, which the list below names; × without "
             "effect "
             "on the touches; ○ too weak to tell from noise. The paper's tables use / and × in this way; its "
             "legend "
             "gives them the other way round."));
}

std::string intervals_table(const Words& words, const ResultDocument& result) {
  std::vector<Row> rows;
  for (const Parameter& parameter : result.parameters) {
    const bool is_length = parameter.unit == "mm";
    const char* format = is_length ? "{:+.4f}" : "{:+.6f}";
    rows.push_back({words.known(parameter.name), words.known(parameter.unit),
                    words.figure(parameter.nominal, is_length ? "{:.3f}" : "{:.6f}"),
                    words.if_known(parameter.error, format),
                    words.if_known(parameter.std_uncertainty, is_length ? "{:.4f}" : "{:.6f}"),
                    interval_words(words, parameter.interval95, format), status_words(words, parameter)});
  }
  return html::table(words, words("Errors with their uncertainty"),
                     {words("error of"), words("unit"), words("nominal"), words("error"),
                      words("std. uncertainty"), words("95 % interval"), words("status")},
                     rows);
}

std::string repetition_tables(const Words& words, const ResultDocument& result) {
  const auto& validation = result.validation;
  return repetition_table(words, validation ? &validation->same_touches : nullptr,
                          "Table IV. New errors from the calibrated arm with the same touches") +
         repetition_table(words, validation ? &validation->other_touches : nullptr,
                          "Table V. New errors from the calibrated arm with the held-out touches");
}

std::string distance_tables(const Words& words, const ResultDocument& result) {
  const PlanePlaces places = places_of(words, result);
  return distance_table(words, result.planes, places, "Table VI. Distances of the touches that were used") +
         distance_table(words, result.planes_held_out, places,
                        "Table VII. Distances of the held-out touches") +
         (result.planes_proof.empty()
              ? std::string()
              : distance_table(words, result.planes_proof, places, "Distances of the proof touches"));
}

std::string model_table(const Words& words, const ResultDocument& result) {
  if (result.nongeometric_parameters.empty()) return "";
  std::vector<Row> rows;
  for (const NongeometricParameter& parameter : result.nongeometric_parameters) {
    rows.push_back({words.known(parameter.name), words.known(parameter.unit),
                    words.figure(parameter.value, "{:.3g}"),
                    words.figure(parameter.std_uncertainty, "{:.2g}"),
                    parameter.status == ArtefactStatus::kPrior ? words("as the arm's file says")
                                                               : words("found by the touches")});
  }
  return html::table(
      words, words("Beside rigid kinematics"),
      {words("quantity"), words("unit"), words("value"), words("std. uncertainty"), words("status")}, rows);
}

std::string block_and_probe_table(const Words& words, const ResultDocument& result) {
  std::vector<Row> rows;
  for (const ArtefactParameter& parameter : result.artefact_parameters) {
    const char* format = parameter.unit == "rad" ? "{:.6f}" : "{:.4f}";
    rows.push_back({words.known(parameter.name), words.known(parameter.unit),
                    words.figure(parameter.nominal, format), words.figure(parameter.value, format),
                    words.figure(parameter.std_uncertainty, format),
                    parameter.status == ArtefactStatus::kPrior ? words("as written down")
                                                               : words("found by the touches")});
  }
  return html::table(words, words("Block and probe"),
                     {words("quantity"), words("unit"), words("written"), words("value"),
                      words("std. uncertainty"), words("status")},
                     rows);
}

}  // namespace cell
