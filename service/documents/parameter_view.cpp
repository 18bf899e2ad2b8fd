#include "service/documents/parameter_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/place_group.hpp"
#include "service/documents/figures.hpp"
#include "service/run/verdict.hpp"

namespace cell {
namespace {

/// An artefact parameter is identified if the touches reduced its prior deviation by this share.
constexpr double kIdentifiedFall = 0.1;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // shown as null

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
CarriedError carried_error(int named, int from, int to, double factor_si) {
  return {.name = parameter_at(named).name(), .factor = finite(shown(to, factor_si) / shown(from, 1.0))};
}

const char* unit_name(calib::ArtefactKind kind) {
  switch (kind) {
    case calib::ArtefactKind::kFaceTilt:
    case calib::ArtefactKind::kBoreTilt:
    case calib::ArtefactKind::kPlaceTurn:
      return "rad";
    case calib::ArtefactKind::kTemperature:
      return "degC";
    case calib::ArtefactKind::kFaceOffset:
    case calib::ArtefactKind::kSphereCenter:
    case calib::ArtefactKind::kSphereRadius:
    case calib::ArtefactKind::kBoreAxis:
    case calib::ArtefactKind::kBoreRadius:
    case calib::ArtefactKind::kStylusRadius:
    case calib::ArtefactKind::kPretravel:
    case calib::ArtefactKind::kPlaceShift:
    case calib::ArtefactKind::kTipCenter:
      return "mm";
  }
  return "";
}

/// Shown units of an artefact parameter in one SI unit of it.
double shown_scale(calib::ArtefactKind kind) {
  return std::string_view(unit_name(kind)) == "mm" ? calib::mm_from_metres(1.0) : 1.0;
}

/// By how many shown units one shown unit of error `from` adds to parameters of the artefact, which carry it
/// along with the other errors: a face that is found in place and cannot be told from the place of the arm.
std::vector<CarriedError> carried_by_artefact(const calib::Artefact& artefact, int from,
                                              const calib::CandidateStatus& candidate) {
  const std::vector<int> leading = calib::parameters_without_prior(artefact);
  std::vector<CarriedError> list;
  for (const auto& [position, factor_si] : candidate.grouped_with_leading) {
    const auto index = static_cast<std::size_t>(leading[static_cast<std::size_t>(position)]);
    const calib::ArtefactParameter& parameter = artefact.parameters[index];
    list.push_back({.name = parameter.name,
                    .factor = finite(shown_scale(parameter.kind) * factor_si / shown(from, 1.0))});
  }
  return list;
}

/// Which grouped errors each candidate carries: the transpose of grouped_with.
std::array<std::vector<CarriedError>, calib::kErrorParameterCount> carried(
    const calib::IdentifiableSet& identifiable) {
  std::array<std::vector<CarriedError>, calib::kErrorParameterCount> stands_for;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    for (const auto& [other, factor] : identifiable.candidates[static_cast<std::size_t>(i)].grouped_with)
      stands_for[static_cast<std::size_t>(other)].push_back(carried_error(i, i, other, factor));
  }
  return stands_for;
}

/// One standard deviation of an estimated arm parameter, SI.
std::optional<double> std_of(const calib::IdentificationResult& result, int index) {
  if (!result.uncertainty) return std::nullopt;
  return result.uncertainty->std_error(index);
}

std::optional<std::array<std::optional<double>, 2>> interval_of(int index, double error,
                                                                std::optional<double> std,
                                                                const calib::UncertaintyBudget* uncertainty) {
  if (!std || !uncertainty) return std::nullopt;
  const double variance = std::pow(uncertainty->std_error(index), 2);
  const double half = *std * uncertainty->coverage_factor_of(variance, uncertainty->of_noise(index, index));
  return std::array{finite(shown(index, error - half)), finite(shown(index, error + half))};
}

/// A candidate without its estimate.
Parameter identity_of(const calib::KinematicModel& nominal, int index) {
  const calib::ErrorParameter& parameter = parameter_at(index);
  Parameter identity;
  identity.name = parameter.name();
  identity.frame = parameter.frame;
  identity.kind = identity.name.substr(0, identity.name.size() - 1);
  identity.group = group_name(calib::group_on(nominal, index));
  identity.unit = parameter.is_length() ? "mm" : "rad";
  identity.nominal = finite(shown(index, calib::parameter_value(nominal, index)));
  return identity;
}

/// Whether the touches improved on the standard deviation that was given.
bool is_improved(double std, const std::optional<double>& given) {
  return !given || std < (1.0 - kIdentifiedFall) * *given;
}

/// Value of a parameter beside rigid kinematics in the model; of a mass its change as a share of the nominal.
double value_of(const calib::IdentificationResult& result, int position) {
  const calib::NongeometricParameter& parameter =
      calib::nongeometric_parameters()[static_cast<std::size_t>(position)];
  const auto joint = static_cast<std::size_t>(parameter.number - 1);
  switch (parameter.kind) {
    case calib::NongeometricKind::kCompliance:
      return result.calibrated.compliance_rad_per_nm[joint];
    case calib::NongeometricKind::kHarmonicCos:
      return result.calibrated.harmonics_rad[joint].cos;
    case calib::NongeometricKind::kHarmonicSin:
      return result.calibrated.harmonics_rad[joint].sin;
    case calib::NongeometricKind::kMass:
      return result.errors[calib::nongeometric_index(position)];
    case calib::NongeometricKind::kSecondCos:
      return result.calibrated.second_harmonics_rad[joint].cos;
    case calib::NongeometricKind::kSecondSin:
      return result.calibrated.second_harmonics_rad[joint].sin;
    case calib::NongeometricKind::kRippleCos:
      return result.calibrated.ripples_rad[joint].cos;
    case calib::NongeometricKind::kRippleSin:
      return result.calibrated.ripples_rad[joint].sin;
  }
  throw std::logic_error("value_of: no such kind");
}

}  // namespace

