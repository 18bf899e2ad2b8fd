#include "calib_core/estimation/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calib_core/numerics/gram_matrix.hpp"
#include "calib_core/numerics/scaled_cholesky.hpp"

namespace calib {
namespace {

std::optional<double> tolerance_of(const IdentificationProblem& problem, int arm_column) {
  if (arm_column < kErrorParameterCount) return problem.tolerances[static_cast<std::size_t>(arm_column)];
  return problem.nongeometric_std[static_cast<std::size_t>(arm_column - kErrorParameterCount)];
}

}  // namespace

Eigen::VectorXd prior_precision(const IdentificationProblem& problem, const std::vector<int>& arm_columns,
                                bool with_tolerances) {
  const auto arm_count = static_cast<Eigen::Index>(arm_columns.size());
  const auto& parameters = problem.artefact.parameters;
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(arm_count + static_cast<Eigen::Index>(parameters.size()));
  const auto of = [](const std::optional<double>& std) { return std ? 1.0 / (*std * *std) : 0.0; };
  for (Eigen::Index k = 0; k < arm_count; ++k) {
    const int column = arm_columns[static_cast<std::size_t>(k)];
    // What is beside rigid kinematics always has its prior: touches alone determine it poorly.
    if (with_tolerances || column >= kErrorParameterCount) precision[k] = of(tolerance_of(problem, column));
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    precision[arm_count + static_cast<Eigen::Index>(k)] = of(parameters[k].std);
  }
  return precision;
}

bool has_priors(const IdentificationProblem& problem, const IdentificationOptions& options) {
  const bool has_named = options.nongeometric && !options.nongeometric->empty();
  return options.prior || options.stiffness || has_named || !problem.artefact.parameters.empty();
}

Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information) {
  return ScaledCholesky(information).inverse();
}

LeastSquares::LeastSquares(const IdentificationProblem& problem, const IdentificationOptions& options,
                           std::vector<int> arm_columns, std::vector<std::size_t> touches)
    : problem_(problem),
      arm_columns_(std::move(arm_columns)),
      touches_(std::move(touches)),
      unit_columns_(options.weights == ColumnScaling::kUnitNorm),
      precision_(prior_precision(problem, arm_columns_, options.prior)) {
  if (problem.touch_noise_m > 0.0) noise_unit_m_ = problem.touch_noise_m;
  for_each_block(touches_.size(), [&](std::size_t first, std::size_t count) {
    PostureLanes& block = postures_.emplace_back();
    for (std::size_t lane = 0; lane < kLaneCount; ++lane)
      block.set(lane, problem.touches[touches_[first + std::min(lane, count - 1)]].joints);
    lane_arithmetic().turn(problem.nominal.gains, block);
  });
  set_weights(options.formulation);
  keep(std::vector<bool>(touches_.size(), true));
  allocate_buffers();
}

LeastSquares::LeastSquares(const LeastSquares& other, const IdentificationOptions& options,
                           std::vector<int> arm_columns)
    : problem_(other.problem_),
      arm_columns_(std::move(arm_columns)),
      touches_(other.touches_),
      kept_(other.kept_),
      kept_count_(other.kept_count_),
      unit_columns_(other.unit_columns_),
      weights_differ_(other.weights_differ_),
      noise_unit_m_(other.noise_unit_m_),
      noise_factors_(other.noise_factors_),
      weights_(other.weights_),
      precision_(prior_precision(problem_, arm_columns_, options.prior)),
      postures_(other.postures_) {
  allocate_buffers();
}

void LeastSquares::allocate_buffers() {
  const auto rows = static_cast<Eigen::Index>(touches_.size());
  planes_ = problem_.artefact.contact_planes;
  rows_.all.resize(rows, precision_.size());
  rows_.residuals_m.resize(rows);
  rows_.weighted_residuals.resize(rows);
  normal_.step.setZero(precision_.size());
}

void LeastSquares::set_weights(Formulation formulation) {
  weights_.resize(static_cast<Eigen::Index>(touches_.size()));
  noise_factors_.resize(weights_.size());
  for (Eigen::Index row = 0; row < weights_.size(); ++row) {
    const Touch& touch = problem_.touches[touches_[static_cast<std::size_t>(row)]];
    weights_[row] = std::abs(
        row_factor(problem_.artefact.contact_planes[static_cast<std::size_t>(touch.face)], formulation));
    noise_factors_[row] = noise_factor(touch, noise_unit_m_);
  }
  // The mean square weight is that of the declared noise, so that the priors keep their relative weight.
  const double mean_square =
      weights_.size() == 0 ? 1.0 : weights_.squaredNorm() / static_cast<double>(weights_.size());
  weights_ /= std::sqrt(mean_square) * noise_unit_m_;
  weights_.array() /= noise_factors_.array();
  weights_differ_ = formulation != Formulation::kSignedDistance;
}

