#include "calib_core/estimation/input_check.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/scaled_cholesky.hpp"

namespace calib {
namespace {

/// Two planes closer than this are one (metres; also the difference of the normals).
constexpr double kSamePlane = 1e-4;

/// Postures whose joints differ by less are the same (radians).
constexpr double kSamePostureRadians = 1e-4;

/// No error is this large (metres, radians, degrees, rad/Nm): a parameter with this standard deviation is
/// unconstrained.
constexpr double kUnconstrainedStd = 1.0;

std::string unknown_name(const IdentificationProblem& problem, const LeastSquares& fit,
                         Eigen::Index unknown) {
  if (unknown >= fit.arm_count()) {
    return problem.artefact.parameters[static_cast<std::size_t>(unknown - fit.arm_count())].name;
  }
  const int column = fit.arm_columns()[static_cast<std::size_t>(unknown)];
  return arm_parameter_name(column);
}

std::string touch_name(std::size_t index) { return "touch " + std::to_string(index + 1); }

std::string millimetres(double m) {
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << mm_from_metres(m) << " mm";
  return text.str();
}

std::optional<InputRefusal> bad(std::string message) {
  return InputRefusal{IdentificationStatus::kBadInput, std::move(message)};
}

/// Of what is not flat.
std::string round_shape(const ContactSurface& surface) { return surface.is_bore() ? "bore" : "sphere"; }

std::optional<InputRefusal> bad_deviation(const IdentificationProblem& problem, std::size_t index) {
  const double deviation_m = problem.touches[index].deviation_m;
  if (deviation_m == 0.0) return std::nullopt;
  if (!(deviation_m >= kTouchDeviationMinMetres && deviation_m <= kTouchDeviationMaxMetres)) {
    std::ostringstream value;
    value << mm_from_metres(deviation_m);
    return bad("the standard deviation of " + touch_name(index) + " is " + value.str() +
               " mm; give one of 1 nm or more and up to " + millimetres(kTouchDeviationMaxMetres) +
               ", or none");
  }
  if (problem.touch_noise_m == 0.0) {
    return bad(touch_name(index) +
               " has a standard deviation of its own, which can only be weighed against a known noise of the "
               "other touches; give touch_noise_mm");
  }
  return std::nullopt;
}

std::optional<InputRefusal> bad_touch(const IdentificationProblem& problem, Formulation formulation) {
  const auto& planes = problem.artefact.contact_planes;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const Touch& touch = problem.touches[i];
    if (!touch.joints.allFinite()) {
      return bad(touch_name(i) + " has a joint that is not a finite number; remove it");
    }
    const auto face = static_cast<std::size_t>(touch.face);
    if (touch.face < 0 || face >= planes.size()) {
      return bad(touch_name(i) + " is on plane " + std::to_string(touch.face + 1) + ", but there are " +
                 std::to_string(planes.size()) + " planes");
    }
    if (auto refusal = bad_deviation(problem, i)) return refusal;
    if (!planes[face].is_flat() && formulation == Formulation::kPlaneCoefficients) {
      return bad(face_name(face) + " is a " + round_shape(planes[face]) +
                 ", which has no plane coefficients (eq. 6); use the formulation "
                 "signed_distance, or leave its touches out");
    }
    if (planes[face].offset_m == 0.0 && formulation == Formulation::kPlaneCoefficients) {
      return bad(face_name(face) +
                 " goes through the origin, where eq. 6 has no form; use the formulation signed_distance");
    }
  }
  return std::nullopt;
}

std::optional<InputRefusal> bad_arm(const IdentificationProblem& problem) {
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (!std::isfinite(parameter_value(problem.nominal, i))) {
      return bad(error_parameters()[static_cast<std::size_t>(i)].name() +
                 " of the nominal arm is not a finite number");
    }
  }
  if (!problem.start.allFinite()) return bad("the errors to start from are not finite numbers");
  return std::nullopt;
}

/// How far two surfaces are apart when they are alike; nothing when they are not.
std::optional<double> apart_m(const ContactSurface& a, const ContactSurface& b) {
  if (a.is_sphere() != b.is_sphere() || a.is_bore() != b.is_bore()) return std::nullopt;
  const auto alike = [&] {
    if (a.is_flat()) return (a.outward - b.outward).norm() < kSamePlane;
    if (a.is_bore() && a.axis->cross(*b.axis).norm() >= kSamePlane) return false;
    return from_middle_m(a, *b.center_m).norm() < kSamePlane;
  };
  if (!alike()) return std::nullopt;
  return std::abs(a.is_flat() ? a.offset_m - b.offset_m : a.radius_m() - b.radius_m());
}

