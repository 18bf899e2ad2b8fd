#include "calib_core/uncertainty/tip_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/numerics/distributions.hpp"
#include "calib_core/numerics/halton.hpp"

namespace calib {
namespace {

constexpr int kToolFrame = 6;
/// The ripples are the last parameters; most arms have none.
constexpr int kBeforeRipples = nongeometric_index(ripple_position(0));

using PointDerivatives = Eigen::Matrix<double, 3, kArmParameterCount>;

PointDerivatives derivatives_of(const PreparedModel& model, const Chain& chain, const ToolCentre& tool) {
  return point_arm_derivatives(model, chain, tool_centre_in_block_m(chain, tool),
                               tool ? kToolFrame : kFrameCount - 1);
}

/// Rounding may make a sum of squares slightly negative; NaN stays NaN.
double root_of_sum_of_squares(double sum) { return sum < 0.0 ? 0.0 : std::sqrt(sum); }

bool has_ripples(const Eigen::Matrix<double, kArmParameterCount, 3>& rows) {
  return !rows.bottomRows<kArmParameterCount - kBeforeRipples>().isZero(0.0);
}

/// Mean of J^T J over postures.
class JacobianMean {
 public:
  void add(const PointDerivatives& derivatives) {
    ++count_;
    // Column by column below the diagonal: three times faster than Eigen's rankUpdate for so flat a matrix.
    const Eigen::Matrix<double, kArmParameterCount, 3> rows = derivatives.transpose();
    const int end = has_ripples(rows) ? kArmParameterCount : kBeforeRipples;
    for (int j = 0; j < end; ++j) {
      const int below = end - j;
      sum_.col(j).segment(j, below) += rows(j, 0) * rows.col(0).segment(j, below) +
                                       rows(j, 1) * rows.col(1).segment(j, below) +
                                       rows(j, 2) * rows.col(2).segment(j, below);
    }
  }
  [[nodiscard]] TipRegion region() const {
    if (count_ == 0) return {};
    const ArmMatrix whole = sum_.selfadjointView<Eigen::Lower>();
    return {count_, whole / count_};
  }

