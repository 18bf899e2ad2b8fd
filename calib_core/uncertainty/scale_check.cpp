#include "calib_core/uncertainty/scale_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/place_group.hpp"
#include "calib_core/numerics/condition_number.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/gram_matrix.hpp"
#include "calib_core/numerics/scaled_cholesky.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

/// Standard deviation of a parameter without a tolerance (metres, radians): practically free.
constexpr double kFreeStd = 1.0;
constexpr double kExactStd = 1e-12;  // of a tolerance of 0

/// Planes with a smaller distance to a common point (metres) intersect in it.
constexpr double kCommonPointMetres = 1e-6;

/// A distance of two faces is a length when it is at least this long and known at least this well.
constexpr double kLengthMinMetres = 1e-3;
constexpr double kLengthStdMaxMetres = 1e-3;
/// Two outside lengths that differ by more than this share tell the ball from the scale.
constexpr double kLengthsDifferShare = 0.2;

/// A parameter is not tested when the touches determine less than this fraction of its prior variance.
constexpr double kInformedShareMin = 1e-6;

/// The nominal lengths of an arm: the direction of a scale error in the space of the errors.
ArmVector lengths_of(const KinematicModel& nominal) {
  ArmVector lengths = ArmVector::Zero();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (error_parameters()[static_cast<std::size_t>(i)].is_length()) lengths[i] = parameter_value(nominal, i);
  }
  return lengths;
}

/// The lengths of arm and tool among the estimated columns, without those of the block pose.
ArmVector own_lengths(const KinematicModel& nominal, const std::vector<int>& columns) {
  const ArmVector all = lengths_of(nominal);
  ArmVector own = ArmVector::Zero();
  for (const int column : columns) {
    const bool of_arm =
        column < kErrorParameterCount &&
        error_parameters()[static_cast<std::size_t>(column)].group() != ParameterGroup::kBlockPose;
    if (of_arm) own[column] = all[column];
  }
  return own;
}

/// The maximum a posteriori problem in all errors that are known of, with what is beside rigid kinematics,
/// the artefact, and what displaces the touches by a pattern; the block pose is free. What is not known of is
/// as in the model.
class ScaleTest {
 public:
  ScaleTest(const IdentificationProblem& problem, const FullLinearisation& whole, double noise_ratio,
            const HarmonicShares& shares, const Estimate& estimate)
      : columns_(whole.columns) {
    std::vector<Eigen::Index> positions(columns_.size() + problem.artefact.parameters.size());
    for (std::size_t k = 0; k < positions.size(); ++k)
      positions[k] = whole.position_of(static_cast<Eigen::Index>(k));
    const double square = noise_ratio * noise_ratio;
    const auto known = std::ssize(positions), patterns = std::ssize(whole.patterns);
    information_.resize(known + patterns, known + patterns);
    information_.topLeftCorner(known, known) = whole.touch_information(positions, positions);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(known + patterns), gradient = values;
    values.head(known) << estimate.arm(columns_), estimate.artefact;
    gradient.head(known) = whole.touch_gradient(positions);
    if (patterns > 0) {
      information_.topRightCorner(known, patterns) = whole.pattern_columns(positions, Eigen::all);
      information_.bottomLeftCorner(patterns, known) =
          information_.topRightCorner(known, patterns).transpose();
      information_.bottomRightCorner(patterns, patterns) = whole.pattern_information;
      gradient.tail(patterns) = whole.pattern_gradient;
    }
    information_ /= square;
    targets_ = information_ * values + gradient / square;
    right_ = targets_;
    Eigen::MatrixXd posterior = information_;
    posterior.diagonal() += precision(problem, whole, shares);
    for (const ArtefactEquation& equation : problem.artefact.equations) {
      const double of_equation = 1.0 / (equation.std_m * equation.std_m);
      for (const auto& [i, weight_i] : equation.weights) {
        right_[artefact_position(i)] += of_equation * weight_i * equation.value_m;
        for (const auto& [j, weight_j] : equation.weights)
          posterior(artefact_position(i), artefact_position(j)) += of_equation * weight_i * weight_j;
      }
    }
    cholesky_.emplace(posterior);
    if (solvable()) solution_ = solve(right_);
  }

  [[nodiscard]] bool solvable() const { return cholesky_->is_positive_definite(); }

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const { return cholesky_->solve(right); }

  /// The change along `lengths` and its standard deviation, next to errors within the priors.
  [[nodiscard]] std::pair<double, double> stretch(const ArmVector& lengths) const {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(information_.rows());
    direction.head(std::ssize(columns_)) = lengths(columns_);
    const Eigen::VectorXd column = information_ * direction;
    const Eigen::VectorXd explained = solve(column);
    const double information = direction.dot(column) - explained.dot(column);
    if (information <= 0.0) return {0.0, std::numeric_limits<double>::infinity()};
    const double moment = direction.dot(targets_) - explained.dot(right_);
    return {moment / information, 1.0 / std::sqrt(information)};
  }

