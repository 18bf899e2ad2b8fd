#include "calib_core/identify.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "calib_core/quasi_random.hpp"

namespace calib {
namespace {

std::vector<Touch> touches_with_role(const std::vector<Touch>& touches, TouchRole role) {
  std::vector<Touch> chosen;
  std::ranges::copy_if(touches, std::back_inserter(chosen), [&](const Touch& t) { return t.role == role; });
  return chosen;
}

std::string plane_name(std::size_t face) { return "plane " + std::to_string(face + 1); }

/// What makes the problem unfit for computing at all, or nothing.
std::optional<std::string> find_bad_input(const IdentificationProblem& problem, Formulation formulation) {
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const Touch& touch = problem.touches[i];
    const std::string which = "touch " + std::to_string(i + 1);
    if (!touch.joints.allFinite()) return which + " has a joint that is not a finite number; remove it";
    if (touch.face < 0 || static_cast<std::size_t>(touch.face) >= problem.contact_planes.size()) {
      return which + " is on " + plane_name(static_cast<std::size_t>(touch.face)) + ", but there are only " +
             std::to_string(problem.contact_planes.size()) + " planes";
    }
    const bool through_origin = problem.contact_planes[static_cast<std::size_t>(touch.face)].offset_m == 0.0;
    if (through_origin && formulation == Formulation::kPlaneCoefficients) {
      return plane_name(static_cast<std::size_t>(touch.face)) +
             " goes through the origin, where eq. 6 has no form; use the formulation signed_distance";
    }
  }
  return std::nullopt;
}

/// Where the missing touches are best made: each on the plane that then has the fewest.
std::string missing_on_planes(const std::vector<Touch>& fitted, std::size_t plane_count, int missing) {
  std::vector<int> have(plane_count, 0), add(plane_count, 0);
  for (const Touch& touch : fitted) ++have[static_cast<std::size_t>(touch.face)];
  for (int i = 0; i < missing; ++i) {
    const auto fewest = static_cast<std::size_t>(std::ranges::min_element(have) - have.begin());
    ++have[fewest];
    ++add[fewest];
  }
  std::string text;
  for (std::size_t face = 0; face < plane_count; ++face) {
    if (add[face] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(add[face]) + " on " + plane_name(face);
  }
  return text;
}

std::string too_few_message(const std::vector<Touch>& fitted, std::size_t plane_count, int needed) {
  const int have = static_cast<int>(fitted.size());
  return std::to_string(have) + " touches, but " + std::to_string(needed) + " parameters need at least " +
         std::to_string(needed) + ": " + std::to_string(needed - have) + " more are missing (" +
         missing_on_planes(fitted, plane_count, needed - have) + ")";
}

std::string unobservable_message(const std::vector<Touch>& fitted, std::size_t plane_count, int shown,
                                 int needed) {
  std::string bare;
  for (std::size_t face = 0; face < plane_count; ++face) {
    const bool touched = std::ranges::any_of(
        fitted, [&](const Touch& touch) { return static_cast<std::size_t>(touch.face) == face; });
    if (!touched) bare += (bare.empty() ? "" : ", ") + plane_name(face);
  }
  return "the touches show " + std::to_string(shown) + " of the " + std::to_string(needed) +
         " parameters that this cell can show: " +
         (bare.empty() ? "they are too alike; spread them over the faces and over postures and tilts"
                       : "there is none on " + bare + "; touch it too");
}

struct Solution {
  Eigen::VectorXd step;
  double condition_number = 0.0;
  double scaled_condition_number = 0.0;
};

/// Eq. 15 with columns of unit norm: the step of the identifiable errors.
Solution solve_step(const Observation& observation, const std::vector<int>& columns) {
  const Eigen::MatrixXd identifiable = select_columns(observation.matrix, columns);
  const Eigen::VectorXd scale = identifiable.colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = identifiable * scale.asDiagonal();
  return {scale.asDiagonal() * scaled.householderQr().solve(observation.output_error).eval(),
          condition_number(identifiable), condition_number(scaled)};
}

double rms(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.norm() / std::sqrt(static_cast<double>(values.size()));
}

/// Iterates eq. 15 from the nominal model; fills iterations, errors, calibrated and status.
void iterate(const IdentificationProblem& problem, const IdentificationOptions& options,
             const std::vector<Touch>& fitted, IdentificationResult& result) {
  result.status = IdentificationStatus::kNotConverged;
  for (int i = 0; i < options.iterations_max; ++i) {
    const Observation observation =
        observe(result.calibrated, problem.contact_planes, fitted, options.formulation);
    const Solution solution = solve_step(observation, result.identifiable.columns);
    if (!solution.step.allFinite()) {
      result.message = "the iteration left the finite numbers at step " + std::to_string(i + 1) +
                       "; a touch may be far off its plane";
      return;
    }
    const double residual_rms = rms(signed_distances_m(result.calibrated, problem.contact_planes, fitted));
    result.iterations.push_back(
        {solution.condition_number, solution.scaled_condition_number, residual_rms, solution.step.norm()});
    for (std::size_t k = 0; k < result.identifiable.columns.size(); ++k) {
      result.errors[result.identifiable.columns[k]] += solution.step[static_cast<Eigen::Index>(k)];
    }
    result.calibrated = apply(problem.nominal, result.errors);
    if (solution.step.norm() < kStepNormConverged) {
      result.status = IdentificationStatus::kConverged;
      return;
    }
  }
  std::ostringstream last_step;
  last_step << result.iterations.back().step_norm;
  result.message = "no convergence in " + std::to_string(options.iterations_max) + " iterations (last step " +
                   last_step.str() + "); look for touches on the wrong plane";
}

std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const KinematicModel& calibrated) {
  std::vector<FaceDistances> all;
  for (const TouchRole role : {TouchRole::kFit, TouchRole::kHeldOut, TouchRole::kProof}) {
    for (std::size_t face = 0; face < problem.contact_planes.size(); ++face) {
      std::vector<Touch> here;
      std::ranges::copy_if(problem.touches, std::back_inserter(here), [&](const Touch& touch) {
        return touch.role == role && static_cast<std::size_t>(touch.face) == face;
      });
      if (here.empty()) continue;
      const Eigen::VectorXd nominal = signed_distances_m(problem.nominal, problem.contact_planes, here);
      const Eigen::VectorXd after = signed_distances_m(calibrated, problem.contact_planes, here);
      all.push_back({static_cast<int>(face), role, static_cast<int>(here.size()), nominal.mean(),
                     rms(nominal), after.mean(), rms(after)});
    }
  }
  return all;
}

Eigen::MatrixXd nominal_observation_matrix(const KinematicModel& nominal, const std::vector<Plane>& planes,
                                           std::vector<Touch> touches, Formulation formulation) {
  for (Touch& touch : touches) {
    touch = moved_onto_plane(nominal, planes[static_cast<std::size_t>(touch.face)], touch);
  }
  return observe(nominal, planes, touches, formulation).matrix;
}

}  // namespace

