#include "calib_core/estimation/least_squares.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <numeric>

namespace calib {
namespace {

/// Above this the smallest eigenvalue of W^T W has lost its digits, and the singular values are computed.
constexpr double kGramConditionMax = 1e4;

double row_factor(const Plane& plane, Formulation formulation) {
  return formulation == Formulation::kSignedDistance ? 1.0 : 1.0 / std::abs(plane.offset_m);
}

std::optional<double> tolerance_of(const IdentificationProblem& problem, int arm_column) {
  if (arm_column < kErrorParameterCount) return problem.tolerances[static_cast<std::size_t>(arm_column)];
  return problem.std_compliance_rad_per_nm[static_cast<std::size_t>(arm_column - kErrorParameterCount)];
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
    // A compliance has its prior always: touches alone tell it badly.
    if (with_tolerances || column >= kErrorParameterCount) precision[k] = of(tolerance_of(problem, column));
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    precision[arm_count + static_cast<Eigen::Index>(k)] = of(parameters[k].std);
  }
  return precision;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(scale.asDiagonal() * information * scale.asDiagonal());
  return scale.asDiagonal() *
         cholesky.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols())) *
         scale.asDiagonal();
}

LeastSquares::LeastSquares(const IdentificationProblem& problem, const IdentificationOptions& options,
                           std::vector<int> arm_columns, std::vector<std::size_t> touches)
    : problem_(problem),
      arm_columns_(std::move(arm_columns)),
      touches_(std::move(touches)),
      unit_columns_(options.weights == ColumnScaling::kUnitNorm),
      precision_(prior_precision(problem, arm_columns_, options.prior)) {
  if (problem.touch_noise_m > 0.0) noise_unit_m_ = problem.touch_noise_m;
  for (const std::size_t touch : touches_) {
    joints_.push_back(prepare(problem.nominal.gains, problem.touches[touch].joints));
  }
  set_weights(options.formulation);
  keep(std::vector<bool>(touches_.size(), true));
  size_memory();
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
      weights_(other.weights_),
      precision_(prior_precision(problem_, arm_columns_, options.prior)),
      joints_(other.joints_) {
  size_memory();
}

void LeastSquares::size_memory() {
  const auto rows = static_cast<Eigen::Index>(touches_.size());
  planes_ = problem_.artefact.contact_planes;
  rows_.resize(rows, precision_.size());
  residuals_m_.resize(rows);
  weighted_residuals_.resize(rows);
  step_.setZero(precision_.size());
}

void LeastSquares::set_weights(Formulation formulation) {
  weights_.resize(static_cast<Eigen::Index>(touches_.size()));
  for (Eigen::Index row = 0; row < weights_.size(); ++row) {
    const Touch& touch = problem_.touches[touches_[static_cast<std::size_t>(row)]];
    weights_[row] =
        row_factor(problem_.artefact.contact_planes[static_cast<std::size_t>(touch.face)], formulation);
  }
  // On average a row weighs what the declared noise makes it weigh, so that priors keep their share.
  const double mean_square =
      weights_.size() == 0 ? 1.0 : weights_.squaredNorm() / static_cast<double>(weights_.size());
  weights_ /= std::sqrt(mean_square) * noise_unit_m_;
  weights_differ_ = formulation != Formulation::kSignedDistance;
}

void LeastSquares::keep(const std::vector<bool>& kept) {
  kept_ = kept;
  kept_count_ = static_cast<int>(std::accumulate(kept.begin(), kept.end(), 0));
}

void LeastSquares::fill_row(Eigen::Index row, const PreparedModel& model) {
  const Touch& touch = problem_.touches[touches_[static_cast<std::size_t>(row)]];
  const auto face = static_cast<std::size_t>(touch.face);
  const Plane& plane = planes_[face];
  const Chain chain = forward_chain(model, joints_[static_cast<std::size_t>(row)]);
  const Eigen::Vector3d tip = chain.tip_in_block_m();
  const ArmRow slopes = distance_derivatives(model, chain, plane.outward);
  const double weight = weights_[row];
  residuals_m_[row] = signed_distance_m(plane, tip);
  weighted_residuals_[row] = weight * residuals_m_[row];
  Eigen::Index column = 0;
  for (const int arm_column : arm_columns_) rows_(row, column++) = weight * slopes[arm_column];
  for (const ArtefactParameter& parameter : problem_.artefact.parameters) {
    const auto& shift = parameter.shifts[face];
    rows_(row, column++) = weight * (shift.constant + shift.per_metre.dot(tip));
  }
}

void LeastSquares::add_priors(const Estimate& estimate) {
  information_.diagonal() += precision_;
  Eigen::Index k = 0;
  for (const int column : arm_columns_) {
    gradient_[k] -= precision_[k] * estimate.arm[column];
    ++k;
  }
  gradient_.tail(estimate.artefact.size()) -=
      precision_.tail(estimate.artefact.size()).cwiseProduct(estimate.artefact);
  for (const ArtefactEquation& equation : problem_.artefact.equations) {
    const double precision = 1.0 / (equation.std_m * equation.std_m);
    double misclosure = equation.value_m;
    for (const auto& [index, weight] : equation.weights) misclosure -= weight * estimate.artefact[index];
    for (const auto& [i, weight_i] : equation.weights) {
      gradient_[arm_count() + i] += precision * weight_i * misclosure;
      for (const auto& [j, weight_j] : equation.weights) {
        information_(arm_count() + i, arm_count() + j) += precision * weight_i * weight_j;
      }
    }
  }
}

void LeastSquares::linearise(const Estimate& estimate) {
  const PreparedModel model = prepare(apply(problem_.nominal, estimate.arm));
  place_planes(problem_.artefact, estimate.artefact, planes_);
  for (Eigen::Index row = 0; row < rows_.rows(); ++row) fill_row(row, model);

  const bool all = kept_count_ == static_cast<int>(kept_.size());
  if (!all) {
    kept_rows_ = rows_;
    for (Eigen::Index row = 0; row < rows_.rows(); ++row) {
      if (!kept_[static_cast<std::size_t>(row)]) kept_rows_.row(row).setZero();
    }
  }
  const Eigen::MatrixXd& heard = all ? rows_ : kept_rows_;
  touch_information_.setZero(rows_.cols(), rows_.cols());
  touch_information_.selfadjointView<Eigen::Lower>().rankUpdate(heard.transpose());
  touch_information_.triangularView<Eigen::StrictlyUpper>() = touch_information_.transpose();
  touch_gradient_.noalias() = heard.transpose() * weighted_residuals_;
  touch_gradient_ = -touch_gradient_;
  information_ = touch_information_;
  gradient_ = touch_gradient_;
  add_priors(estimate);
}

bool LeastSquares::solve() {
  leverages_.resize(0);
  column_scale_ = information_.diagonal();
  if (!column_scale_.allFinite() || (column_scale_.array() <= 0.0).any()) return false;
  if (unit_columns_) {
    column_scale_ = column_scale_.cwiseSqrt().cwiseInverse();
  } else {
    column_scale_.setOnes();
  }
  scaled_.noalias() = column_scale_.asDiagonal() * information_;
  scaled_.array().rowwise() *= column_scale_.transpose().array();
  cholesky_.compute(scaled_);
  if (cholesky_.info() != Eigen::Success) return false;
  step_ = column_scale_.cwiseProduct(gradient_);
  cholesky_.solveInPlace(step_);
  step_.array() *= column_scale_.array();
  return step_.allFinite();
}

Estimate LeastSquares::stepped(Estimate from) const {
  Eigen::Index k = 0;
  for (const int column : arm_columns_) from.arm[column] += step_[k++];
  from.artefact += step_.tail(from.artefact.size());
  return from;
}

double LeastSquares::residual_rms_m() const {
  double sum = 0.0;
  for (Eigen::Index row = 0; row < residuals_m_.size(); ++row) {
    if (kept_[static_cast<std::size_t>(row)]) sum += residuals_m_[row] * residuals_m_[row];
  }
  return kept_count_ == 0 ? 0.0 : std::sqrt(sum / kept_count_);
}

Eigen::MatrixXd LeastSquares::gradient_covariance() const {
  if (!weights_differ_) return touch_information_;
  Eigen::MatrixXd weighted = rows_;
  for (Eigen::Index row = 0; row < rows_.rows(); ++row) {
    weighted.row(row) *= kept_[static_cast<std::size_t>(row)] ? weights_[row] * noise_unit_m_ : 0.0;
  }
  return weighted.transpose() * weighted;
}

double LeastSquares::chi_square(const Estimate& estimate) const {
  const double rms = residual_rms_m() / noise_unit_m_;
  double sum = rms * rms * kept_count_;
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
  if (leverages_.size() == rows_.rows()) return leverages_;
  Eigen::MatrixXd half = column_scale_.asDiagonal() * rows_.transpose();
  cholesky_.matrixL().solveInPlace(half);
  leverages_ = half.colwise().squaredNorm();
  return leverages_;
}

double LeastSquares::extreme_ratio(const Eigen::MatrixXd& gram) {
  eigen_.compute(gram, Eigen::EigenvaluesOnly);
  const auto& values = eigen_.eigenvalues();
  if (values[0] <= 0.0) return std::numeric_limits<double>::infinity();
  return std::sqrt(values[values.size() - 1] / values[0]);
}

LeastSquares::Conditions LeastSquares::conditions(const std::vector<Eigen::Index>& positions) {
  const auto count = static_cast<Eigen::Index>(positions.size());
  if (count == 0) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  gram_.resize(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      gram_(i, j) =
          touch_information_(positions[static_cast<std::size_t>(i)], positions[static_cast<std::size_t>(j)]);
    }
  }
  unit_gram_ = gram_;
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) unit_gram_(i, j) /= std::sqrt(gram_(i, i) * gram_(j, j));
  }
  Conditions result{extreme_ratio(gram_), extreme_ratio(unit_gram_)};
  if (result.condition_number < kGramConditionMax && result.scaled_condition_number < kGramConditionMax) {
    return result;
  }
  Eigen::MatrixXd columns(rows_.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j) columns.col(j) = rows_.col(positions[static_cast<std::size_t>(j)]);
  for (Eigen::Index row = 0; row < rows_.rows(); ++row) {
    if (!kept_[static_cast<std::size_t>(row)]) columns.row(row).setZero();
  }
  result.condition_number = condition_number(columns);
  result.scaled_condition_number = condition_number(columns.colwise().normalized());
  return result;
}

}  // namespace calib