  /// Correction of artefact parameter k divided by its standard deviation under the priors.
  [[nodiscard]] std::optional<double> correction(const IdentificationProblem& problem, std::size_t k) const {
    const auto& std = problem.artefact.parameters[k].std;
    if (!std) return std::nullopt;
    const Eigen::Index index = artefact_position(static_cast<int>(k));
    const double variance = solve(Eigen::VectorXd::Unit(information_.rows(), index))[index];
    const double explained = *std * *std - variance;
    if (explained < kInformedShareMin * *std * *std) return std::nullopt;
    return solution_[index] / std::sqrt(explained);
  }

 private:
  [[nodiscard]] Eigen::Index artefact_position(int parameter) const {
    return std::ssize(columns_) + static_cast<Eigen::Index>(parameter);
  }

  [[nodiscard]] Eigen::VectorXd precision(const IdentificationProblem& problem,
                                          const FullLinearisation& whole,
                                          const HarmonicShares& shares) const {
    Eigen::VectorXd precision(information_.rows());
    Eigen::Index row = 0;
    for (const int column : columns_) {
      std::optional<double> std;
      if (column >= kErrorParameterCount) {
        // Within the maker's figures, or what the residuals leave of them; without any it is as in the model.
        const bool is_estimated = std::ranges::find(whole.estimated, column) != whole.estimated.end();
        const auto position = static_cast<std::size_t>(column - kErrorParameterCount);
        std = (is_estimated ? problem.nongeometric_std[position]
                            : std_unless_estimated(problem, column, shares))
                  .value_or(kExactStd);
      } else if (group_on(problem.nominal, column) != ParameterGroup::kBlockPose) {
        std = problem.tolerances[static_cast<std::size_t>(column)];
      }
      precision[row++] = 1.0 / std::pow(std::max(std.value_or(kFreeStd), kExactStd), 2);
    }
    for (const ArtefactParameter& parameter : problem.artefact.parameters)
      precision[row++] = 1.0 / std::pow(parameter.std.value_or(kFreeStd), 2);
    for (const TouchPattern& pattern : whole.patterns)
      precision[row++] = 1.0 / std::pow(std::max(pattern.std, kExactStd), 2);
    return precision;
  }

  const std::vector<int>& columns_;  // of the arm; the artefact's parameters follow, then the patterns
  Eigen::MatrixXd information_;
  Eigen::VectorXd targets_, right_, solution_;  // the last two with the certified lengths
  std::optional<ScaledCholesky> cholesky_;
};

std::vector<std::size_t> touched_faces(const IdentificationProblem& problem, const LeastSquares& fit) {
  std::vector<std::size_t> touched;
  for (std::size_t face = 0; face < problem.artefact.contact_planes.size(); ++face) {
    bool any = false;
    for (std::size_t i = 0; i < fit.touches().size(); ++i) {
      any =
          any || (fit.kept()[i] && static_cast<std::size_t>(problem.touches[fit.touches()[i]].face) == face);
    }
    if (any) touched.push_back(face);
  }
  return touched;
}

/// Whether the offset of a face is known: it has no parameter, or one with a prior, or a certified length
/// ties it to another face.
bool has_known_offset(const Artefact& artefact, std::size_t face) {
  for (std::size_t k = 0; k < artefact.parameters.size(); ++k) {
    const ArtefactParameter& parameter = artefact.parameters[k];
    if (parameter.kind != ArtefactKind::kFaceOffset || parameter.shifts[face].constant == 0.0) continue;
    const bool tied = std::ranges::any_of(artefact.equations, [&](const ArtefactEquation& equation) {
      return std::ranges::any_of(equation.weights,
                                 [&](const auto& w) { return static_cast<std::size_t>(w.first) == k; });
    });
    return parameter.std || tied;
  }
  return true;
}

/// Whether the face stands at a place that nobody knows but the touches.
bool is_where_touches_find_it(const Artefact& artefact, std::size_t face) {
  return std::ranges::any_of(artefact.parameters, [face](const ArtefactParameter& parameter) {
    return is_free_place_of(parameter, face);
  });
}

