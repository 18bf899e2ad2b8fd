#include "calib_core/kinematics/numerical_inverse.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "calib_core/numerics/halton.hpp"

namespace calib {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int kTableEntries = 4096;
/// The nearest entries looked at; 64 miss three times as many postures in 0.3 ms, 128 half as many in 0.55
/// ms.
constexpr std::size_t kNearestEntries = 96;
/// Entries nearer to one another than this in each of joints 2 to 5 lead to the same posture.
constexpr double kStartsApartRad = 0.6;
constexpr double kSamePostureRad = 0.01;
/// What a radian of direction counts as, in parts of the arm's length.
constexpr double kDirectionShare = 0.3;

/// The arm at some joints, and what is left to the wanted pose: metres above radians.
struct PoseGap {
  Chain chain;
  Vector6 error;
};

PoseGap pose_gap(const PreparedModel& prepared, const Eigen::Isometry3d& wanted, const JointVector& joints) {
  const Chain chain = forward_chain(prepared, joints);
  const Eigen::Isometry3d& reached = chain.block_from_frame.back();
  const Eigen::AngleAxisd turn(wanted.linear() * reached.linear().transpose());
  return {chain,
          (Vector6() << wanted.translation() - reached.translation(), turn.angle() * turn.axis()).finished()};
}

/// The damping vanishes with the error: Newton's method near the solution, bounded steps far from it.
JointVector step_over(const PoseGap& gap, const KinematicModel& model) {
  const auto jacobian = pose_jacobian(model, gap.chain);
  const double damping = 1e-2 * gap.error.squaredNorm();
  const Eigen::Matrix<double, 6, 6> normal =
      jacobian.transpose() * jacobian + damping * Eigen::Matrix<double, 6, 6>::Identity();
  return normal.ldlt().solve(jacobian.transpose() * gap.error);
}

bool reaches(const PreparedModel& prepared, const JointVector& joints,
             const Eigen::Isometry3d& block_from_tip) {
  const Eigen::Isometry3d reached = forward_chain(prepared, joints).block_from_frame.back();
  return (reached.translation() - block_from_tip.translation()).norm() < kPoseErrorMax &&
         (reached.linear() - block_from_tip.linear()).norm() < kPoseErrorMax;
}

/// The nearest entries of a table, nearest first.
class Nearest {
 public:
  void offer(float distance, std::size_t entry) {
    if (size_ == kNearestEntries && !(distance < found_[size_ - 1].distance)) return;
    std::size_t place = size_ < kNearestEntries ? size_++ : size_ - 1;
    for (; place > 0 && distance < found_[place - 1].distance; --place) found_[place] = found_[place - 1];
    found_[place] = {distance, entry};
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t operator[](std::size_t index) const { return found_[index].entry; }

 private:
  struct Found {
    float distance = 0.0F;
    std::size_t entry = 0;
  };
  std::array<Found, kNearestEntries> found_;
  std::size_t size_ = 0;
};

}  // namespace

std::optional<JointVector> solve_near(const PreparedModel& prepared, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start) {
  constexpr int kStepsMax = 40;
  constexpr double kStepMaxRad = 0.3;  // of any joint: a longer one may land on another branch
  constexpr double kErrorSmall = 1e-13;
  JointVector joints = start;
  for (int count = 0; count < kStepsMax; ++count) {
    const PoseGap gap = pose_gap(prepared, block_from_tip, joints);
    if (!gap.error.allFinite()) return std::nullopt;
    if (gap.error.norm() < kErrorSmall) return joints;
    JointVector move = step_over(gap, prepared.model);
    move *= std::min(1.0, kStepMaxRad / std::max(move.cwiseAbs().maxCoeff(), 1e-300));
    joints += move;
    if (move.norm() < kErrorSmall) break;
  }
  return reaches(prepared, joints, block_from_tip) ? std::optional(joints) : std::nullopt;
}

std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start) {
  return solve_near(prepare(model), block_from_tip, start);
}

Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain) {
  Eigen::Matrix<double, 6, kJointCount> jacobian;
  jacobian.topRows<3>() = tip_jacobian(model, chain);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    const bool turns = model.joint_types[index] == JointType::kRevolute;
    jacobian.col(joint).tail<3>() =
        (turns ? model.gains[index] : 0.0) * chain.block_from_frame[index + 1].linear().col(2);
  }
  return jacobian;
}

NumericalInverse::NumericalInverse(const KinematicModel& model)
    : prepared_(prepare(model)), gains_(Eigen::Map<const JointVector>(model.gains.data())) {
  if (std::ranges::any_of(model.joint_types, [](JointType type) { return type != JointType::kRevolute; })) {
    throw std::logic_error("the numerical inverse is for revolute joints only");
  }
  LinkParameters until_joint1 = model.links[1];
  until_joint1.theta_rad = 0.0;
  frame1_from_block_ = (frame_transform(model.links[0]) * frame_transform(until_joint1)).inverse();
  tip_from_frame6_ = frame_transform(model.links[kFrameCount - 1]).inverse();
  for (std::size_t frame = 2; frame <= kJointCount; ++frame) {
    direction_weight_m_ +=
        kDirectionShare * (std::abs(model.links[frame].d_m) + std::abs(model.links[frame].r_m));
  }
  const JointVector half_turn = std::numbers::pi * gains_.cwiseAbs().cwiseInverse();
  entries_.reserve(kTableEntries);
  keys_.reserve(kTableEntries);
  for (int i = 1; i <= kTableEntries; ++i) {
    constexpr std::array<int, 4> kBases{2, 3, 5, 7};
    JointVector joints = JointVector::Zero();
    for (int joint = 1; joint <= 4; ++joint) {
      const int base = kBases[static_cast<std::size_t>(joint - 1)];
      joints[joint] = (2.0 * van_der_corput(i, base) - 1.0) * half_turn[joint];
    }
    entries_.push_back(joints);
    keys_.push_back(
        axis_key(frame1_from_block_ * forward_chain(prepared_, joints).block_from_frame[kJointCount]));
  }
}

