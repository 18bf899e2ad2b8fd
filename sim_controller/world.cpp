#include "sim_controller/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "calib_core/kinematics/gravity.hpp"
#include "sim_controller/contact.hpp"
#include "sim_controller/drives.hpp"
#include "sim_controller/yielding_bodies.hpp"

namespace sim {
namespace {

/// The true model is recomputed when the arm's temperature has changed by this much: 20 nm at reach.
constexpr double kPreparedWithinKelvins = 1e-3;
/// A joint may turn back inside a tick, where a straight line asks it to; the way to its turn is less.
constexpr double kTurnMarginMetres = 5e-6;

calib::KinematicModel grown(const calib::KinematicModel& model, double growth) {
  calib::KinematicModel warm = model;
  for (std::size_t frame = 2; frame <= calib::kJointCount; ++frame) {
    warm.links[frame].d_m *= growth;
    warm.links[frame].r_m *= growth;
  }
  return warm;
}

void prepare_arm(const Plant& plant, World& world) {
  world.arm =
      calib::prepare(grown(plant.truth, 1.0 + plant.hidden.warming.arm_expansion_per_k * world.rise_k));
  world.prepared_rise_k = world.rise_k;
  world.to_edge_m = world.to_hit_m = -1.0;
}

double span_m(const calib::LinkParameters& link) { return std::abs(link.d_m) + std::abs(link.r_m); }

/// How far a body's farthest point is from the origin of the frame before its own; from its own axis when
/// that frame's joint turns it.
double extent_m(const calib::KinematicModel& model, const calib::Capsule& body, bool from_own_axis) {
  const calib::LinkParameters& link = model.links[static_cast<std::size_t>(body.frame)];
  const auto of_point = [&](const Eigen::Vector3d& point_m) {
    const double off_axis_m = point_m.head<2>().norm() + body.radius_m;
    return from_own_axis ? off_axis_m : off_axis_m + std::abs(link.d_m) + std::abs(link.r_m + point_m.z());
  };
  return std::max(of_point(body.from_m), of_point(body.to_m));
}

/// What a joint's turn by 1 rad moves beside its own frames: gravity turns joints 2 and 3 as the arm's weight
/// gets elsewhere.
double droop_lever_m(const calib::KinematicModel& model, const calib::JointVector& levers_m) {
  double reach_m = 0.0;
  for (std::size_t frame = 2; frame < calib::kFrameCount; ++frame) reach_m += span_m(model.links[frame]);
  double moment_nm = 0.0;  // what no torque of gravity exceeds, nor its change over a radian
  for (const calib::PointMass& mass : model.masses)
    moment_nm += calib::kFreeFall * mass.mass_kg * (reach_m + mass.center_in_frame_m.norm());
  double lever_m = 0.0;
  for (int joint = 0; joint < calib::kJointCount; ++joint)
    lever_m +=
        std::abs(model.compliance_rad_per_nm[static_cast<std::size_t>(joint)]) * moment_nm * levers_m[joint];
  return lever_m;
}

/// Levers of the joints themselves, with what ripple and droop add to a joint's motion.
calib::JointVector with_gears(const Plant& plant, const calib::KinematicModel& model,
                              calib::JointVector levers_m) {
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    const cell::Ripple& ripple = plant.hidden.ripple[index];
    levers_m[joint] *= std::abs(model.gains[index]) * (1.0 + ripple.amplitude_rad * ripple.periods_per_turn);
  }
  return levers_m.array() + droop_lever_m(model, levers_m);
}

/// How far the centre of a ball is from the origin of R_7, at most.
double star_reach_m(const Plant& plant) {
  double reach_m = 0.0;
  for (const TipBall& tip : plant.tips) reach_m = std::max(reach_m, tip.center_m.norm());
  return reach_m;
}

double least_trip_distance_m(const Plant& plant) {
  double least_m = plant.trip_distance_m;
  for (const TipBall& tip : plant.tips) least_m = std::min(least_m, tip.trip_distance_m);
  return least_m;
}

void bound_levers(const Plant& plant, World& world) {
  const cell::Warming& warming = plant.hidden.warming;
  const calib::KinematicModel model =
      grown(plant.truth, 1.0 + warming.arm_expansion_per_k * std::max(0.0, warming.arm_rise_k));
  calib::JointVector tip_m = calib::JointVector::Constant(star_reach_m(plant)),
                     body_m = calib::JointVector::Zero();
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const int own_frame = joint + 1;
    for (int frame = own_frame + 1; frame < calib::kFrameCount; ++frame)
      tip_m[joint] += span_m(model.links[static_cast<std::size_t>(frame)]);
    for (const calib::Capsule& body : plant.scene.bodies) {
      if (body.frame < own_frame) continue;
      double lever_m = extent_m(model, body, body.frame == own_frame);
      for (int frame = own_frame + 1; frame < body.frame; ++frame)
        lever_m += span_m(model.links[static_cast<std::size_t>(frame)]);
      body_m[joint] = std::max(body_m[joint], lever_m);
    }
  }
  world.tip_levers_m = with_gears(plant, model, tip_m);
  world.body_levers_m = with_gears(plant, model, body_m);
  // The trip distance changes with the push's direction: as the stylus turns, and as the ball goes around an
  // edge (by its way over its distance from there).
  const cell::TrueProbe& probe = plant.hidden.probe;
  const double per_rad_m = std::abs(probe.pretravel_tilt_m) + 4.0 * std::abs(probe.lobes_m);
  constexpr double kEdgeDistanceMinMetres = 1e-4;
  world.tip_levers_m *= 1.0 + per_rad_m / std::max(least_trip_distance_m(plant), kEdgeDistanceMinMetres);
  world.tip_levers_m.array() += per_rad_m;
  world.body_levers_m = world.body_levers_m.cwiseMax(world.tip_levers_m);
}

