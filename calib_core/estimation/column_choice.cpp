#include "calib_core/estimation/column_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/halton.hpp"

namespace calib {
namespace {

/// Stylus directions within this angle of their mean do not separate the parameters. Tilts of up to 3 degrees
/// from the normal may be 4 degrees from the mean.
constexpr double kSimilarTiltsRadians = 5.0 * kRadiansPerDegree;

/// Rows and leading columns for choose_identifiable(): one row per touch, then one per certified length of an
/// estimated face, in the same unit (metres). A touch is weighed by its noise_factor().
struct ChoiceMatrix {
  Eigen::MatrixXd kinematic;
  Eigen::MatrixXd leading;
};

ChoiceMatrix choice_matrix(const KinematicModel& nominal, const Artefact& artefact,
                           std::vector<Touch> touches, double declared_noise_m, Formulation formulation) {
  touches = moved_onto_planes(nominal, artefact.contact_planes, std::move(touches));
  Observation observation = observe(nominal, artefact.contact_planes, touches, formulation);
  weigh_rows(observation, touches, declared_noise_m);
  const Eigen::MatrixXd rows = observation.matrix;
  const std::vector<int> free = parameters_without_prior(artefact);
  if (free.empty()) return {rows, {}};

  const auto touch_count = rows.rows();
  const auto equation_count = static_cast<Eigen::Index>(artefact.equations.size());
  ChoiceMatrix matrix{
      Eigen::MatrixXd::Zero(touch_count + equation_count, rows.cols()),
      Eigen::MatrixXd::Zero(touch_count + equation_count, static_cast<Eigen::Index>(free.size()))};
  matrix.kinematic.topRows(touch_count) = rows;
  for (Eigen::Index j = 0; j < matrix.leading.cols(); ++j) {
    const int parameter = free[static_cast<std::size_t>(j)];
    const auto& shifts = artefact.parameters[static_cast<std::size_t>(parameter)].shifts;
    for (Eigen::Index row = 0; row < touch_count; ++row) {
      const Touch& touch = touches[static_cast<std::size_t>(row)];
      const auto face = static_cast<std::size_t>(touch.face);
      const BallContact contact =
          contact_at(artefact.contact_planes[face], forward_kinematics(nominal, touch.joints));
      matrix.leading(row, j) = shifts[face].at(contact) / noise_factor(touch, declared_noise_m);
    }
    for (Eigen::Index e = 0; e < equation_count; ++e) {
      for (const auto& [index, weight] : artefact.equations[static_cast<std::size_t>(e)].weights) {
        if (index == parameter) matrix.leading(touch_count + e, j) = weight;
      }
    }
  }
  return matrix;
}

/// Whether the ball that touches this face is held where it is, as nothing shows its place: its touches show
/// nothing either.
bool is_of_held_tip(const Artefact& artefact, int face) {
  return std::ranges::any_of(artefact.parameters, [&](const ArtefactParameter& parameter) {
    return parameter.kind == ArtefactKind::kTipCenter && parameter.std &&
           !parameter.shifts[static_cast<std::size_t>(face)].ball.isZero(0.0);
  });
}

std::vector<Touch> well_distributed_touches(std::size_t face_count) {
  constexpr int kTouchesPerFace = 24;
  constexpr double kReach = 0.7 * std::numbers::pi;
  const JointRanges ranges{JointVector::Constant(-kReach), JointVector::Constant(kReach)};
  std::vector<Touch> touches;
  int index = 0;
  for (std::size_t face = 0; face < face_count; ++face) {
    for (int k = 0; k < kTouchesPerFace; ++k) {
      touches.push_back({.face = static_cast<int>(face), .joints = halton_posture(++index, ranges)});
    }
  }
  return touches;
}

/// |R_ii| below which the declared noise gives a parameter a standard deviation above weak_std().
WeakDiagonals weak_diagonals(const IdentificationProblem& problem, const std::vector<std::size_t>& touches,
                             Formulation formulation) {
  WeakDiagonals weak{};
  double noise = problem.touch_noise_m;
  if (formulation == Formulation::kPlaneCoefficients && !touches.empty()) {
    double squares = 0.0;
    for (const std::size_t touch : touches) {
      const auto face = static_cast<std::size_t>(problem.touches[touch].face);
      squares += 1.0 / std::pow(problem.artefact.contact_planes[face].offset_m, 2);
    }
    noise *= std::sqrt(squares / static_cast<double>(touches.size()));
  }
  for (std::size_t i = 0; i < weak.size(); ++i) {
    weak[i] = noise / weak_std(error_parameters()[i]);
  }
  return weak;
}

std::vector<Touch> pick(const std::vector<Touch>& all, const std::vector<std::size_t>& indices) {
  std::vector<Touch> picked;
  for (const std::size_t index : indices) picked.push_back(all[index]);
  return picked;
}

std::string whole_degrees(double rad) {
  return std::to_string(static_cast<int>(std::ceil(degrees_from_radians(rad) - 1e-9)));
}

}  // namespace

double weak_std(const ErrorParameter& parameter) {
  return parameter.is_length() ? kWeakLengthMetres : kWeakAngleRadians;
}

IdentifiableSet attainable_set(const KinematicModel& nominal, const Artefact& artefact,
                               const IdentifiabilityOptions& options) {
  std::vector<Touch> touches = well_distributed_touches(artefact.contact_planes.size());
  std::erase_if(touches, [&](const Touch& touch) { return is_of_held_tip(artefact, touch.face); });
  const ChoiceMatrix matrix =
      choice_matrix(nominal, artefact, std::move(touches), 0.0, Formulation::kSignedDistance);
  return choose_identifiable(matrix.kinematic, options, {}, matrix.leading);
}

Attainable attainable_parameters(const IdentificationProblem& problem,
                                 const IdentifiabilityOptions& options) {
  // A given tolerance excludes parameters deliberately: these do not count as missing.
  IdentifiabilityOptions without_tolerance = options;
  without_tolerance.qr_tolerance.reset();
  const auto count = [&](const KinematicModel& arm) {
    return static_cast<int>(attainable_set(arm, problem.artefact, without_tolerance).columns.size());
  };
  KinematicModel off_axis = problem.nominal;
  off_axis.links.back().d_m += 0.05;
  off_axis.links.back().alpha_rad += 0.3;
  return {count(problem.nominal), count(off_axis)};
}

IdentifiableSet choose_columns(const IdentificationProblem& problem, const IdentificationOptions& options,
                               const std::vector<std::size_t>& touches) {
  const ChoiceMatrix matrix = choice_matrix(problem.nominal, problem.artefact, pick(problem.touches, touches),
                                            problem.touch_noise_m, options.formulation);
  WeakDiagonals weak{};
  if (options.hold_weak) weak = weak_diagonals(problem, touches, options.formulation);
  return choose_identifiable(matrix.kinematic, options.identifiability, weak, matrix.leading);
}

std::vector<double> choice_singular_values(const IdentificationProblem& problem,
                                           const IdentificationOptions& options,
                                           const std::vector<std::size_t>& touches) {
  if (touches.empty()) return {};
  const ChoiceMatrix matrix = choice_matrix(problem.nominal, problem.artefact, pick(problem.touches, touches),
                                            problem.touch_noise_m, options.formulation);
  const std::vector<int>& excluded = options.identifiability.excluded;
  std::vector<int> columns;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (std::ranges::find(excluded, column) == excluded.end()) columns.push_back(column);
  }
  Eigen::MatrixXd candidates = select_columns(matrix.kinematic, columns);
  if (matrix.leading.cols() > 0) candidates -= matrix.leading * (pseudo_inverse(matrix.leading) * candidates);
  const Eigen::VectorXd sigma = singular_values(candidates);
  return {sigma.begin(), sigma.end()};
}