NumericalInverse::AxisKey NumericalInverse::axis_key(const Eigen::Isometry3d& frame1_from_frame6) const {
  const Eigen::Vector3d place_m = frame1_from_frame6.translation();
  const Eigen::Vector3d direction = direction_weight_m_ * frame1_from_frame6.linear().col(2);
  const double from_axis_m = std::hypot(place_m.x(), place_m.y());
  const double cosine = from_axis_m > 0.0 ? place_m.x() / from_axis_m : 1.0;
  const double sine = from_axis_m > 0.0 ? place_m.y() / from_axis_m : 0.0;
  AxisKey key = AxisKey::Zero();
  key.head<5>() =
      Eigen::Array<double, 5, 1>(from_axis_m, place_m.z(), cosine * direction.x() + sine * direction.y(),
                                 cosine * direction.y() - sine * direction.x(), direction.z())
          .cast<float>();
  return key;
}

/// The entry with joints 1 and 6 turned so that its frame 6 is as the wanted one about either axis.
JointVector NumericalInverse::start_from(const JointVector& entry,
                                         const Eigen::Isometry3d& frame1_from_frame6) const {
  const Eigen::Isometry3d there =
      frame1_from_block_ * forward_chain(prepared_, entry).block_from_frame[kJointCount];
  const auto azimuth_rad = [](const Eigen::Isometry3d& frame) {
    return std::atan2(frame.translation().y(), frame.translation().x());
  };
  const double turn1_rad = azimuth_rad(frame1_from_frame6) - azimuth_rad(there);
  const Eigen::Matrix3d rest = there.linear().transpose() *
                               Eigen::AngleAxisd(-turn1_rad, Eigen::Vector3d::UnitZ()) *
                               frame1_from_frame6.linear();
  JointVector start = entry;
  start[0] += turn1_rad / gains_[0];
  start[kJointCount - 1] +=
      std::atan2(rest(1, 0) - rest(0, 1), rest(0, 0) + rest(1, 1)) / gains_[kJointCount - 1];
  return start;
}

/// Without whole turns.
JointVector NumericalInverse::angles_between(const JointVector& a, const JointVector& b) const {
  return (a - b).cwiseProduct(gains_).unaryExpr(
      [](double angle_rad) { return std::abs(std::remainder(angle_rad, 2.0 * std::numbers::pi)); });
}

bool NumericalInverse::is_known(const JointVector& joints, const Postures& known) const {
  return std::ranges::any_of(known, [&](const JointVector& other) {
    return angles_between(joints, other).maxCoeff() < kSamePostureRad;
  });
}

/// Newton's method, given up where it stalls or arrives at a known posture.
std::optional<JointVector> NumericalInverse::converge(const Eigen::Isometry3d& block_from_tip,
                                                      JointVector joints, const Postures& known) const {
  constexpr int kStepsMax = 12;
  constexpr int kStepsWithoutGainMax = 4;
  constexpr double kGain = 0.7;  // of the smallest error so far
  constexpr double kStepMaxRad = 0.5;
  constexpr double kErrorNear = 0.05;    // metres and radians: on the way to one posture
  constexpr double kLastStepRad = 1e-7;  // its square is the error left
  double smallest = HUGE_VAL;
  int without_gain = 0;
  for (int count = 0; count < kStepsMax && without_gain < kStepsWithoutGainMax; ++count) {
    const PoseGap gap = pose_gap(prepared_, block_from_tip, joints);
    const double error = gap.error.norm();
    if (!std::isfinite(error)) return std::nullopt;
    if (error < kErrorNear && is_known(joints, known)) return std::nullopt;
    const JointVector move = step_over(gap, prepared_.model);
    const double longest_rad = move.cwiseProduct(gains_).cwiseAbs().maxCoeff();
    joints += std::min(1.0, kStepMaxRad / std::max(longest_rad, 1e-300)) * move;
    if (longest_rad < kLastStepRad) break;
    without_gain = error < kGain * smallest ? 0 : without_gain + 1;
    smallest = std::min(smallest, error);
  }
  if (is_known(joints, known) || !reaches(prepared_, joints, block_from_tip)) return std::nullopt;
  const JointVector turns = 2.0 * std::numbers::pi * gains_.cwiseAbs().cwiseInverse();
  return joints.binaryExpr(turns, [](double joint, double turn) { return std::remainder(joint, turn); });
}

Postures NumericalInverse::solve(const Eigen::Isometry3d& block_from_tip) const {
  const Eigen::Isometry3d wanted = frame1_from_block_ * block_from_tip * tip_from_frame6_;
  const AxisKey key = axis_key(wanted);
  Nearest nearest;
  for (std::size_t entry = 0; entry < keys_.size(); ++entry) {
    nearest.offer((keys_[entry] - key).square().sum(), entry);
  }
  Postures found;
  std::array<std::size_t, kNearestEntries> taken;
  std::size_t taken_count = 0;
  for (std::size_t i = 0; i < nearest.size() && !found.full(); ++i) {
    const JointVector& entry = entries_[nearest[i]];
    const bool is_apart = std::all_of(taken.begin(), taken.begin() + taken_count, [&](std::size_t other) {
      return angles_between(entry, entries_[other]).maxCoeff() >= kStartsApartRad;
    });
    if (!is_apart) continue;
    taken[taken_count++] = nearest[i];
    if (const auto joints = converge(block_from_tip, start_from(entry, wanted), found))
      found.push_back(*joints);
  }
  return found;
}

}  // namespace calib