/// The link stays where it is until the drive has gone through the play.
calib::JointVector slack_at(const Plant& plant, const World& world, const calib::JointVector& joints) {
  const calib::JointVector half_rad = 0.5 * plant.hidden.backlash_rad;
  return (world.slack_rad - (joints - world.joints)).cwiseMin(half_rad).cwiseMax(-half_rad);
}

calib::JointVector link_joints(const Plant& plant, const World& world, const calib::JointVector& joints) {
  calib::JointVector links = joints + slack_at(plant, world, joints) + world.stop_error_rad;
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const cell::Ripple& ripple = plant.hidden.ripple[static_cast<std::size_t>(joint)];
    if (ripple.amplitude_rad == 0.0) continue;
    links[joint] +=
        ripple.amplitude_rad * std::sin(ripple.periods_per_turn * joints[joint] + ripple.phase_rad);
  }
  return links;
}

void stand_at(const Plant& plant, World& world, const calib::JointVector& joints) {
  world.slack_rad = slack_at(plant, world, joints);
  world.joints = joints;
}

/// In which latch steps of the tick the material deflects the stylus. `way_m`: no ball goes farther in it.
unsigned deflected_steps(const Plant& plant, World& world, const TickMotion& motion, double way_m) {
  if (world.to_edge_m > way_m) {
    world.to_edge_m -= way_m;
    return world.deflected ? kAllSteps : 0U;
  }
  unsigned steps = 0;
  calib::JointVector before = motion.from;
  for (int k = 0; k < kLatchStepsPerTick; ++k) {
    const calib::JointVector joints = motion.at(static_cast<double>(k + 1) / kLatchStepsPerTick);
    world.to_edge_m -= world.tip_levers_m.dot((joints - before).cwiseAbs());
    before = joints;
    if (world.to_edge_m <= 0.0) {
      const double gap_m =
          trip_gap_m(plant, true_chain(plant, world, joints).block_from_frame.back(), world.noise_m);
      world.deflected = gap_m <= 0.0;
      world.to_edge_m = std::abs(gap_m);
    }
    if (world.deflected) steps |= 1U << k;
  }
  return steps;
}