void LeastSquares::keep(const std::vector<bool>& kept) {
  kept_ = kept;
  kept_count_ = static_cast<int>(std::accumulate(kept.begin(), kept.end(), 0));
}

void LeastSquares::fill_rows(std::size_t block, const PreparedModel& model) {
  const std::size_t first = block * kLaneCount;
  const std::size_t count = std::min(kLaneCount, touches_.size() - first);
  const auto face_of = [&](std::size_t lane) {
    return static_cast<std::size_t>(problem_.touches[touches_[first + std::min(lane, count - 1)]].face);
  };
  ChainLanes chains;
  lane_arithmetic().forward_chains(model, postures_[block], chains);
  BallLanes balls;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) balls.set(lane, planes_[face_of(lane)], chains);
  ArmRowLanes slopes;
  lane_arithmetic().distance_derivatives(model, chains, balls, slopes);
  const auto row = static_cast<Eigen::Index>(first);
  const auto rows = static_cast<Eigen::Index>(count);
  const Eigen::VectorXd::SegmentReturnType weights = weights_.segment(row, rows);
  for (std::size_t lane = 0; lane < count; ++lane)
    rows_.residuals_m[row + static_cast<Eigen::Index>(lane)] =
        signed_distance_m(planes_[face_of(lane)], chains, lane);
  rows_.weighted_residuals.segment(row, rows) = weights.cwiseProduct(rows_.residuals_m.segment(row, rows));
  Eigen::Index column = 0;
  for (const int arm_column : arm_columns_) {
    const Eigen::Map<const Eigen::Vector4d> slope(slopes[static_cast<std::size_t>(arm_column)].of.data());
    if (count == kLaneCount) {
      rows_.all.col(column++).segment<kLaneCount>(row) = weights.head<kLaneCount>().cwiseProduct(slope);
    } else {
      rows_.all.col(column++).segment(row, rows) = weights.cwiseProduct(slope.head(rows));
    }
  }
  const Eigen::Index first_of_artefact = column;
  for (std::size_t lane = 0; lane < count; ++lane) {
    const auto here = row + static_cast<Eigen::Index>(lane);
    const std::size_t face = face_of(lane);
    const BallContact contact{balls.center_m.of(lane), balls.outward.of(lane),
                              chains.in_frame_7(lane, balls.outward.of(lane))};
    column = first_of_artefact;
    for (const ArtefactParameter& parameter : problem_.artefact.parameters)
      rows_.all(here, column++) = weights_[here] * parameter.shifts[face].at(contact);
  }
}

void LeastSquares::add_priors(const Estimate& estimate) {
  normal_.information.diagonal() += precision_;
  Eigen::Index k = 0;
  for (const int column : arm_columns_) {
    normal_.gradient[k] -= precision_[k] * estimate.arm[column];
    ++k;
  }
  normal_.gradient.tail(estimate.artefact.size()) -=
      precision_.tail(estimate.artefact.size()).cwiseProduct(estimate.artefact);
  for (const ArtefactEquation& equation : problem_.artefact.equations) {
    const double precision = 1.0 / (equation.std_m * equation.std_m);
    double misclosure = equation.value_m;
    for (const auto& [index, weight] : equation.weights) misclosure -= weight * estimate.artefact[index];
    for (const auto& [i, weight_i] : equation.weights) {
      normal_.gradient[arm_count() + i] += precision * weight_i * misclosure;
      for (const auto& [j, weight_j] : equation.weights) {
        normal_.information(arm_count() + i, arm_count() + j) += precision * weight_i * weight_j;
      }
    }
  }
}

void LeastSquares::set_rows(const Estimate& estimate) {
  const PreparedModel model = prepare(apply(problem_.nominal, estimate.arm));
  correct_contact_planes(problem_.artefact, estimate.artefact, planes_);
  for (std::size_t block = 0; block < postures_.size(); ++block) fill_rows(block, model);
}

void LeastSquares::linearise(const Estimate& estimate) {
  set_rows(estimate);
  const bool all = kept_count_ == static_cast<int>(kept_.size());
  if (!all) {
    rows_.kept = rows_.all;
    for (Eigen::Index row = 0; row < rows_.all.rows(); ++row) {
      if (!kept_[static_cast<std::size_t>(row)]) rows_.kept.row(row).setZero();
    }
  }
  const Eigen::MatrixXd& fitted_rows = all ? rows_.all : rows_.kept;
  gram_matrix(fitted_rows, normal_.touch_information);
  normal_.touch_gradient.noalias() = fitted_rows.transpose() * rows_.weighted_residuals;
  normal_.touch_gradient = -normal_.touch_gradient;
  normal_.information = normal_.touch_information;
  normal_.gradient = normal_.touch_gradient;
  add_priors(estimate);
}

