#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/probe.hpp"

namespace sim {

struct TickMotion;

/// What changes in the simulated cell beside the commanded joints: the arm's play in its gears, how warm
/// it is, what the probe feels. A value; sense() takes it from tick to tick.
struct World {
  bool powered = true;  // warms the arm up; the controller sets it
  Probe probe;          // with its injected troubles

  calib::JointVector joints;          // commanded, at the end of the last tick
  calib::JointVector slack_rad;       // how far each joint lags behind its drive, within half its backlash
  calib::JointVector stop_error_rad;  // repeatability: drawn for each search
  double noise_m = 0.0;               // of the trip distance, drawn for each search; positive trips early
  double rise_k = 0.0;                // of the arm's temperature

  calib::PreparedModel arm;  // the true model at prepared_rise_k
  double prepared_rise_k = 0.0;
  calib::JointVector tip_levers_m;   // a joint's turn by 1 rad moves no tip's ball farther
  calib::JointVector body_levers_m;  // ... and no point of a body, or of a ball
  std::vector<int> yielding;         // of the scene's bodies: what gives way while the probe is deflected
  double to_edge_m = -1.0;  // a ball is at least this far from where it trips or lets go; negative: unknown
  double to_hit_m = -1.0;   // bodies may go this far before two can meet; negative: unknown
  bool deflected = false;   // the material holds the stylus off its seat
  std::optional<std::string> collision;  // "stem hit block", while they touch
};

/// Cold, at the plant's start posture, the stylus in the air unless something is there.
World make_world(const Plant& plant);

/// The plant is another one from now on, because the block stands elsewhere: the arm stands where it did.
void take_plant(const Plant& plant, World& world);

/// Every true frame at commanded joints, reached from the world's present posture by a straight joint move.
calib::Chain true_chain(const Plant& plant, const World& world, const calib::JointVector& joints);
/// Where the centre of the first tip's ball really is, in R_-1.
Eigen::Vector3d true_tip_m(const Plant& plant, const World& world, const calib::JointVector& joints);

/// What the encoders say when the arm is at these joints: rounded to the encoder's step.
calib::JointVector encoder_reading(const Plant& plant, const calib::JointVector& joints);

/// One tick, seen by probe and bodies.
struct Sensed {
  ProbeInputs inputs;                // at the tick's end
  std::optional<double> edge_share;  // of the first edge the latch captured: a multiple of 0.05, up to 1
  int edges = 0;                     // rising edges of the latch input, with those too short for the latch
  std::optional<std::string> collision;  // "BODY hit THING", while they touch
};

/// Takes the world through one tick. A motion that does not begin where the last one ended means that
/// the arm was repositioned: allowed; the kept distances are computed again.
Sensed sense(const Plant& plant, World& world, const TickMotion& motion);

/// Draws what differs from one search to the next: the trip's noise and how exactly the arm came to its stop.
/// To be called at standstill, before the search.
void begin_search(const Plant& plant, World& world, std::mt19937_64& chance);

/// Simulated time passes without ticks (the controller does that when nothing can happen): the arm warms up
/// while powered, else cools down. sense() does it for its own tick.
void pass(const Plant& plant, World& world, double seconds);

/// One value with mean 0 and standard deviation 1, the same from the same generator on every machine.
double gaussian(std::mt19937_64& chance);

}  // namespace sim