/// `way_m`: no point of a body goes farther in the tick. Looks at the tick's end, where that can be a hit.
void watch_bodies(const Plant& plant, World& world, const calib::JointVector& at_end, double way_m) {
  if (world.to_hit_m > way_m) {
    world.to_hit_m -= way_m;
    return;
  }
  const calib::Chain chain = true_chain(plant, world, at_end);
  // A deflected stylus gives way, up to its overtravel.
  const double yields_m =
      world.deflected ? plant.overtravel_m + trip_gap_m(plant, chain.block_from_frame.back(), world.noise_m)
                      : 0.0;
  const Room room = room_around(
      plant.scene, chain, yields_m > 0.0 ? std::span<const int>(world.yielding) : std::span<const int>());
  world.to_hit_m = std::max(0.0, yields_m > 0.0 ? std::min(room.way_m, yields_m) : room.way_m);
  world.collision.reset();
  if (room.way_m <= 0.0) world.collision = room.hit;
}

}  // namespace

World make_world(const Plant& plant) {
  World world;
  world.joints = plant.start_joints;
  world.slack_rad.setZero();
  world.stop_error_rad.setZero();
  world.yielding = yielding_bodies(plant);
  prepare_arm(plant, world);
  bound_levers(plant, world);
  return world;
}

void take_plant(const Plant& plant, World& world) {
  prepare_arm(plant, world);
  bound_levers(plant, world);
}

calib::Chain true_chain(const Plant& plant, const World& world, const calib::JointVector& joints) {
  return calib::forward_chain(world.arm, link_joints(plant, world, joints));
}

Eigen::Vector3d true_tip_m(const Plant& plant, const World& world, const calib::JointVector& joints) {
  return true_chain(plant, world, joints).tip_in_block_m();
}

calib::JointVector encoder_reading(const Plant& plant, const calib::JointVector& joints) {
  const double step_rad = plant.hidden.encoder_step_rad;
  if (step_rad == 0.0) return joints;
  return (joints / step_rad).array().round() * step_rad;
}

void pass(const Plant& plant, World& world, double seconds) {
  const cell::Warming& warming = plant.hidden.warming;
  const double final_k = world.powered ? warming.arm_rise_k : 0.0;
  if (world.rise_k == final_k) return;
  world.rise_k += (final_k - world.rise_k) * -std::expm1(-seconds / warming.arm_time_constant_s);
  if (std::abs(world.rise_k - world.prepared_rise_k) > kPreparedWithinKelvins) prepare_arm(plant, world);
}

Sensed sense(const Plant& plant, World& world, const TickMotion& motion) {
  pass(plant, world, kTickSeconds);
  if (motion.from != world.joints) {
    stand_at(plant, world, motion.from);
    world.to_edge_m = world.to_hit_m = -1.0;
  }
  const calib::JointVector way = (motion.to - motion.from).cwiseAbs();
  const double margin_m = way.isZero(0.0) ? 0.0 : kTurnMarginMetres;
  const bool was_deflected = world.deflected;
  const unsigned deflected = deflected_steps(plant, world, motion, world.tip_levers_m.dot(way) + margin_m);
  if (world.deflected != was_deflected) world.to_hit_m = -1.0;
  watch_bodies(plant, world, motion.to, world.body_levers_m.dot(way) + margin_m);
  stand_at(plant, world, motion.to);

  const ProbeTick seen = step(world.probe, deflected);
  return {world.probe.inputs, seen.edge_share, seen.edges, world.collision};
}

void begin_search(const Plant& plant, World& world, std::mt19937_64& chance) {
  world.noise_m = plant.touch_noise_m * gaussian(chance);
  const calib::JointVector& std_rad = plant.hidden.repeatability_rad;
  for (int joint = 0; joint < calib::kJointCount; ++joint)
    world.stop_error_rad[joint] = std_rad[joint] == 0.0 ? 0.0 : std_rad[joint] * gaussian(chance);
  world.to_edge_m = world.to_hit_m = -1.0;
}

double gaussian(std::mt19937_64& chance) {
  // Box and Muller; std::normal_distribution differs between libraries.
  const auto uniform = [&chance] { return (static_cast<double>(chance() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace sim
