#include "calib_core/proof/comparison.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calib_core/proof/internal/whitened_rows.hpp"

namespace calib {
namespace {

/// Of the largest share of a combination: smaller ones are not named.
constexpr double kNamedShareMin = 0.5;

bool is_tool_error(int arm_column) {
  return arm_column < kErrorParameterCount &&
         error_parameters()[static_cast<std::size_t>(arm_column)].group() == ParameterGroup::kTool;
}

/// What both estimated, without the block's place.
std::vector<int> compared_columns(const CalibrationRecord& earlier, const CalibrationRecord& later) {
  std::vector<int> columns;
  for (int column = 0; column < kArmParameterCount; ++column)
    if (earlier.is_estimated(column) && later.is_estimated(column) && !is_place_error(column))
      columns.push_back(column);
  return columns;
}

/// How the estimate moves when the arm has grown by one unit: errors that are not estimated grow as well, and
/// bend it.
Eigen::VectorXd estimate_by_growth(const CalibrationRecord& record) {
  const ArmVector grown = errors_by_growth(record.calibrated(), 1.0);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(record.unknown_count());
  for (const int column : record.known_columns()) {
    if (grown[column] == 0.0) continue;
    moved -= grown[column] * record.displacement_by(column);
    moved[column] += grown[column];
  }
  return moved;
}

/// Later minus earlier errors, or a part of them, with their covariance.
struct Difference {
  std::vector<int> columns;
  Eigen::VectorXd errors;
  Eigen::MatrixXd covariance;
};

Difference part_of(const Difference& whole, bool is_of_tool) {
  Difference part;
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < whole.columns.size(); ++k) {
    if (is_tool_error(whole.columns[k]) != is_of_tool) continue;
    part.columns.push_back(whole.columns[k]);
    rows.push_back(static_cast<Eigen::Index>(k));
  }
  part.errors = whole.errors(rows);
  part.covariance = whole.covariance(rows, rows);
  return part;
}

Combination named(const Eigen::VectorXd& shares, const std::vector<int>& columns, double e_n) {
  Combination made{.shares = {}, .e_n = e_n};
  const double least = kNamedShareMin * shares.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < shares.size(); ++k)
    if (std::abs(shares[k]) >= least)
      made.shares.push_back({columns[static_cast<std::size_t>(k)], shares[k]});
  std::ranges::sort(made.shares, std::ranges::greater(),
                    [](const Combination::Share& one) { return std::abs(one.share); });
  return made;
}

/// The principal directions of the errors in their standard deviations: independent of their units.
struct PrincipalDirections {
  Eigen::VectorXd std;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;

  explicit PrincipalDirections(const Eigen::MatrixXd& covariance)
      : std(covariance.diagonal().cwiseSqrt()),
        solver((std.cwiseInverse().asDiagonal() * covariance * std.cwiseInverse().asDiagonal()).eval()) {}

  /// Whether chance is known in each of them.
  [[nodiscard]] bool are_known() const {
    constexpr double kVarianceMin = 1e-12;
    return std.allFinite() && std.minCoeff() > 0.0 && solver.eigenvalues().minCoeff() > kVarianceMin;
  }
};

std::vector<Combination> combinations_of(const Difference& difference) {
  const PrincipalDirections principal(difference.covariance);
  const auto& [std, solver] = principal;
  const Eigen::VectorXd along =
      solver.eigenvectors().transpose() * difference.errors.cwiseQuotient(std).eval();
  std::vector<Combination> made;
  for (Eigen::Index k = 0; k < along.size(); ++k)
    made.push_back(named(solver.eigenvectors().col(k), difference.columns,
                         along[k] / (kComparisonCoverage * std::sqrt(solver.eigenvalues()[k]))));
  std::ranges::sort(made, std::ranges::greater(), [](const Combination& one) { return std::abs(one.e_n); });
  return made;
}

/// `free`: directions of any size, columns.
ComparedErrors compared(const Difference& difference, const Eigen::MatrixXd& free, double noise_degrees) {
  ComparedErrors made;
  if (difference.columns.empty()) return made;
  const WhitenedRows white(difference.covariance, free);
  made.degrees_of_freedom = static_cast<double>(white.degrees());
  made.chi_square = white.rest(difference.errors).squaredNorm();
  made.p = rest_p(made.chi_square, made.degrees_of_freedom, noise_degrees);
  made.combinations = combinations_of(difference);
  return made;
}

}  // namespace

std::variant<Comparison, ComparisonRefusal> compare(const CalibrationRecord& earlier,
                                                    const CalibrationRecord& later) {
  if (earlier.unknown_count() != later.unknown_count())
    return ComparisonRefusal{
        "the two calibrations are not of the same block and probe, or not with the same figures of the "
        "gears: "
        "compare two that were made with the same files"};
  const std::vector<int> columns = compared_columns(earlier, later);
  const Eigen::MatrixXd unlike = earlier.repeated_displacements() - later.repeated_displacements();
  Difference whole{.columns = columns,
                   .errors = (later.errors() - earlier.errors())(columns),
                   .covariance = earlier.scatter()(columns, columns) + later.scatter()(columns, columns)};
  whole.covariance += unlike(columns, Eigen::all) * unlike(columns, Eigen::all).transpose();
  Difference of_arm = part_of(whole, false);
  Difference of_tool = part_of(whole, true);
  if (of_arm.columns.size() < 2)
    return ComparisonRefusal{
        "the two calibrations have nothing of the arm in common that both estimated: compare two of one "
        "recipe"};

  if (!PrincipalDirections(whole.covariance).are_known())
    return ComparisonRefusal{
        "how the two calibrations scatter is not known of all that both estimated: compare two with more "
        "touches"};

  Comparison made;
  made.difference(columns) = whole.errors;
  made.covariance(columns, columns) = whole.covariance;
  const double noise_degrees = std::min(earlier.noise().degrees_of_freedom, later.noise().degrees_of_freedom);
  const Eigen::VectorXd all_by_growth = estimate_by_growth(later);
  const Eigen::VectorXd by_growth = all_by_growth(of_arm.columns);
  const WhitenedRows white(of_arm.covariance, Eigen::MatrixXd(by_growth.size(), 0));
  const Eigen::VectorXd grown = white.rest(by_growth).col(0);
  made.growth = grown.dot(white.rest(of_arm.errors).col(0)) / grown.squaredNorm();
  made.std_growth = 1.0 / grown.norm();
  of_arm.errors -= made.growth * by_growth;
  // An arm that has grown may bend what is estimated of the stylus as well.
  const Eigen::VectorXd tool_by_growth = all_by_growth(of_tool.columns);
  of_tool.errors -= made.growth * tool_by_growth;
  of_tool.covariance += made.std_growth * made.std_growth * tool_by_growth * tool_by_growth.transpose();
  made.arm = compared(of_arm, by_growth, noise_degrees);
  made.tool = compared(of_tool, Eigen::MatrixXd(of_tool.errors.size(), 0), noise_degrees);
  return made;
}

}  // namespace calib
