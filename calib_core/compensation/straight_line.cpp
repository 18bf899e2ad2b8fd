#include "calib_core/compensation/straight_line.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib_core/compensation/arm_sides.hpp"

namespace calib {
namespace {

constexpr double kSampledTurnMaxRad = 12.0 * kRadiansPerDegree;  // of a part
constexpr int kSamplesOfAPart = 8;                               // with its end
constexpr double kSameJointRad = 1e-3;    // the line ends where the target has the joint
constexpr double kLengthRounding = 1e-9;  // of parts: 100 mm are two of 50

/// The straight way from one pose of the tool to another.
class StraightWay {
 public:
  StraightWay(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to)
      : from_m_(from.translation()),
        way_m_(to.translation() - from_m_),
        from_(from.linear()),
        to_(to.linear()) {}

  [[nodiscard]] double length_m() const { return way_m_.norm(); }
  [[nodiscard]] double turn_rad() const { return from_.angularDistance(to_); }
  [[nodiscard]] Eigen::Isometry3d at(double share) const {
    Eigen::Isometry3d pose(from_.slerp(share, to_));
    pose.translation() = from_m_ + share * way_m_;
    return pose;
  }
  /// Of a point from the nearest one of the way, its ends included.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& point_m) const {
    const double square = way_m_.squaredNorm();
    const double share = square > 0.0 ? std::clamp((point_m - from_m_).dot(way_m_) / square, 0.0, 1.0) : 0.0;
    return (point_m - from_m_ - share * way_m_).norm();
  }

 private:
  Eigen::Vector3d from_m_, way_m_;
  Eigen::Quaterniond from_, to_;
};

int parts_of(double length_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / kStraightLinePartMetres - kLengthRounding)));
}

int samples_of(const StraightWay& way) {
  const int turned = static_cast<int>(std::ceil(way.turn_rad() / kSampledTurnMaxRad));
  return kSamplesOfAPart * std::max(parts_of(way.length_m()), turned);
}

/// A corrected place of the line.
struct LinePlace {
  double share = 0.0;
  JointVector joints;
};

class LineSplit {
 public:
  LineSplit(const Compensation& compensation, const CompensationTool& tool, const StraightLine& line,
            double deviation_max_m)
      : compensation_(compensation),
        tool_(tool),
        meant_(line.world_from_start, line.world_from_end),
        deviation_max_m_(deviation_max_m) {}

  LineCorrection corrected(const LinePlace& start, const LinePlace& end) && {
    if (meant_.turn_rad() > kLineTurnMaxRad) {
      fail(LineReason::kHalfTurn, 0.0, 0, meant_.turn_rad());
      return std::move(result_);
    }
    if (const auto deviation_m = followed(start, end)) {
      result_.deviation_m = result_.unsplit_deviation_m = *deviation_m;
      if (*deviation_m > deviation_max_m_) split(start, end);
    }
    if (result_.reason != LineReason::kNone) result_.points.clear();
    return std::move(result_);
  }

 private:
  void fail(LineReason reason, double share, int joint = 0, double angle_rad = 0.0) {
    result_.reason = reason;
    result_.share = share;
    result_.joint = joint;
    result_.angle_rad = angle_rad;
  }
  void fail_at(const CompensatedTarget& point, LineReason reason, double share) {
    fail(reason, share);
    result_.point = point;
  }

  /// Leads the nominal arm straight between two commanded postures. The largest deviation of the calibrated
  /// arm's tool on the way; nothing where the line fails.
  std::optional<double> followed(const LinePlace& from, const LinePlace& to) {
    const ArmSides sides = compensation_.nominal_sides(from.joints);
    if (compensation_.nominal_sides(to.joints) != sides) {
      fail(LineReason::kOtherConfiguration, from.share);
      return std::nullopt;
    }
    const StraightWay commanded(compensation_.nominal_world_from_tool(tool_, from.joints),
                                compensation_.nominal_world_from_tool(tool_, to.joints));
    const int samples = samples_of(commanded);
    JointVector joints = from.joints;
    double deviation_m = 0.0;
    for (int sample = 1; sample <= samples; ++sample) {
      const double step = static_cast<double>(sample) / samples;
      const double share = std::lerp(from.share, to.share, step);
      const auto next = compensation_.nominal_follow(tool_, commanded.at(step), joints);
      if (!next) {
        fail_at({.reason = CompensationReason::kNominalOutOfReach}, LineReason::kPosture, share);
        return std::nullopt;
      }
      if (!may_go(joints, *next, share)) return std::nullopt;
      joints = *next;
      if (sample == samples) break;
      if (!may_be(joints, sides, share)) return std::nullopt;
      deviation_m =
          std::max(deviation_m,
                   meant_.distance_m(compensation_.calibrated_world_from_tool(tool_, joints).translation()));
    }
    Eigen::Index joint = 0;
    if ((joints - to.joints).cwiseAbs().maxCoeff(&joint) > kSameJointRad) {
      fail(LineReason::kOtherTurns, to.share, static_cast<int>(joint) + 1, joints[joint]);
      return std::nullopt;
    }
    return deviation_m;
  }