bool LeastSquares::solve() {
  normal_.leverages.resize(0);
  normal_.column_scale = normal_.information.diagonal();
  if (!normal_.column_scale.allFinite() || (normal_.column_scale.array() <= 0.0).any()) return false;
  if (unit_columns_) {
    normal_.column_scale = normal_.column_scale.cwiseSqrt().cwiseInverse();
  } else {
    normal_.column_scale.setOnes();
  }
  normal_.scaled.noalias() = normal_.column_scale.asDiagonal() * normal_.information;
  normal_.scaled.array().rowwise() *= normal_.column_scale.transpose().array();
  normal_.cholesky.compute(normal_.scaled);
  if (normal_.cholesky.info() != Eigen::Success) return false;
  normal_.step = normal_.column_scale.cwiseProduct(normal_.gradient);
  normal_.cholesky.solveInPlace(normal_.step);
  normal_.step.array() *= normal_.column_scale.array();
  return normal_.step.allFinite();
}

Estimate LeastSquares::stepped(Estimate from) const {
  Eigen::Index k = 0;
  for (const int column : arm_columns_) from.arm[column] += normal_.step[k++];
  from.artefact += normal_.step.tail(from.artefact.size());
  return from;
}

double LeastSquares::residual_rms_m() const {
  double sum = 0.0;
  for (Eigen::Index row = 0; row < rows_.residuals_m.size(); ++row) {
    if (kept_[static_cast<std::size_t>(row)]) sum += rows_.residuals_m[row] * rows_.residuals_m[row];
  }
  return kept_count_ == 0 ? 0.0 : std::sqrt(sum / kept_count_);
}

Eigen::MatrixXd LeastSquares::gradient_covariance() const {
  if (!weights_differ_) return normal_.touch_information;
  Eigen::MatrixXd weighted = rows_.all;
  for (Eigen::Index row = 0; row < rows_.all.rows(); ++row) {
    weighted.row(row) *=
        kept_[static_cast<std::size_t>(row)] ? weights_[row] * noise_unit_m_ * noise_factors_[row] : 0.0;
  }
  return weighted.transpose() * weighted;
}

double LeastSquares::weighted_square_sum() const {
  double sum = 0.0;
  for (Eigen::Index row = 0; row < rows_.weighted_residuals.size(); ++row) {
    if (kept_[static_cast<std::size_t>(row)]) sum += std::pow(rows_.weighted_residuals[row], 2);
  }
  return sum;
}

double LeastSquares::chi_square(const Estimate& estimate) const {
  double sum = weighted_square_sum();
  Eigen::Index k = 0;
  for (const int column : arm_columns_) sum += precision_[k++] * estimate.arm[column] * estimate.arm[column];
  sum += precision_.tail(estimate.artefact.size()).dot(estimate.artefact.cwiseAbs2());
  for (const ArtefactEquation& equation : problem_.artefact.equations) {
    double misclosure = equation.value_m;
    for (const auto& [index, weight] : equation.weights) misclosure -= weight * estimate.artefact[index];
    sum += misclosure * misclosure / (equation.std_m * equation.std_m);
  }
  return sum;
}

int LeastSquares::degrees_of_freedom() const {
  const auto priors = static_cast<int>((precision_.array() > 0.0).count());
  return kept_count_ + priors + static_cast<int>(problem_.artefact.equations.size()) -
         static_cast<int>(precision_.size());
}

const Eigen::VectorXd& LeastSquares::leverages() {
  if (normal_.leverages.size() == rows_.all.rows()) return normal_.leverages;
  Eigen::MatrixXd half = normal_.column_scale.asDiagonal() * rows_.all.transpose();
  normal_.cholesky.matrixL().solveInPlace(half);
  normal_.leverages = half.colwise().squaredNorm();
  return normal_.leverages;
}

ConditionNumbers LeastSquares::condition_numbers(const std::vector<Eigen::Index>& positions) {
  const auto count = static_cast<Eigen::Index>(positions.size());
  if (count == 0) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  information_of_positions_.resize(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      information_of_positions_(i, j) = normal_.touch_information(positions[static_cast<std::size_t>(i)],
                                                                  positions[static_cast<std::size_t>(j)]);
    }
  }
  if (const auto numbers = information_conditions_.of(information_of_positions_)) return *numbers;
  Eigen::MatrixXd columns(rows_.all.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j)
    columns.col(j) = rows_.all.col(positions[static_cast<std::size_t>(j)]);
  for (Eigen::Index row = 0; row < rows_.all.rows(); ++row) {
    if (!kept_[static_cast<std::size_t>(row)]) columns.row(row).setZero();
  }
  return calib::condition_numbers(columns);
}

}  // namespace calib
