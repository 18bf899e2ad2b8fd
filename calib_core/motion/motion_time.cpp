#include "calib_core/motion/motion_time.hpp"

#include <algorithm>
#include <cmath>

namespace calib {
namespace {

/// The largest tool speed of a move is searched in steps of this joint motion (sum over the joints).
constexpr double kPieceRadians = 0.25;

/// A trapezoid of progress from 0 to 1, with a top rate (1/s) and an acceleration (1/s^2).
double trapezoid_s(double top_rate, double acceleration) {
  const bool reaches_top = top_rate * top_rate <= acceleration;
  return reaches_top ? 1.0 / top_rate + top_rate / acceleration : 2.0 / std::sqrt(acceleration);
}

/// The tool's path length over the move if its speed were everywhere the largest one.
double longest_tool_path_m(const PreparedModel& model, const JointVector& from, const JointVector& move) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(move.cwiseAbs().sum() / kPieceRadians)));
  double longest = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const Chain chain = forward_chain(model, JointVector(from + (static_cast<double>(i) / pieces) * move));
    longest = std::max(longest, (tip_jacobian(model.model, chain) * move).norm());
  }
  return longest;
}

double move_time_s(const MotionLimits& limits, const JointVector& move, double tool_path_m, double tool_m_s) {
  const double joint_s = (move.cwiseAbs().array() / limits.joint_speeds_max.array()).maxCoeff();
  if (joint_s <= 0.0) return 0.0;
  const double top_rate = std::min(tool_m_s / tool_path_m, 1.0 / joint_s);
  const double acceleration =
      std::min(kToolAccelerationMetresPerSecond2 / tool_path_m, 1.0 / (joint_s * kJointRampSeconds));
  return trapezoid_s(top_rate, acceleration);
}

/// Time of a part of a short straight line.
double piece_time_s(const MotionLimits& limits, const JointVector& move, double length_m, double share,
                    double tool_m_s) {
  return move_time_s(limits, JointVector(share * move), share * length_m, tool_m_s);
}

}  // namespace

double move_time_s(const PreparedModel& model, const MotionLimits& limits, const JointVector& from,
                   const JointVector& to, double tool_m_s) {
  const JointVector move = to - from;
  return move_time_s(limits, move, longest_tool_path_m(model, from, move), tool_m_s);
}

double path_time_s(const PreparedModel& model, const MotionLimits& limits,
                   std::span<const JointVector> postures) {
  double sum = kSettlingSeconds;
  for (std::size_t i = 1; i < postures.size(); ++i) {
    sum += move_time_s(model, limits, postures[i - 1], postures[i], limits.travel_m_s);
  }
  return sum;
}

double touch_time_s(const PreparedModel& model, const MotionLimits& limits, const TouchPostures& touch) {
  const double approach_s =
      move_time_s(model, limits, touch.clear, touch.approach, limits.approach_m_s) + kSettlingSeconds;
  const JointVector line = touch.contact - touch.approach;
  const double length_m = longest_tool_path_m(model, touch.approach, line);
  // A search has one acceleration ramp and ends at full speed.
  const auto search_s = [&](double path_m, double speed_m_s) {
    return path_m / speed_m_s + speed_m_s / (2.0 * kToolAccelerationMetresPerSecond2) + kStopLatencySeconds +
           std::max(kProbeSteadySeconds, kSettlingSeconds);
  };
  double sum = 2.0 * approach_s + search_s(length_m, limits.search_m_s);
  if (limits.second_m_s > 0.0) {
    const double backoff_m = std::min(limits.second_backoff_m, length_m);
    // The first search continued beyond its trigger during the stop latency.
    const double overrun_m = limits.search_m_s * kStopLatencySeconds;
    sum += piece_time_s(limits, line, length_m, backoff_m / length_m, limits.approach_m_s) +
           kSettlingSeconds + search_s(std::max(backoff_m - overrun_m, 0.0), limits.second_m_s);
  }
  return sum + move_time_s(limits, line, length_m, limits.approach_m_s) + kSettlingSeconds;
}

}  // namespace calib