double shown(int index, double value) {
  return parameter_at(index).is_length() ? calib::mm_from_metres(value) : value;
}

std::vector<Parameter> parameters_of(const calib::IdentificationProblem& problem,
                                     const calib::IdentificationOptions& options,
                                     const calib::IdentificationResult& result) {
  const auto stands_for = carried(result.identifiable);
  std::vector<Parameter> parameters;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const calib::CandidateStatus& candidate = result.identifiable.candidates[index];
    const bool estimated = is_estimated(options, result.identifiable, i);
    const auto std = estimated ? std_of(result, i) : std::nullopt;
    Parameter& parameter = parameters.emplace_back(identity_of(problem.nominal, i));
    for (const auto& [other, factor] : candidate.grouped_with) {
      if (!estimated) parameter.grouped_with.push_back(carried_error(other, i, other, factor));
    }
    if (!estimated) {
      std::ranges::copy(carried_by_artefact(problem.artefact, i, candidate),
                        std::back_inserter(parameter.grouped_with));
    }
    parameter.status = estimated ? calib::ParameterStatus::kIdentified : candidate.status;
    if (estimated) parameter.error = finite(shown(i, result.errors[i]));
    if (std) parameter.std_uncertainty = finite(shown(i, *std));
    parameter.interval95 =
        interval_of(i, result.errors[i], std, result.uncertainty ? &*result.uncertainty : nullptr);
    if (!options.prior) parameter.stands_for = stands_for[index];
  }
  return parameters;
}

std::vector<ArtefactParameter> artefact_parameters_of(const calib::IdentificationProblem& problem,
                                                      const calib::IdentificationResult& result) {
  std::vector<ArtefactParameter> list;
  // Of an offset its certificate may say more than its own deviation: that is no work of the touches.
  const Eigen::MatrixXd given = calib::prior_covariance(problem.artefact);
  for (std::size_t i = 0; i < problem.artefact.parameters.size(); ++i) {
    const calib::ArtefactParameter& parameter = problem.artefact.parameters[i];
    const auto index = static_cast<Eigen::Index>(i);
    const double scale = shown_scale(parameter.kind);
    const double std = result.uncertainty ? result.uncertainty->artefact_std[index] : kUnknown;
    const bool identified = !parameter.std || is_improved(std, std::sqrt(given(index, index)));
    const bool estimated = result.artefact_errors.size() > index;
    ArtefactParameter& shown_as = list.emplace_back();
    shown_as.name = parameter.name;
    shown_as.unit = unit_name(parameter.kind);
    shown_as.nominal = finite(scale * parameter.nominal);
    if (estimated) shown_as.value = finite(scale * (parameter.nominal + result.artefact_errors[index]));
    shown_as.std_uncertainty = finite(scale * std);
    shown_as.status = identified ? ArtefactStatus::kIdentified : ArtefactStatus::kPrior;
  }
  return list;
}

std::vector<CorrelationOfErrors> correlations_of(const calib::IdentificationResult& result) {
  std::vector<CorrelationOfErrors> list;
  if (!result.uncertainty) return list;
  for (const calib::Correlation& correlation : result.uncertainty->correlations) {
    list.push_back({.first = calib::arm_parameter_name(correlation.first),
                    .second = calib::arm_parameter_name(correlation.second),
                    .coefficient = finite(correlation.coefficient)});
  }
  return list;
}

std::vector<NongeometricParameter> nongeometric_parameters_of(const calib::IdentificationProblem& problem,
                                                              const calib::IdentificationResult& result) {
  std::vector<NongeometricParameter> list;
  for (const int position : result.nongeometric) {
    const auto index = static_cast<std::size_t>(position);
    const calib::NongeometricParameter& parameter = calib::nongeometric_parameters()[index];
    const double std = std_of(result, calib::nongeometric_index(position)).value_or(kUnknown);
    list.push_back({.name = parameter.name(),
                    .unit = parameter.unit(),
                    .value = finite(value_of(result, position)),
                    .std_uncertainty = finite(std),
                    .status = is_improved(std, problem.nongeometric_std[index]) ? ArtefactStatus::kIdentified
                                                                                : ArtefactStatus::kPrior});
  }
  return list;
}

std::vector<JointCompliance> stiffness_of(const std::vector<NongeometricParameter>& parameters,
                                          const calib::IdentificationResult& result) {
  std::vector<JointCompliance> list;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const calib::NongeometricParameter& parameter =
        calib::nongeometric_parameters()[static_cast<std::size_t>(result.nongeometric[i])];
    if (parameter.kind != calib::NongeometricKind::kCompliance) continue;
    list.push_back({.joint = parameter.number,
                    .compliance_rad_per_nm = parameters[i].value,
                    .std_uncertainty = parameters[i].std_uncertainty});
  }
  return list;
}

}  // namespace cell