 private:
  int count_ = 0;
  ArmMatrix sum_ = ArmMatrix::Zero();  // lower triangle
};

}  // namespace

Eigen::Vector3d tool_centre_in_block_m(const Chain& chain, const ToolCentre& tool) {
  return tool ? chain.block_from_frame[kToolFrame] * tool->translation() : chain.tip_in_block_m();
}

double tip_std_m(const KinematicModel& model, const JointVector& joints, const ArmMatrix& covariance,
                 const ToolCentre& tool) {
  const PreparedModel prepared = prepare(model);
  return tip_std_m(prepared, forward_chain(prepared, joints), covariance, tool);
}

double tip_std_m(const PreparedModel& model, const Chain& chain, const ArmMatrix& covariance,
                 const ToolCentre& tool) {
  // Column by column above the diagonal: three times faster than a product of matrices, and this is most of
  // what a compensated target takes.
  const Eigen::Matrix<double, kArmParameterCount, 3> rows = derivatives_of(model, chain, tool).transpose();
  const int end = has_ripples(rows) ? kArmParameterCount : kBeforeRipples;
  double sum = 0.0;
  for (int j = 0; j < end; ++j) {
    const auto above = covariance.col(j).head(j);
    sum += covariance(j, j) * rows.row(j).squaredNorm() +
           2.0 * (rows(j, 0) * above.dot(rows.col(0).head(j)) + rows(j, 1) * above.dot(rows.col(1).head(j)) +
                  rows(j, 2) * above.dot(rows.col(2).head(j)));
  }
  return root_of_sum_of_squares(sum);
}

std::optional<double> TipRegion::rms_m(const ArmMatrix& covariance) const {
  if (posture_count == 0) return std::nullopt;
  return root_of_sum_of_squares(mean_square.cwiseProduct(covariance).sum());
}

Eigen::VectorXd TipPostures::std_m(const ArmMatrix& covariance) const {
  const Eigen::VectorXd squares = (derivatives * covariance).cwiseProduct(derivatives).rowwise().sum();
  Eigen::VectorXd std_m(count());
  for (Eigen::Index i = 0; i < std_m.size(); ++i)
    std_m[i] = root_of_sum_of_squares(squares.segment<3>(3 * i).sum());
  return std_m;
}

std::optional<TipSpread> TipPostures::spread(const ArmMatrix& covariance) const {
  if (count() == 0) return std::nullopt;
  constexpr double kShare = 0.95;
  const Eigen::VectorXd each_m = std_m(covariance);
  return TipSpread{.rms_m = std::sqrt(each_m.squaredNorm() / count()),
                   .p95_m = sample_quantile({each_m.begin(), each_m.end()}, kShare),
                   .max_m = each_m.maxCoeff<Eigen::PropagateNaN>()};
}

TipRegion TipPostures::region() const {
  JacobianMean sum;
  for (int i = 0; i < count(); ++i) sum.add(derivatives.middleRows<3>(3 * i));
  return sum.region();
}

TipPostures derive_at_postures(const KinematicModel& model, std::span<const JointVector> postures,
                               const ToolCentre& tool) {
  TipPostures result;
  result.derivatives.resize(3 * std::ssize(postures), kArmParameterCount);
  const PreparedModel prepared = prepare(model);
  for (Eigen::Index i = 0; i < std::ssize(postures); ++i) {
    const Chain chain = forward_chain(prepared, postures[static_cast<std::size_t>(i)]);
    result.derivatives.middleRows<3>(3 * i) = derivatives_of(prepared, chain, tool);
  }
  return result;
}

TipRegion region_over_postures(const KinematicModel& model, std::span<const JointVector> postures,
                               const ToolCentre& tool) {
  JacobianMean sum;
  const PreparedModel prepared = prepare(model);
  for (const JointVector& joints : postures) {
    sum.add(derivatives_of(prepared, forward_chain(prepared, joints), tool));
  }
  return sum.region();
}

std::vector<JointVector> postures_over_joint_ranges(const JointRanges& ranges, int count) {
  std::vector<JointVector> postures;
  for (int i = 1; i <= count; ++i) postures.push_back(halton_posture(i, ranges));
  return postures;
}

TipRegion region_over_joint_ranges(const KinematicModel& model, const JointRanges& ranges,
                                   const ToolCentre& tool, int count) {
  return region_over_postures(model, postures_over_joint_ranges(ranges, count), tool);
}

std::vector<JointVector> postures_in_box(const KinematicModel& model, const JointRanges& ranges,
                                         const Box& box, const ToolCentre& tool, int count) {
  std::vector<JointVector> inside;
  const PreparedModel prepared = prepare(model);
  const int tries_max = kTriesPerPosture * count;
  for (int i = 1; i <= tries_max && std::ssize(inside) < count; ++i) {
    const JointVector joints = halton_posture(i, ranges);
    if (box.contains(tool_centre_in_block_m(forward_chain(prepared, joints), tool))) inside.push_back(joints);
  }
  return inside;
}

TipRegion region_over_box(const KinematicModel& model, const JointRanges& ranges, const Box& box,
                          const ToolCentre& tool, int count) {
  return region_over_postures(model, postures_in_box(model, ranges, box, tool, count), tool);
}

std::optional<int> BoxGrid::cell_of(const Eigen::Vector3d& point_in_block_m) const {
  std::array<int, 3> index{};
  for (int axis = 0; axis < 3; ++axis) {
    const int count = counts[static_cast<std::size_t>(axis)];
    const double cells = (point_in_block_m[axis] - min_m[axis]) / cell_size_m[axis];
    if (!(cells >= 0.0 && cells <= count)) return std::nullopt;
    // The upper boundary belongs to the last cell.
    index[static_cast<std::size_t>(axis)] = std::min(static_cast<int>(cells), count - 1);
  }
  return index[0] + counts[0] * (index[1] + counts[1] * index[2]);
}

BoxGrid divide_box(const Box& box, double edge_m) {
  const Eigen::Vector3d extent_m = box.max_m - box.min_m;
  if (!(edge_m > 0.0) || !(extent_m.array() > 0.0).all()) {
    throw std::invalid_argument("divide_box: the box and the edge must have extent");
  }
  BoxGrid grid{.min_m = box.min_m, .cell_size_m = extent_m};
  for (int axis = 0; axis < 3; ++axis) {
    const int count = std::max(1, static_cast<int>(std::lround(extent_m[axis] / edge_m)));
    grid.counts[static_cast<std::size_t>(axis)] = count;
    grid.cell_size_m[axis] /= count;
  }
  return grid;
}

TipMap make_tip_map(const KinematicModel& model, std::span<const JointVector> postures, const BoxGrid& grid,
                    const ToolCentre& tool) {
  std::vector<JacobianMean> sums(static_cast<std::size_t>(grid.cell_count()));
  const PreparedModel prepared = prepare(model);
  for (const JointVector& joints : postures) {
    const Chain chain = forward_chain(prepared, joints);
    const auto cell = grid.cell_of(tool_centre_in_block_m(chain, tool));
    if (cell) sums[static_cast<std::size_t>(*cell)].add(derivatives_of(prepared, chain, tool));
  }
  TipMap map{.grid = grid, .cells = {}};
  for (const JacobianMean& sum : sums) map.cells.push_back(sum.region());
  return map;
}

UncertaintyMap TipMap::evaluate(const ArmMatrix& covariance) const {
  UncertaintyMap map{.grid = grid, .rms_m = {}};
  for (const TipRegion& cell : cells) map.rms_m.push_back(cell.rms_m(covariance));
  return map;
}

}  // namespace calib
