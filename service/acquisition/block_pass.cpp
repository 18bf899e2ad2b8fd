#include "service/acquisition/block_pass.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/motion/transfer_path.hpp"

namespace cell {
namespace {

/// Turns about the stylus that are tried where the touch's own leaves no room.
constexpr int kTurns = 12;
/// Between the normal and the cell's limit, to each of so many sides; from above is one of them.
constexpr int kLeans = 4;
constexpr int kSides = 8;
/// A face that looks up or down more squarely than this has no side from above.
constexpr double kAcrossMin = 0.1;

class Pass {
 public:
  explicit Pass(const Cell& cell)
      : cell_(cell),
        scene_(cell.collision_scene()),
        down_(calib::block_pose_of(cell.arm.model).linear() * cell.arm.model.down_in_frame_1) {}

  /// The clear posture over a touch: in its orientation; else with the stylus leaning off the normal, turned
  /// about itself, whichever is nearest to the touch.
  [[nodiscard]] std::optional<calib::JointVector> over(const calib::RegistrationTouch& touch) const {
    const calib::Plane& plane = cell_.block.faces[static_cast<std::size_t>(touch.face)].plane;
    Eigen::Isometry3d pose = calib::forward_kinematics(cell_.arm.model, touch.joints);
    const double off_m = calib::signed_distance_m(plane, pose.translation()) - cell_.probe.stylus.radius_m;
    pose.pretranslate((kPassMetres - off_m) * plane.outward);
    auto same = calib::solve_near(cell_.arm.model, pose, touch.joints);
    if (same && is_clear(*same)) return same;
    std::optional<calib::JointVector> nearest;
    double least = std::numeric_limits<double>::infinity();
    Eigen::Vector3d across = down_ - down_.dot(plane.outward) * plane.outward;
    if (across.norm() < kAcrossMin) across = plane.outward.unitOrthogonal();
    across.normalize();
    for (int which = 0; which <= kLeans * kSides; ++which) {  // 0: along the normal
      const int step = (which + kSides - 1) / kSides;
      const double lean_rad = cell_.stylus_tilt_max_rad * step / kLeans;
      const Eigen::AngleAxisd side(2.0 * std::numbers::pi * which / kSides, plane.outward);
      const Eigen::Vector3d stylus =
          std::cos(lean_rad) * -plane.outward + std::sin(lean_rad) * (side * across);
      const Eigen::Quaterniond lean = calib::shortest_rotation(pose.linear().col(2), stylus);
      for (int turn = 0; turn < kTurns; ++turn) {
        Eigen::Isometry3d turned = pose;
        turned.linear() = lean * pose.linear() *
                          Eigen::AngleAxisd(2.0 * std::numbers::pi * turn / kTurns, Eigen::Vector3d::UnitZ());
        for (const auto& joints :
             calib::inverse_kinematics(cell_.arm.model, cell_.arm.joint_ranges, turned)) {
          const double far = (joints - touch.joints).cwiseAbs().maxCoeff();
          if (far >= least || !is_clear(joints)) continue;
          least = far;
          nearest = joints;
        }
      }
    }
    return nearest;
  }

 private:
  [[nodiscard]] bool is_clear(const calib::JointVector& joints) const {
    return cell_.arm.joint_ranges.contains(joints) &&
           !calib::find_clash(scene_, calib::forward_chain(cell_.arm.model, joints), cell_.face_error_m());
  }

  const Cell& cell_;
  calib::CollisionScene scene_;
  Eigen::Vector3d down_;  // in R_-1
};

}  // namespace

std::variant<std::vector<calib::JointVector>, std::string> pass_postures(
    const Cell& cell, const std::vector<calib::RegistrationTouch>& touches) {
  const Pass pass(cell);
  std::vector<calib::JointVector> postures;
  std::map<int, int> count_of_face;
  for (const calib::RegistrationTouch& touch : touches) {
    int& count = count_of_face[touch.face];
    const auto joints = pass.over(touch);
    if (!joints) continue;
    postures.push_back(*joints);
    ++count;
  }
  for (const auto& [face, count] : count_of_face) {
    if (count == 0)
      return fmt::format(
          "plane {} leaves no room to pass it at {:.0f} mm: make room around the block and locate "
          "it again",
          face + 1, kPassMetres * 1e3);
  }
  return postures;
}

std::optional<std::vector<PassWay>> pass_ways(const Cell& cell, const calib::JointVector& from,
                                              std::vector<calib::JointVector> postures) {
  postures.push_back(cell.park_joints);
  const calib::TransferSpace space(cell.arm.model, cell.collision_scene(), cell.park_joints,
                                   cell.face_error_m());
  std::vector<PassWay> ways;
  calib::JointVector at = from;
  for (const calib::JointVector& to : postures) {
    auto via = calib::find_path(space, at, to);
    if (!via) return std::nullopt;
    ways.push_back({*std::move(via), to});
    at = to;
  }
  return ways;
}

}  // namespace cell