bool is_finite(const ContactSurface& surface) {
  return surface.outward.allFinite() && std::isfinite(surface.offset_m) &&
         (surface.is_flat() || surface.center_m->allFinite()) && (!surface.axis || surface.axis->allFinite());
}

std::optional<InputRefusal> bad_planes(const Artefact& artefact) {
  const std::vector<ContactSurface>& planes = artefact.contact_planes;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    if (!is_finite(planes[a])) {
      return bad(face_name(a) + " is not made of finite numbers");
    }
    if (planes[a].is_sphere() && !(planes[a].radius_m() > 0.0)) {
      return bad(face_name(a) + " is a sphere without a radius; give its radius");
    }
    if (planes[a].is_bore() && !(planes[a].radius_m() > 0.0)) {
      return bad(face_name(a) +
                 " is a bore that is no wider than the stylus ball; correct one of both radii");
    }
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      if (!artefact.may_be_mistaken(a, b)) break;
      const auto apart = apart_m(planes[a], planes[b]);
      if (apart && *apart < kSamePlane) {
        return InputRefusal{IdentificationStatus::kCoincidingPlanes, face_name(a) + " and " + face_name(b) +
                                                                         " coincide (" + millimetres(*apart) +
                                                                         " apart); describe one flat once"};
      }
    }
  }
  return std::nullopt;
}

std::optional<InputRefusal> bad_prior(const IdentificationProblem& problem,
                                      const IdentificationOptions& options) {
  const auto singular = [](const std::string& name, double std) {
    std::ostringstream value;
    value << std;
    return InputRefusal{IdentificationStatus::kSingularPrior,
                        "the standard deviation of " + name + " is " + value.str() +
                            ", which makes the prior singular; give one over 0, or exclude the parameter"};
  };
  const auto unfit = [](const std::optional<double>& std) {
    return std && !(*std > 0.0 && std::isfinite(*std));
  };
  const auto& excluded = options.identifiability.excluded;
  for (std::size_t i = 0; i < problem.tolerances.size(); ++i) {
    // Without the prior a tolerance only bounds the unobserved errors: 0 means that there are none.
    const bool is_prior = options.prior && std::ranges::find(excluded, static_cast<int>(i)) == excluded.end();
    if (!is_prior && problem.tolerances[i] == 0.0) continue;
    if (unfit(problem.tolerances[i])) return singular(error_parameters()[i].name(), *problem.tolerances[i]);
  }
  for (std::size_t i = 0; i < problem.nongeometric_std.size(); ++i) {
    const auto& std = problem.nongeometric_std[i];
    if (unfit(std)) return singular(nongeometric_parameters()[i].name(), *std);
  }
  for (const auto& parameter : problem.artefact.parameters) {
    if (unfit(parameter.std)) return singular(parameter.name, *parameter.std);
  }
  for (std::size_t i = 0; i < problem.artefact.equations.size(); ++i) {
    const ArtefactEquation& equation = problem.artefact.equations[i];
    const std::string name = "length " + std::to_string(i + 1);
    if (unfit(equation.std_m)) return singular(name, equation.std_m);
    if (!std::isfinite(equation.value_m)) return bad(name + " is not a finite number");
  }
  return std::nullopt;
}

/// The nearest other plane at the same place and its distance.
std::pair<std::size_t, double> nearest_other(const Artefact& artefact, std::size_t own,
                                             const Eigen::Vector3d& tip) {
  std::pair<std::size_t, double> nearest{own, std::numeric_limits<double>::infinity()};
  for (std::size_t face = 0; face < artefact.contact_planes.size(); ++face) {
    if (!artefact.may_be_mistaken(face, own)) continue;
    const double distance = std::abs(signed_distance_m(artefact.contact_planes[face], tip));
    if (face != own && distance < nearest.second) nearest = {face, distance};
  }
  return nearest;
}

