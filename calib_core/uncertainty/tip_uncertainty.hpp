#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calib_core/geometry/box.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// The predicted position error of a point of the calibrated arm, in R_-1. `covariance` is that of all 39
/// errors of the identified model (metres, radians, radians per newton metre): symmetric, finite, including
/// the unseen directions. The predicted error is the root mean square distance between the actual position of
/// the point and the position by the model, to first order in the errors.
namespace calib {

/// The point: the origin of a tool given by its pose in R_6, or nothing for the centre of the stylus ball
/// (the origin of R_7).
using ToolCentre = std::optional<Eigen::Isometry3d>;

/// Position of the point in R_-1.
Eigen::Vector3d tool_centre_in_block_m(const Chain& chain, const ToolCentre& tool);

/// sqrt(trace(J C J^T)), J the derivative of the point, 3 x 39. Metres.
double tip_std_m(const KinematicModel& model, const JointVector& joints, const ArmMatrix& covariance,
                 const ToolCentre& tool = std::nullopt);
/// The same at a chain of the model; takes no heap memory.
double tip_std_m(const PreparedModel& model, const Chain& chain, const ArmMatrix& covariance,
                 const ToolCentre& tool);

/// Coverage factor of the expanded uncertainty of the tip.
inline constexpr double kTipCoverageFactor = 2.0;

/// A set of postures of the nominal arm, reduced to what the predicted error over them depends on. Compute it
/// once; each prediction is then one product.
struct TipRegion {
  int posture_count = 0;
  ArmMatrix mean_square = ArmMatrix::Zero();  // mean over the postures of J^T J

  /// Root mean square over the postures, sqrt(trace(mean_square C)), metres; nothing without any posture.
  [[nodiscard]] std::optional<double> rms_m(const ArmMatrix& covariance) const;
};

/// How the predicted error is spread over postures, metres.
struct TipSpread {
  double rms_m = 0.0;
  double p95_m = 0.0;  // not exceeded in 95 % of the postures
  double max_m = 0.0;
};

/// A set of postures with the derivatives of the point at each, for predictions a posture at a time: 1.5 kB a
/// posture. Each prediction is one product of matrices.
struct TipPostures {
  Eigen::Matrix<double, Eigen::Dynamic, kArmParameterCount> derivatives;  // three rows a posture

  [[nodiscard]] int count() const { return static_cast<int>(derivatives.rows() / 3); }
  /// tip_std_m() of each posture.
  [[nodiscard]] Eigen::VectorXd std_m(const ArmMatrix& covariance) const;
  /// Nothing without any posture.
  [[nodiscard]] std::optional<TipSpread> spread(const ArmMatrix& covariance) const;
  [[nodiscard]] TipRegion region() const;
};

TipPostures derive_at_postures(const KinematicModel& model, std::span<const JointVector> postures,
                               const ToolCentre& tool = std::nullopt);

/// The region of given postures, such as those of the touches for the prediction at the block.
TipRegion region_over_postures(const KinematicModel& model, std::span<const JointVector> postures,
                               const ToolCentre& tool = std::nullopt);

/// `count` postures that fill the joint ranges evenly.
std::vector<JointVector> postures_over_joint_ranges(const JointRanges& ranges, int count = 500);

/// The region of these postures.
TipRegion region_over_joint_ranges(const KinematicModel& model, const JointRanges& ranges,
                                   const ToolCentre& tool = std::nullopt, int count = 500);

/// postures_in_box tries at most this many postures per requested one.
inline constexpr int kTriesPerPosture = 400;

/// Up to `count` postures with the point inside the box, from postures that fill the joint ranges evenly:
/// needs no inverse kinematics and works for any arm. Fewer, or none, when the arm hardly reaches the box.
/// Collisions are not checked.
std::vector<JointVector> postures_in_box(const KinematicModel& model, const JointRanges& ranges,
                                         const Box& box, const ToolCentre& tool = std::nullopt,
                                         int count = 500);

/// The region of postures_in_box().
TipRegion region_over_box(const KinematicModel& model, const JointRanges& ranges, const Box& box,
                          const ToolCentre& tool = std::nullopt, int count = 500);

/// Equal cells that fill a box. Cells are numbered with x running fastest, then y, then z.
struct BoxGrid {
  Eigen::Vector3d min_m;
  Eigen::Vector3d cell_size_m;
  std::array<int, 3> counts{};  // along x, y, z

  [[nodiscard]] int cell_count() const { return counts[0] * counts[1] * counts[2]; }
  /// The cell that contains the point, or nothing outside the box.
  [[nodiscard]] std::optional<int> cell_of(const Eigen::Vector3d& point_in_block_m) const;
};

/// Divides a box into cells with edges as close to `edge_m` as possible. Throws std::logic_error when the box
/// has no extent along some axis or the edge is not positive.
BoxGrid divide_box(const Box& box, double edge_m);

/// The predicted error in every cell, metres; nothing in cells without a posture.
struct UncertaintyMap {
  BoxGrid grid;
  std::vector<std::optional<double>> rms_m;
};

/// The cells of a box, each with the region of the postures in it. Compute it once, like TipRegion.
struct TipMap {
  BoxGrid grid;
  std::vector<TipRegion> cells;

  [[nodiscard]] UncertaintyMap evaluate(const ArmMatrix& covariance) const;
};

/// Assigns the postures to the cells; those with the point outside all cells are ignored.
TipMap make_tip_map(const KinematicModel& model, std::span<const JointVector> postures, const BoxGrid& grid,
                    const ToolCentre& tool = std::nullopt);

}  // namespace calib