/// Whether the touched faces determine a length. An arm of any size can touch planes that intersect in one
/// point; a sphere or bore brings its radius, which is always given.
bool determine_a_length(const IdentificationProblem& problem, const LeastSquares& fit) {
  std::vector<ContactSurface> known;
  for (const std::size_t face : touched_faces(problem, fit)) {
    if (!problem.artefact.contact_planes[face].is_flat()) return true;
    if (problem.artefact.tip_of(face) > 0) continue;  // the touches find where its ball is
    if (is_where_touches_find_it(problem.artefact, face)) continue;
    if (has_known_offset(problem.artefact, face)) known.push_back(problem.artefact.contact_planes[face]);
  }
  Eigen::MatrixXd normals(static_cast<Eigen::Index>(known.size()), 3);
  Eigen::VectorXd offsets(normals.rows());
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    normals.row(row) = known[static_cast<std::size_t>(row)].outward;
    offsets[row] = known[static_cast<std::size_t>(row)].offset_m;
  }
  if (known.empty()) return false;
  const Eigen::Vector3d point = least_squares_solution(normals, offsets);
  return (normals * point - offsets).lpNorm<Eigen::Infinity>() > kCommonPointMetres;
}

/// The touches do not determine the scale: it is that of the nominal arm within the tolerances.
ScaleCheck without_length(const IdentificationProblem& problem) {
  ScaleCheck check{.source = ScaleSource::kPrior};
  const ArmVector lengths = lengths_of(problem.nominal);
  double information = 0.0;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto& parameter = error_parameters()[static_cast<std::size_t>(i)];
    const auto& tolerance = problem.tolerances[static_cast<std::size_t>(i)];
    if (lengths[i] == 0.0 || parameter.group() == ParameterGroup::kBlockPose || !tolerance) continue;
    information += std::pow(lengths[i] / std::max(*tolerance, kExactStd), 2);
  }
  check.std_relative = 1.0 / std::sqrt(information);  // infinite without any tolerance: reported as unknown
  check.warning =
      "no length was touched: the touched faces all meet in one point, which an arm of any size can touch; "
      "the "
      "scale is that of the nominal arm, so touch a face that lies opposite to another";
  return check;
}

/// Of a face as a whole per unit of the parameter: where it is nearest to the origin.
double shift_of(const Artefact& artefact, const ArtefactParameter& parameter, std::size_t face) {
  const ContactSurface& surface = artefact.contact_planes[face];
  return parameter.shifts[face].at({surface.offset_m * surface.outward, surface.outward, {0.0, 0.0, 0.0}});
}

/// How well the distance of two parallel faces is known before any touch; `covariance` is prior_covariance().
double std_of_distance_m(const Artefact& artefact, const Eigen::MatrixXd& covariance, std::size_t a,
                         std::size_t b, double sign_b) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(covariance.rows());
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    const ArtefactParameter& parameter = artefact.parameters[static_cast<std::size_t>(k)];
    if (parameter.kind != ArtefactKind::kFaceOffset && !is_of_place(parameter)) continue;
    direction[k] = shift_of(artefact, parameter, a) + sign_b * shift_of(artefact, parameter, b);
  }
  return std::sqrt(direction.dot(covariance * direction));
}

/// The distance of two faces with the same normal does not depend on the ball; nor does the difference of two
/// outside lengths. A length counts where both its faces are touched and their distance is known.
ScaleSource source_of(const IdentificationProblem& problem, const IdentificationOptions& options,
                      const LeastSquares& fit) {
  if (options.prior) return ScaleSource::kPrior;
  const std::vector<ContactSurface>& planes = problem.artefact.contact_planes;
  const Eigen::MatrixXd covariance = prior_covariance(problem.artefact);
  const std::vector<std::size_t> touched = touched_faces(problem, fit);
  std::vector<double> outside_m;
  for (const std::size_t a : touched) {
    for (const std::size_t b : touched) {
      if (b >= a) break;
      if (!planes[a].is_flat() || !planes[b].is_flat()) continue;
      if (problem.artefact.tip_of(a) != problem.artefact.tip_of(b)) continue;
      const double cosine = planes[a].outward.dot(planes[b].outward);
      if (std::abs(cosine) < 0.999) continue;
      const double sign_b = cosine > 0.0 ? -1.0 : 1.0;
      const double distance_m = std::abs(planes[a].offset_m + sign_b * planes[b].offset_m);
      const bool is_length =
          distance_m > kLengthMinMetres &&
          std_of_distance_m(problem.artefact, covariance, a, b, sign_b) < kLengthStdMaxMetres;
      if (!is_length) continue;
      if (cosine > 0.0) return ScaleSource::kTwoLengths;
      outside_m.push_back(distance_m);
    }
  }
  const auto [least, most] = std::ranges::minmax_element(outside_m);
  const bool differ = !outside_m.empty() && *most - *least > kLengthsDifferShare * *most;
  return differ ? ScaleSource::kTwoLengths : ScaleSource::kBlock;
}

