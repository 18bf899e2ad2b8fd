#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"

/// How far off a point of the calibrated arm is predicted to be, in R_-1. Everywhere below, `covariance` is
/// that of the errors of the identified model, all 39 of them (metres, radians, radians per newton metre):
/// symmetric, finite, with the unseen directions in it. A predicted deviation is the root of the mean square
/// of the distance between where the point is and where the model has it, to first order in the errors.
namespace calib {

/// The point: R_6 from a tool whose origin it is, or nothing for the centre of the stylus ball (R_7's
/// origin).
using ToolCentre = std::optional<Eigen::Isometry3d>;

/// Where the point is, in R_-1.
Eigen::Vector3d tool_centre_in_block_m(const Chain& chain, const ToolCentre& tool);

/// sqrt(trace(J C J^T)), J the derivative of the point, 3 x 39. Metres.
double tip_std_m(const KinematicModel& model, const JointVector& joints, const ArmMatrix& covariance,
                 const ToolCentre& tool = std::nullopt);

/// Some postures of the nominal arm, as far as the predicted deviation over them needs to know them. Made
/// once, so that a figure is one product.
struct TipRegion {
  int posture_count = 0;
  ArmMatrix mean_square = ArmMatrix::Zero();  // mean over the postures of J^T J

  /// Root mean square over the postures, sqrt(trace(mean_square C)), metres; nothing without any posture.
  [[nodiscard]] std::optional<double> rms_m(const ArmMatrix& covariance) const;
};

/// These postures, such as those of the touches for what is predicted at the block.
TipRegion over_postures(const KinematicModel& model, std::span<const JointVector> postures,
                        const ToolCentre& tool = std::nullopt);

/// `count` postures that fill the joint ranges evenly.
TipRegion over_joint_ranges(const KinematicModel& model, const JointRanges& ranges,
                            const ToolCentre& tool = std::nullopt, int count = 500);

/// postures_in_box gives up after this many postures tried for each one wanted.
inline constexpr int kTriesPerPosture = 400;

/// Up to `count` postures that have the point inside the box: those of an even filling of the joint ranges,
/// so no inverse kinematics is needed and any arm will do. Fewer, or none, where the arm hardly reaches the
/// box. Collisions are not looked at.
std::vector<JointVector> postures_in_box(const KinematicModel& model, const JointRanges& ranges,
                                         const Box& box, const ToolCentre& tool = std::nullopt,
                                         int count = 500);

/// over_postures of postures_in_box.
TipRegion over_box(const KinematicModel& model, const JointRanges& ranges, const Box& box,
                   const ToolCentre& tool = std::nullopt, int count = 500);

/// Equal cells that fill a box, their edges as near to a wanted length as they can be. Cells are counted with
/// x running fastest, then y, then z.
struct BoxGrid {
  Eigen::Vector3d min_m;
  Eigen::Vector3d cell_size_m;
  std::array<int, 3> counts{};  // along x, y, z

  [[nodiscard]] int cell_count() const { return counts[0] * counts[1] * counts[2]; }
  /// The cell a point lies in, or nothing outside of the box.
  [[nodiscard]] std::optional<int> cell_of(const Eigen::Vector3d& point_in_block_m) const;
};

/// A box without extent along some axis, or an edge that is not positive: std::logic_error.
BoxGrid divide(const Box& box, double edge_m);

/// The predicted deviation in every cell, metres; nothing where no posture puts the point.
struct UncertaintyMap {
  BoxGrid grid;
  std::vector<std::optional<double>> rms_m;
};

/// A box cell by cell, each cell a region of the postures that fall into it. Made once, like TipRegion.
struct TipMap {
  BoxGrid grid;
  std::vector<TipRegion> cells;

  [[nodiscard]] UncertaintyMap evaluate(const ArmMatrix& covariance) const;
};

/// Sorts the postures into the cells; those that have the point outside of all cells count nowhere.
TipMap make_tip_map(const KinematicModel& model, std::span<const JointVector> postures, const BoxGrid& grid,
                    const ToolCentre& tool = std::nullopt);

}  // namespace calib