IdentifiableSet attainable_parameters(const KinematicModel& nominal, const std::vector<Plane>& contact_planes,
                                      const IdentifiabilityOptions& options) {
  constexpr int kTouchesPerFace = 24;
  const JointVector widest = JointVector::Constant(0.7 * std::numbers::pi);
  std::vector<Touch> touches;
  int index = 0;
  for (std::size_t face = 0; face < contact_planes.size(); ++face) {
    for (int k = 0; k < kTouchesPerFace; ++k) {
      touches.push_back(
          {.face = static_cast<int>(face), .joints = halton_posture(++index, {-widest, widest})});
    }
  }
  return choose_identifiable(
      nominal_observation_matrix(nominal, contact_planes, std::move(touches), Formulation::kSignedDistance),
      options);
}

IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options) {
  IdentificationResult result;
  result.calibrated = problem.nominal;
  if (const auto bad = find_bad_input(problem, options.formulation)) {
    result.status = IdentificationStatus::kBadInput;
    result.message = *bad;
    return result;
  }
  const std::vector<Touch> fitted = touches_with_role(problem.touches, TouchRole::kFit);
  result.fitted_touch_count = static_cast<int>(fitted.size());
  // A given tolerance drops parameters on purpose: it does not count as something the touches fail to show.
  IdentifiabilityOptions without_tolerance = options.identifiability;
  without_tolerance.qr_tolerance.reset();
  result.attainable_count = static_cast<int>(
      attainable_parameters(problem.nominal, problem.contact_planes, without_tolerance).columns.size());
  result.identifiable = choose_identifiable(
      nominal_observation_matrix(problem.nominal, problem.contact_planes, fitted, options.formulation),
      options.identifiability);

  const int shown = static_cast<int>(result.identifiable.columns.size());
  if (result.fitted_touch_count < result.attainable_count) {
    result.status = IdentificationStatus::kTooFewTouches;
    result.message = too_few_message(fitted, problem.contact_planes.size(), result.attainable_count);
    return result;
  }
  const int weak =
      static_cast<int>(std::ranges::count_if(result.identifiable.candidates, [](const auto& candidate) {
        return candidate.status == ParameterStatus::kWeak;
      }));
  if (shown + weak < result.attainable_count) {
    result.status = IdentificationStatus::kUnobservable;
    result.message =
        unobservable_message(fitted, problem.contact_planes.size(), shown, result.attainable_count);
    return result;
  }

  const Eigen::VectorXd sigma =
      singular_values(observe(problem.nominal, problem.contact_planes, fitted, options.formulation).matrix);
  result.singular_values.assign(sigma.begin(), sigma.begin() + std::min<Eigen::Index>(shown, sigma.size()));
  iterate(problem, options, fitted, result);
  result.distances = face_distances(problem, result.calibrated);
  const int freedom = result.fitted_touch_count - shown;
  if (freedom > 0 && !result.iterations.empty()) {
    const Eigen::VectorXd residuals = signed_distances_m(result.calibrated, problem.contact_planes, fitted);
    result.noise_estimated_m = residuals.norm() / std::sqrt(static_cast<double>(freedom));
  }
  return result;
}

}  // namespace calib
