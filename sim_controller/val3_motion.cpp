// The arm of a Val3System: where it is, where it can go, and the moves of an application.
#include <algorithm>
#include <numbers>
#include <utility>

#include "sim_controller/move_obstacle.hpp"
#include "sim_controller/val3_system.hpp"
#include "sim_controller/val3_units.hpp"

namespace sim {
namespace {

constexpr double kPercent = 0.01;
constexpr double kRadiansPerDegreeOfTool = std::numbers::pi / 180.0;
constexpr double kMetresPerMillimetreOfTool = 1e-3;

MotionDescriptor descriptor_from_val3(const val3::Mdesc& mdesc) {
  return {.joint_speed_share = mdesc.vel * kPercent,
          .joint_acceleration_share = mdesc.accel * kPercent,
          .joint_deceleration_share = mdesc.decel * kPercent,
          .tip_speed_m_s = std::max(mdesc.tvel, 0.0) * kMetresPerMillimetreOfTool,
          .turn_speed_rad_s = std::max(mdesc.rvel, 0.0) * kRadiansPerDegreeOfTool};
}

}  // namespace

calib::JointVector Val3System::joint_speeds() const { return (motion_.to - motion_.from) / kTickSeconds; }

val3::Joint Val3System::joints() const {
  const calib::JointVector& commanded = cabinet_.drives.joints;
  return val3_from_joints(cabinet_.panel.powered ? commanded : encoder_reading(plant_, commanded));
}

val3::Joint Val3System::position_error() const {
  return val3_from_joints(joint_speeds() * kFollowingSeconds);
}

double Val3System::tool_speed(const val3::Trsf& tool) const {
  const Eigen::Vector3d tool_in_flange_m = pose_from_val3(tool).translation();
  const Eigen::Vector3d way_m = arm_.world_from_flange(motion_.to) * tool_in_flange_m -
                                arm_.world_from_flange(motion_.from) * tool_in_flange_m;
  return way_m.norm() / kTickSeconds / kMetresPerMillimetreOfTool;
}

val3::Trsf Val3System::flange_at(const val3::Joint& joints) const {
  return val3_from_pose(arm_.world_from_flange(joints_from_val3(joints)));
}

std::optional<val3::Joint> Val3System::solve(const val3::Trsf& flange, const val3::Config& config,
                                             const val3::Joint& near) const {
  const auto joints = arm_.solve(pose_from_val3(flange), config, joints_from_val3(near));
  if (!joints) return std::nullopt;
  return val3_from_joints(*joints);
}

val3::Config Val3System::config_of(const val3::Joint& joints) const {
  return arm_.config_of(joints_from_val3(joints));
}

bool Val3System::in_range(const val3::Joint& joints) const { return arm_.in_range(joints_from_val3(joints)); }

val3::RunError Val3System::store(const val3::MoveOrder& order) {
  Drives& drives = cabinet_.drives;
  if (const val3::RunError error = move_error(); error != val3::kErrorNone) return error;
  tell_blend(order);
  const calib::JointVector from = end_of_queue(drives);
  const Eigen::Isometry3d tip_from_tool = arm_.tip_from_flange() * pose_from_val3(order.tool);
  const auto in_block = [this](const val3::Trsf& in_world) {
    return arm_.block_from_world() * pose_from_val3(in_world);
  };
  ToolPath way;
  if (order.shape == val3::MoveOrder::Shape::kJoint) searched_ = false;
  switch (order.shape) {
    case val3::MoveOrder::Shape::kJoint:
      way.path = {from, joints_from_val3(order.to)};
      way.complete = arm_.in_range(way.path.back());
      break;
    case val3::MoveOrder::Shape::kLine:
      way = line_to_pose(plant_, from, in_block(order.to_pose), tip_from_tool);
      break;
    case val3::MoveOrder::Shape::kCircle:
      way = arc_to_pose(plant_, from, in_block(order.via_pose), in_block(order.to_pose), tip_from_tool);
      break;
  }
  // A line or an arc goes on in the configuration it begins in; another one cannot be forced (page 150).
  if (order.shape != val3::MoveOrder::Shape::kJoint &&
      !is_allowed(order.config, arm_.config_of(from), arm_.config_of(way.path.back())))
    way.complete = false;
  way.complete = way.complete && order.reachable;
  if (way.complete) {
    sim::store(drives, plan_move(plant_, {std::move(way.path)}, descriptor_from_val3(order.descriptor),
                                 tip_from_tool));
  } else {
    const std::string why = move_obstacle(plant_, arm_, order, from, way);
    sim::store(drives, impossible_move(from, impossible_move_text(order, why)));
  }
  return val3::kErrorNone;
}

/// Behind a move that would have gone over into this one.
void Val3System::tell_blend(const val3::MoveOrder& order) {
  if (last_move_blends_ && !is_empty() && !told_blend_) {
    told_blend_ = true;
    keep("blends are not simulated: every move stops at its end, and takes longer than on a controller");
  }
  last_move_blends_ = order.descriptor.blend != val3::Blend::kOff;
}

bool Val3System::store_is_full() const {
  const Drives& drives = cabinet_.drives;
  return (drives.braking ? drives.after_reset : drives.queue).size() >= options_.moves_max;
}

val3::RunError Val3System::move_error() const { return static_cast<val3::RunError>(cabinet_.drives.error); }

const std::string& Val3System::why_move_failed() const { return cabinet_.drives.error_why; }

val3::Joint Val3System::last_stored() const { return val3_from_joints(end_of_queue(cabinet_.drives)); }

void Val3System::reset_motion(const std::optional<val3::Joint>& start) {
  sim::reset_motion(cabinet_.drives,
                    start ? std::optional(joints_from_val3(*start)) : std::optional<calib::JointVector>());
}

void Val3System::stop_move() { sim::stop_move(cabinet_.drives); }
void Val3System::restart_move() { sim::restart_move(cabinet_.drives); }
bool Val3System::is_empty() const { return sim::is_empty(cabinet_.drives); }
bool Val3System::is_settled() const { return cabinet_.arm_stands(); }
double Val3System::move_id() const { return sim::move_id(cabinet_.drives); }
double Val3System::last_move_id() const { return cabinet_.drives.last_id; }
void Val3System::set_move_id(double id) { sim::set_move_id(cabinet_.drives, id); }
void Val3System::set_auto_connect(bool on) { cabinet_.drives.auto_connect = on; }
bool Val3System::auto_connect() const { return cabinet_.drives.auto_connect; }

}  // namespace sim
