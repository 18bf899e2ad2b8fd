#include "service/documents/parameter_view.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/base/json_figures.hpp"
#include "service/run/verdict.hpp"

namespace cell {
namespace {

/// An artefact parameter is identified if the touches reduced its prior deviation by this share.
constexpr double kIdentifiedFall = 0.1;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // shown as null

const char* status_name(calib::ParameterStatus status) {
  switch (status) {
    case calib::ParameterStatus::kIdentified:
      return "identified";
    case calib::ParameterStatus::kGrouped:
      return "grouped";
    case calib::ParameterStatus::kNoEffect:
      return "no_effect";
    case calib::ParameterStatus::kExcluded:
      return "excluded";
    case calib::ParameterStatus::kWeak:
      return "weak";
  }
  return "";
}

const char* group_name(calib::ParameterGroup group) {
  switch (group) {
    case calib::ParameterGroup::kBlockPose:
      return "place";
    case calib::ParameterGroup::kArm:
      return "arm";
    case calib::ParameterGroup::kTool:
      return "tool";
  }
  return "";
}

const calib::ErrorParameter& parameter_at(int index) {
  return calib::error_parameters()[static_cast<std::size_t>(index)];
}

/// One shown unit of `from` adds `factor` shown units to `to`, when one SI unit of it adds `factor_si`.
Json factor_json(int named, int from, int to, double factor_si) {
  return {{"name", parameter_at(named).name()}, {"factor", shown(to, factor_si) / shown(from, 1.0)}};
}

/// Which grouped errors each candidate carries: the transpose of grouped_with.
std::array<Json, calib::kErrorParameterCount> carried(const calib::IdentifiableSet& identifiable) {
  std::array<Json, calib::kErrorParameterCount> stands_for;
  stands_for.fill(Json::array());
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    for (const auto& [other, factor] : identifiable.candidates[static_cast<std::size_t>(i)].grouped_with)
      stands_for[static_cast<std::size_t>(other)].push_back(factor_json(i, i, other, factor));
  }
  return stands_for;
}

/// One standard deviation of an estimated arm parameter, SI.
std::optional<double> std_of(const calib::IdentificationResult& result, int index) {
  if (!result.uncertainty) return std::nullopt;
  return result.uncertainty->std_error(index);
}

Json interval_json(int index, double error, std::optional<double> std,
                   const calib::UncertaintyBudget* uncertainty) {
  if (!std || !uncertainty) return nullptr;
  const double half = uncertainty->coverage_factor * *std;
  return {number(shown(index, error - half)), number(shown(index, error + half))};
}

Json identity_json(const calib::KinematicModel& nominal, int index) {
  const calib::ErrorParameter& parameter = parameter_at(index);
  const std::string name = parameter.name();
  return {{"name", name},
          {"frame", parameter.frame},
          {"kind", name.substr(0, name.size() - 1)},
          {"group", group_name(parameter.group())},
          {"unit", parameter.is_length() ? "mm" : "rad"},
          {"nominal", shown(index, calib::parameter_value(nominal, index))}};
}

const char* unit_name(calib::ArtefactKind kind) {
  switch (kind) {
    case calib::ArtefactKind::kFaceTilt:
      return "rad";
    case calib::ArtefactKind::kTemperature:
      return "degC";
    case calib::ArtefactKind::kFaceOffset:
    case calib::ArtefactKind::kStylusRadius:
    case calib::ArtefactKind::kPretravel:
      return "mm";
  }
  return "";
}

std::string arm_parameter_name(int index) {
  if (index < calib::kErrorParameterCount) return parameter_at(index).name();
  const auto compliance = static_cast<std::size_t>(index - calib::kErrorParameterCount);
  return "compliance" + std::to_string(calib::kCompliantJoints[compliance] + 1);
}

}  // namespace

double shown(int index, double value) {
  return parameter_at(index).is_length() ? calib::mm_from_metres(value) : value;
}

Json parameters_json(const calib::IdentificationProblem& problem, const calib::IdentificationOptions& options,
                     const calib::IdentificationResult& result) {
  const auto stands_for = carried(result.identifiable);
  Json parameters = Json::array();
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const calib::CandidateStatus& candidate = result.identifiable.candidates[index];
    const bool estimated = is_estimated(options, result.identifiable, i);
    const auto std = estimated ? std_of(result, i) : std::nullopt;
    Json grouped_with = Json::array();
    for (const auto& [other, factor] : candidate.grouped_with) {
      if (!estimated) grouped_with.push_back(factor_json(other, i, other, factor));
    }
    Json parameter = identity_json(problem.nominal, i);
    parameter["status"] = estimated ? "identified" : status_name(candidate.status);
    parameter["error"] = estimated ? number(shown(i, result.errors[i])) : Json(nullptr);
    parameter["std_uncertainty"] = std ? number(shown(i, *std)) : Json(nullptr);
    parameter["interval95"] =
        interval_json(i, result.errors[i], std, result.uncertainty ? &*result.uncertainty : nullptr);
    parameter["grouped_with"] = grouped_with;
    parameter["stands_for"] = options.prior ? Json::array() : stands_for[index];
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

Json artefact_parameters_json(const calib::IdentificationProblem& problem,
                              const calib::IdentificationResult& result) {
  Json list = Json::array();
  for (std::size_t i = 0; i < problem.artefact.parameters.size(); ++i) {
    const calib::ArtefactParameter& parameter = problem.artefact.parameters[i];
    const auto index = static_cast<Eigen::Index>(i);
    const std::string unit = unit_name(parameter.kind);
    const double scale = unit == "mm" ? calib::mm_from_metres(1.0) : 1.0;
    const double std = result.uncertainty ? result.uncertainty->artefact_std[index] : kUnknown;
    const bool identified = !parameter.std || std < (1.0 - kIdentifiedFall) * *parameter.std;
    const bool estimated = result.artefact_errors.size() > index;
    list.push_back({{"name", parameter.name},
                    {"unit", unit},
                    {"nominal", scale * parameter.nominal},
                    {"value", estimated ? number(scale * (parameter.nominal + result.artefact_errors[index]))
                                        : Json(nullptr)},
                    {"std_uncertainty", number(scale * std)},
                    {"status", identified ? "identified" : "prior"}});
  }
  return list;
}

Json correlations_json(const calib::IdentificationResult& result) {
  Json list = Json::array();
  if (!result.uncertainty) return list;
  for (const calib::Correlation& correlation : result.uncertainty->correlations) {
    list.push_back({{"first", arm_parameter_name(correlation.first)},
                    {"second", arm_parameter_name(correlation.second)},
                    {"coefficient", number(correlation.coefficient)}});
  }
  return list;
}

Json stiffness_json(const calib::IdentificationOptions& options, const calib::IdentificationResult& result) {
  Json list = Json::array();
  for (int i = 0; options.stiffness && i < calib::kComplianceCount; ++i) {
    const int joint = calib::kCompliantJoints[static_cast<std::size_t>(i)];
    const double compliance = result.calibrated.compliance_rad_per_nm[static_cast<std::size_t>(joint)];
    list.push_back({{"joint", joint + 1},
                    {"compliance_rad_per_nm", number(compliance)},
                    {"std_uncertainty", number(std_of(result, calib::kErrorParameterCount + i))}});
  }
  return list;
}

}  // namespace cell