std::string percent(double ratio) {
  std::ostringstream text;
  text.setf(std::ios::showpos);
  text.precision(2);
  text << std::fixed << 100.0 * ratio << " %";
  return text.str();
}

std::string figure(double value, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << std::fixed << value;
  return text.str();
}

/// The error of ball radius minus pre-travel that would cause this scale error, metres.
double ball_error_for(const ArmVector& own, const LeastSquares& fit, double stretch) {
  const Eigen::MatrixXd arm_rows = fit.rows().leftCols(fit.arm_count());
  const Eigen::VectorXd all_one =
      Eigen::VectorXd::Constant(arm_rows.rows(), 1.0 / fit.noise_unit_m()).cwiseQuotient(fit.noise_factors());
  Eigen::MatrixXd information;
  gram_matrix(arm_rows, information);
  // The rows determine these columns, except those that have a prior.
  const Eigen::VectorXd moved = InformationConditions().of(information)
                                    ? ScaledCholesky(information).solve(arm_rows.transpose() * all_one)
                                    : least_squares_solution(arm_rows, all_one);
  double along = 0.0;
  for (std::size_t i = 0; i < fit.arm_columns().size(); ++i) {
    along += own[fit.arm_columns()[i]] * moved[static_cast<Eigen::Index>(i)];
  }
  const double stretch_per_metre = along / own.squaredNorm();
  return std::abs(stretch_per_metre) < 1e-9 ? 0.0 : stretch / stretch_per_metre;
}

/// A given quantity and how it seems to be wrong: the true one is larger or smaller.
std::string written(const std::string& name, bool is_larger) {
  return name + " (written too " + (is_larger ? "small" : "large") + ")";
}

/// `ball_m`: how much the written ball radius less pre-travel would exceed the true one.
std::string words_of_stretch(const ScaleCheck& check, double ball_m) {
  const bool too_large = ball_m > 0.0;
  return "all lengths moved together by " + percent(check.stretch_relative) + ", " +
         figure(*check.significance, 1) +
         " standard deviations of what the maker's tolerances allow: a stylus radius less pre-travel that is "
         "written too " +
         (too_large ? "large" : "small") + " by " + figure(mm_from_metres(std::abs(ball_m)), 3) +
         " mm, a block whose size is written too " + (check.stretch_relative > 0.0 ? "large" : "small") +
         " (by the same share) or a temperature that is written too " +
         (check.stretch_relative > 0.0 ? "high" : "low") +
         " look just like this; check these before the result is used";
}

}  // namespace

ScaleCheck check_scale(const IdentificationProblem& problem, const IdentificationOptions& options,
                       const LeastSquares& fit, const FullLinearisation& whole,
                       const UncertaintyBudget& uncertainty, const Estimate& estimate) {
  if (!determine_a_length(problem, fit)) return without_length(problem);
  ScaleCheck check;
  check.source = source_of(problem, options, fit);
  const ArmVector own = own_lengths(problem.nominal, fit.arm_columns());
  if (own.squaredNorm() > 0.0) {
    // Without grouped parameters: exchanging one for another does not change the scale.
    const std::vector<int>& columns = fit.arm_columns();
    const Eigen::VectorXd along = own(columns);
    const Eigen::MatrixXd covariance =
        uncertainty.identified(columns, columns) + uncertainty.held(columns, columns);
    check.std_relative = std::sqrt(along.dot(covariance * along)) / along.squaredNorm();
  }
  const double ratio = uncertainty.noise_m > 0.0 ? uncertainty.noise_m / fit.noise_unit_m() : 1.0;
  const ScaleTest test(problem, whole, ratio, uncertainty.harmonic_shares, estimate);
  if (!test.solvable()) return check;
  const auto [stretch, std] = test.stretch(lengths_of(problem.nominal));
  check.stretch_relative = stretch;
  if (std < 0.1) check.significance = std::abs(stretch) / std;
  if (check.significance && *check.significance > kScaleSignificanceMax) {
    check.warning = words_of_stretch(check, ball_error_for(own, fit, stretch));
    return check;
  }
  std::string contradicted;
  for (std::size_t k = 0; k < problem.artefact.parameters.size(); ++k) {
    const auto correction = test.correction(problem, k);
    if (!correction || std::abs(*correction) <= check.contradicted.value_or(-1.0)) continue;
    check.contradicted = std::abs(*correction);
    contradicted = written(problem.artefact.parameters[k].name, *correction > 0.0);
  }
  if (check.contradicted && *check.contradicted > kArtefactSignificanceMax) {
    check.warning = "the touches contradict the given " + contradicted + " by " +
                    figure(*check.contradicted, 1) +
                    " standard deviations: check stylus radius, pre-travel, block size and block temperature "
                    "before the result is used";
  }
  return check;
}

}  // namespace calib