  bool may_go(const JointVector& joints, const JointVector& next, double share) {
    Eigen::Index joint = 0;
    const double turned_rad = (next - joints).cwiseAbs().maxCoeff(&joint);
    if (turned_rad <= kLineJointStepMaxRad) return true;
    fail(LineReason::kJointTurnsFar, share, static_cast<int>(joint) + 1, turned_rad);
    return false;
  }

  bool may_be(const JointVector& joints, const ArmSides& sides, double share) {
    CompensatedTarget refused;
    const ArmBend bend = compensation_.nominal_bend(joints);
    if (bend.wrist_margin_rad() < kWristMarginMinRad) {
      refused.reason = CompensationReason::kStraightWrist;
      refused.angle_rad = bend.wrist_margin_rad();
    } else if (bend.elbow_margin_rad() < kElbowMarginMinRad) {
      refused.reason = CompensationReason::kStretchedElbow;
      refused.angle_rad = bend.elbow_margin_rad();
    } else if (bend.sides != sides) {
      fail(LineReason::kOtherConfiguration, share);
      return false;
    } else if (const int joint = compensation_.joint_out_of_range(joints)) {
      refused.reason = CompensationReason::kOutOfRange;
      refused.joint = joint;
      refused.angle_rad = joints[joint - 1];
    } else {
      return true;
    }
    fail_at(refused, LineReason::kPosture, share);
    return false;
  }

  /// The corrected target at that share of the meant line.
  std::optional<CompensatedTarget> point_at(double share, const JointVector& near) {
    CompensatedTarget point = compensation_.at_pose(tool_, meant_.at(share), near);
    if (point.status != CompensationStatus::kRefused) return point;
    fail_at(point, LineReason::kPoint, share);
    return std::nullopt;
  }

  void split(const LinePlace& start, const LinePlace& end) {
    result_.deviation_m = 0.0;
    const int parts = std::max(2, parts_of(meant_.length_m()));
    LinePlace from = start;
    for (int part = 1; part < parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const auto point = point_at(share, from.joints);
      if (!point) return;
      const LinePlace to{share, *point->joints};
      if (!hold(from, to, 0)) return;
      result_.points.push_back(*point);
      from = to;
    }
    hold(from, end, 0);
  }

  /// Appends the points that a part needs, without its ends; false where it fails.
  bool hold(const LinePlace& from, const LinePlace& to, int halvings) {
    const auto deviation_m = followed(from, to);
    if (!deviation_m) return false;
    if (*deviation_m <= deviation_max_m_) {
      result_.deviation_m = std::max(result_.deviation_m, *deviation_m);
      return true;
    }
    const double share = 0.5 * (from.share + to.share);
    if (halvings == kLineHalvingsMax) {
      result_.deviation_m = *deviation_m;
      fail(LineReason::kStaysOff, share);
      return false;
    }
    const auto point = point_at(share, from.joints);
    if (!point) return false;
    const LinePlace middle{share, *point->joints};
    if (!hold(from, middle, halvings + 1)) return false;
    result_.points.push_back(*point);
    return hold(middle, to, halvings + 1);
  }

  const Compensation& compensation_;
  const CompensationTool& tool_;
  StraightWay meant_;
  double deviation_max_m_;
  LineCorrection result_;
};

}  // namespace

LineCorrection corrected_line(const Compensation& compensation, const CompensationTool& tool,
                              const StraightLine& line, double deviation_max_m) {
  return LineSplit(compensation, tool, line, deviation_max_m)
      .corrected({0.0, line.start_joints}, {1.0, line.end_joints});
}

}  // namespace calib