/// A distribution of the missing touches: each on the face that then has the fewest.
std::string missing_on_faces(std::vector<int> have, int missing) {
  std::vector<int> add(have.size(), 0);
  for (int i = 0; i < missing; ++i) {
    const auto fewest = static_cast<std::size_t>(std::ranges::min_element(have) - have.begin());
    ++have[fewest];
    ++add[fewest];
  }
  std::string text;
  for (std::size_t face = 0; face < add.size(); ++face) {
    if (add[face] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(add[face]) + " on " + face_name(face);
  }
  return text;
}

bool all_one_posture(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted) {
  return std::ranges::all_of(fitted, [&](std::size_t index) {
    const JointVector difference = problem.touches[index].joints - problem.touches[fitted[0]].joints;
    return difference.lpNorm<Eigen::Infinity>() < kSamePostureRadians;
  });
}

/// Whether the centre of this sphere or the axis of this bore is found by the touches alone.
bool has_free_center(const Artefact& artefact, std::size_t face) {
  return std::ranges::any_of(artefact.parameters, [&](const ArtefactParameter& parameter) {
    return is_free_round_place(parameter) && !parameter.shifts[face].center.isZero(0.0);
  });
}

/// The directions from which a sphere was touched, root mean square along the axis that they show least: 0
/// when all lie in a plane through the centre. Of a bore, likewise across its axis: 0 when all lie on one
/// line through it.
double shown_least(const IdentificationProblem& problem, const PreparedModel& start, std::size_t face,
                   const std::vector<std::size_t>& touches) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::size_t index : touches) {
    const Eigen::Vector3d normal =
        normal_at(problem.artefact.contact_planes[face],
                  forward_chain(start, problem.touches[index].joints).block_from_frame.back());
    moments += normal * normal.transpose() / static_cast<double>(touches.size());
  }
  const auto values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues();
  // Along the axis of a bore nothing is shown: that is the least, and not wanted.
  return std::sqrt(std::max(0.0, values[problem.artefact.contact_planes[face].is_bore() ? 1 : 0]));
}

}  // namespace

std::optional<InputRefusal> find_invalid_input(const IdentificationProblem& problem,
                                               const IdentificationOptions& options) {
  if (auto refusal = bad_arm(problem)) return refusal;
  if (auto refusal = bad_planes(problem.artefact)) return refusal;
  if (auto refusal = bad_touch(problem, options.formulation)) return refusal;
  if (!std::isfinite(problem.touch_noise_m) || problem.touch_noise_m < 0.0) {
    return bad("the noise of a touch is not a length; give its standard deviation");
  }
  if (options.stiffness && estimable_compliances(problem.nongeometric_std).empty()) {
    return bad(
        "the compliance cannot be estimated: none of joints 1 to 3 has a standard deviation of it; give the "
        "arm's file \"gravity\" with masses and std_compliance_rad_per_nm, or identify without stiffness");
  }
  if (has_priors(problem, options) && problem.touch_noise_m == 0.0) {
    return bad(
        "what is known with an uncertainty can only be weighed against a known noise of a touch; "
        "give touch_noise_mm");
  }
  if (problem.columns) {
    const std::vector<int>& columns = *problem.columns;
    const bool in_order = std::ranges::adjacent_find(columns, std::ranges::greater_equal{}) == columns.end();
    if (!in_order || (!columns.empty() && (columns.front() < 0 || columns.back() >= kErrorParameterCount))) {
      return bad("the columns that were chosen before are no ascending list of error parameters");
    }
  }
  return bad_prior(problem, options);
}

SortedTouches sort_touches(const IdentificationProblem& problem, const IdentificationOptions& options) {
  SortedTouches sorted;
  const KinematicModel start = apply(problem.nominal, problem.start);
  const auto& planes = problem.artefact.contact_planes;
  const Eigen::VectorXd distances = signed_distances_m(start, planes, problem.touches);
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const Touch& touch = problem.touches[i];
    if (touch.role == TouchRole::kProof) continue;
    const auto own = static_cast<std::size_t>(touch.face);
    const double distance = distances[static_cast<Eigen::Index>(i)];
    if (std::abs(distance) <= kFarOffMetres) {
      if (touch.role == TouchRole::kFit) sorted.fitted.push_back(i);
      continue;
    }
    const Eigen::Vector3d ball_m = ball_at_m(planes[own], forward_kinematics(start, touch.joints));
    const auto [other, other_distance] = nearest_other(problem.artefact, own, ball_m);
    if (options.robust && other_distance <= kOnOtherPlaneMetres) {
      sorted.wrong_face.push_back({i, distance, RejectionReason::kWrongFace});
      continue;
    }
    const std::string nearest = other == own ? ""
                                             : ", and " + millimetres(other_distance) +
                                                   " off the nearest other one, " + face_name(other);
    sorted.refusal =
        InputRefusal{IdentificationStatus::kFarTouch,
                     touch_name(i) + " is " + millimetres(std::abs(distance)) + " off its " + face_name(own) +
                         nearest + " (by the nominal arm); correct its plane or joints, or remove it"};
    return sorted;
  }
  return sorted;
}