std::vector<int> estimated_columns(const IdentificationProblem& problem, const IdentificationOptions& options,
                                   const IdentifiableSet& chosen) {
  std::vector<int> columns = chosen.columns;
  if (options.prior) {
    columns.clear();
    for (int i = 0; i < kErrorParameterCount; ++i) {
      if (std::ranges::find(options.identifiability.excluded, i) == options.identifiability.excluded.end()) {
        columns.push_back(i);
      }
    }
  }
  if (options.nongeometric) {
    for (const int position : *options.nongeometric) columns.push_back(nongeometric_index(position));
    return columns;
  }
  const NongeometricDeviations& std = problem.nongeometric_std;
  if (options.stiffness) {
    for (const int position : estimable_compliances(std)) columns.push_back(nongeometric_index(position));
  }
  for (int i = harmonic_position(0); options.harmonics == Harmonics::kEstimate && is_harmonic(i); ++i) {
    if (std[static_cast<std::size_t>(i)]) columns.push_back(nongeometric_index(i));
  }
  return columns;
}

std::optional<double> tilt_spread_rad(const IdentificationProblem& problem,
                                      const std::vector<std::size_t>& touches, int face) {
  std::vector<Eigen::Vector3d> axes;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::size_t index : touches) {
    if (problem.touches[index].face != face) continue;
    axes.emplace_back(forward_kinematics(problem.nominal, problem.touches[index].joints).linear().col(2));
    sum += axes.back();
  }
  if (axes.empty()) return std::nullopt;
  double spread = 0.0;
  for (const Eigen::Vector3d& axis : axes) {
    spread = std::max(spread, std::atan2(axis.cross(sum).norm(), axis.dot(sum)));
  }
  return spread;
}

std::string explain_rank(const IdentificationProblem& problem, const std::vector<std::size_t>& touches,
                         const IdentifiableSet& identifiable, const Attainable& attainable) {
  const auto identified = static_cast<int>(identifiable.columns.size());
  std::ostringstream text;
  if (identified >= attainable.count) {
    text << attainable.count << " is the most that touches with this stylus can show";
    if (attainable.off_axis_count > attainable.count) {
      text << ": its tip is on the last joint's axis; " << attainable.off_axis_count << " with a tip off it";
    }
    return text.str();
  }
  text << "the touches show " << identified << " of the " << attainable.count
       << " parameters that this cell can show: ";
  std::string untouched;
  double widest = 0.0;
  for (int face = 0; face < static_cast<int>(problem.artefact.contact_planes.size()); ++face) {
    if (const auto spread = tilt_spread_rad(problem, touches, face)) {
      widest = std::max(widest, *spread);
    } else {
      untouched += (untouched.empty() ? "" : ", ") + face_name(static_cast<std::size_t>(face));
    }
  }
  if (widest <= kSimilarTiltsRadians) {
    text << "tilts within " << whole_degrees(widest) << " degrees everywhere; tilt the stylus more";
    if (!untouched.empty()) text << ", and there is no touch on " << untouched;
  } else if (!untouched.empty()) {
    text << "there is no touch on " << untouched << "; touch it too";
  } else {
    text << "they are too alike or too few; spread them over the faces and over postures and tilts";
  }
  return text.str();
}

}  // namespace calib