std::optional<InputRefusal> find_insufficient_data(const IdentificationProblem& problem,
                                                   const std::vector<std::size_t>& fitted, int needed) {
  std::vector<int> on_face(problem.artefact.contact_planes.size(), 0);
  for (const std::size_t index : fitted) {
    ++on_face[static_cast<std::size_t>(problem.touches[index].face)];
  }
  const auto have = static_cast<int>(fitted.size());
  const auto faces = std::ranges::count_if(on_face, [](int count) { return count > 0; });
  if (have < needed) {
    return InputRefusal{IdentificationStatus::kTooFewTouches,
                        std::to_string(have) + " touches, but " + std::to_string(needed) +
                            " parameters need at least " + std::to_string(needed) + ": " +
                            std::to_string(needed - have) + " more are missing (" +
                            missing_on_faces(on_face, needed - have) + ")"};
  }
  if (have > 1 && all_one_posture(problem, fitted)) {
    return InputRefusal{
        IdentificationStatus::kOnePosture,
        "all " + std::to_string(have) +
            " touches are one posture; spread them over the faces and over postures and tilts"};
  }
  if (faces == 1 && on_face.size() > 1) {
    const auto only = std::ranges::find_if(on_face, [](int count) { return count > 0; });
    return InputRefusal{IdentificationStatus::kOneFace,
                        "all " + std::to_string(have) + " touches are on " +
                            face_name(static_cast<std::size_t>(only - on_face.begin())) +
                            "; one plane does not fix an arm, touch the others too"};
  }
  return std::nullopt;
}

std::optional<InputRefusal> find_one_sided_face(const IdentificationProblem& problem,
                                                const std::vector<std::size_t>& fitted) {
  const PreparedModel start = prepare(apply(problem.nominal, problem.start));
  for (std::size_t face = 0; face < problem.artefact.contact_planes.size(); ++face) {
    if (!has_free_center(problem.artefact, face)) continue;
    std::vector<std::size_t> touches;
    std::ranges::copy_if(fitted, std::back_inserter(touches), [&](std::size_t index) {
      return static_cast<std::size_t>(problem.touches[index].face) == face;
    });
    if (touches.empty()) continue;  // find_unconstrained() names it
    const double shown = shown_least(problem, start, face, touches);
    if (shown >= kSphereSidesMin) continue;
    const bool is_bore = problem.artefact.contact_planes[face].is_bore();
    std::ostringstream angle;
    angle << std::lround(degrees_from_radians(std::asin(std::min(1.0, shown))));
    return InputRefusal{IdentificationStatus::kUnobservable,
                        "the " + std::to_string(touches.size()) + " touches on " + face_name(face) + ", a " +
                            round_shape(problem.artefact.contact_planes[face]) + ", are " +
                            (is_bore ? "on one side of it only (" : "from one side only (") + angle.str() +
                            " degrees about their middle in one direction, " +
                            std::to_string(std::lround(degrees_from_radians(std::asin(kSphereSidesMin)))) +
                            " are needed), so that its " + (is_bore ? "axis" : "centre") +
                            " cannot be told from the arm; touch it " + (is_bore ? "on" : "from") +
                            " other sides, or give /faces/" + std::to_string(face) +
                            "/place \"known\" with " + (is_bore ? "std_axis_mm" : "std_center_mm") +
                            " in the block's file"};
  }
  return std::nullopt;
}

std::optional<InputRefusal> find_unconstrained(const IdentificationProblem& problem,
                                               const IdentificationOptions& options, LeastSquares& fit,
                                               const Estimate& estimate) {
  const Eigen::VectorXd precision = prior_precision(problem, fit.arm_columns(), options.prior);
  std::vector<Eigen::Index> without_prior;
  for (Eigen::Index k = 0; k < precision.size(); ++k) {
    const bool chosen = !options.prior && k < fit.arm_count() &&
                        fit.arm_columns()[static_cast<std::size_t>(k)] < kErrorParameterCount;
    if (precision[k] == 0.0 && !chosen) without_prior.push_back(k);
  }
  if (without_prior.empty()) return std::nullopt;

  // A very wide prior makes the problem solvable; unknowns that keep its width are unconstrained.
  fit.linearise(estimate);
  Eigen::MatrixXd information = fit.information();
  for (const Eigen::Index k : without_prior)
    information(k, k) += 1.0 / (kUnconstrainedStd * kUnconstrainedStd);
  const ScaledCholesky cholesky(information);
  if (!cholesky.is_positive_definite()) return std::nullopt;  // reported by the iteration
  std::string names;
  for (const Eigen::Index k : without_prior) {
    if (cholesky.inverse_diagonal_root(k) < 0.5 * kUnconstrainedStd) continue;
    names += (names.empty() ? "" : ", ") + unknown_name(problem, fit, k);
  }
  if (names.empty()) return std::nullopt;
  return InputRefusal{
      options.prior ? IdentificationStatus::kSingularPrior : IdentificationStatus::kUnobservable,
      "neither a standard deviation nor any of the " + std::to_string(fit.touches().size()) +
          " touches constrains " + names +
          "; give a standard deviation, touch faces that depend on it, or exclude it"};
}

}  // namespace calib
