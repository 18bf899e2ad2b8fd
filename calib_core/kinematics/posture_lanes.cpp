#include "calib_core/kinematics/posture_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "calib_core/kinematics/gravity.hpp"
#include "calib_core/numerics/wide_registers.hpp"

// Everything that takes or gives registers is inlined: how they would be passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace calib {
namespace {

/// A register, or as many as it takes: an extension of GCC and Clang, whose operators act on each lane.
typedef double Number __attribute__((vector_size(sizeof(Lanes))));
typedef long long Whole __attribute__((vector_size(sizeof(Lanes))));

struct Vector {
  Number x, y, z;
};

struct Turn {
  Number cos, sin;
};

[[gnu::always_inline]] inline Number all_lanes(double value) { return Number{value, value, value, value}; }

[[gnu::always_inline]] inline Number load(const Lanes& lanes) {
  Number number;
  std::memcpy(&number, lanes.of.data(), sizeof(number));
  return number;
}
[[gnu::always_inline]] inline Vector load(const VectorLanes& lanes) {
  return {load(lanes.x), load(lanes.y), load(lanes.z)};
}
[[gnu::always_inline]] inline void store(const Number& number, Lanes& lanes) {
  std::memcpy(lanes.of.data(), &number, sizeof(number));
}
[[gnu::always_inline]] inline void store(const Vector& vector, VectorLanes& lanes) {
  store(vector.x, lanes.x);
  store(vector.y, lanes.y);
  store(vector.z, lanes.z);
}

[[gnu::always_inline]] inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Vector operator*(const Number& factor, const Vector& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
[[gnu::always_inline]] inline Number dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Farther from 0 the library's functions are called: the reduction below would lose digits.
constexpr double kTurnMaxRadians = 1e3;

/// Taylor's series of sine and cosine up to pi / 4, where what is left of them is below 1e-19.
[[gnu::always_inline]] inline Turn near_zero(const Number& angle) {
  constexpr int kLastTerm = 18;
  const Number square = angle * angle;
  Number cos = all_lanes(1.0), sin = all_lanes(1.0);
  for (int n = kLastTerm; n > 0; n -= 2) {
    cos = 1.0 - square * cos * (1.0 / (n * (n - 1)));
    sin = 1.0 - square * sin * (1.0 / (n * (n + 1)));
  }
  return {cos, angle * sin};
}

[[gnu::always_inline]] inline Turn turn_of(const Number& angle_rad) {
  // Quarter turns are taken off first; pi / 2 in three parts, of which the first two have so few digits that
  // their multiples are exact.
  constexpr double kHigh = 0x1.921fb544p+0, kMiddle = 0x1.0b4611a6p-34, kLow = 0x1.3198a2e037073p-69;
  constexpr double kRounds = 0x1.8p52;  // adding it leaves no digits after the point
  const Number shifted = angle_rad * (2.0 / std::numbers::pi) + kRounds;
  const Number quarters = shifted - kRounds;
  const Turn rest = near_zero(((angle_rad - quarters * kHigh) - quarters * kMiddle) - quarters * kLow);
  Whole count;
  std::memcpy(&count, &shifted, sizeof(count));
  const auto is_odd = (count & 1) != 0;
  const Number cos = is_odd ? rest.sin : rest.cos, sin = is_odd ? rest.cos : rest.sin;
  const Turn turn{((count + 1) & 2) != 0 ? -cos : cos, (count & 2) != 0 ? -sin : sin};
  return turn;
}

[[gnu::always_inline]] inline bool any_above(const Number& number, double limit) {
  bool any = false;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) any = any || !(std::abs(number[lane]) <= limit);
  return any;
}

[[gnu::always_inline]] inline void store_turn(const Number& angle_rad, CosSinLanes& turned) {
  if (any_above(angle_rad, kTurnMaxRadians)) {
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      turned.cos.of[lane] = std::cos(angle_rad[lane]);
      turned.sin.of[lane] = std::sin(angle_rad[lane]);
    }
    return;
  }
  const Turn turn = turn_of(angle_rad);
  store(turn.cos, turned.cos);
  store(turn.sin, turned.sin);
}

[[gnu::always_inline]] inline void turn_joints(const std::array<double, kJointCount>& gains,
                                               PostureLanes& postures) {
  for (std::size_t joint = 0; joint < kJointCount; ++joint)
    store_turn(gains[joint] * load(postures.joints[joint]), postures.turned[joint]);
}

/// Rotates the first axis towards the second.
[[gnu::always_inline]] inline void rotate(const Turn& angle, Vector& first, Vector& second) {
  const Vector turned = angle.cos * first + angle.sin * second;
  second = angle.cos * second - angle.sin * first;
  first = turned;
}

[[gnu::always_inline]] inline Turn all_lanes(const CosSin& angle) {
  return {all_lanes(angle.cos), all_lanes(angle.sin)};
}

[[gnu::always_inline]] inline void rigid_chains(const PreparedModel& model, const PostureLanes& postures,
                                                ChainLanes& chains) {
  const Number zero = all_lanes(0.0), one = all_lanes(1.0);
  Vector x{one, zero, zero}, y{zero, one, zero}, z{zero, zero, one}, origin_m{zero, zero, zero};
  for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
    const LinkParameters& link = model.model.links[frame];
    Turn theta = all_lanes(model.theta[frame]);
    Number r_m = all_lanes(link.r_m);
    if (frame > 0 && frame <= kJointCount) {
      const std::size_t joint = frame - 1;
      if (model.model.joint_types[joint] == JointType::kRevolute) {
        const Number cos = load(postures.turned[joint].cos), sin = load(postures.turned[joint].sin);
        theta = {theta.cos * cos - theta.sin * sin, theta.sin * cos + theta.cos * sin};
      } else {
        r_m += model.model.gains[joint] * load(postures.joints[joint]);
      }
    }
    rotate(all_lanes(model.beta[frame]), z, x);
    rotate(all_lanes(model.alpha[frame]), y, z);
    origin_m = origin_m + all_lanes(link.d_m) * x;
    rotate(theta, x, y);
    origin_m = origin_m + r_m * z;
    ChainLanes::Frame& here = chains.frames[frame];
    store(x, here.x);
    store(y, here.y);
    store(z, here.z);
    store(origin_m, here.origin_m);
  }
}

[[gnu::always_inline]] inline Vector in_block(const ChainLanes::Frame& frame, const Eigen::Vector3d& vector) {
  return all_lanes(vector.x()) * load(frame.x) + all_lanes(vector.y()) * load(frame.y) +
         all_lanes(vector.z()) * load(frame.z);
}

[[gnu::always_inline]] inline Vector weight_per_kg(const PreparedModel& model, const ChainLanes& chains) {
  return all_lanes(kFreeFall) * in_block(chains.frames[0], model.down_in_frame_0);
}

/// gravity_torques_nm()
[[gnu::always_inline]] inline void torques_nm(const PreparedModel& model, const ChainLanes& chains,
                                              std::array<Lanes, kJointCount>& torques) {
  torques.fill({});
  const Vector free_fall = weight_per_kg(model, chains);
  double mass_kg = 0.0;
  Vector first_moment_kg_m{all_lanes(0.0), all_lanes(0.0), all_lanes(0.0)};
  for (std::size_t frame = kFrameCount - 1; frame > 0; --frame) {
    const PointMass& here = model.model.masses[frame];
    const Vector origin_m = load(chains.frames[frame].origin_m);
    mass_kg += here.mass_kg;
    first_moment_kg_m =
        first_moment_kg_m +
        all_lanes(here.mass_kg) * (in_block(chains.frames[frame], here.center_in_frame_m) + origin_m);
    const std::size_t joint = frame - 1;
    if (joint >= kJointCount || model.model.joint_types[joint] == JointType::kPrismatic) continue;
    const Vector about_joint_kg_m = first_moment_kg_m - all_lanes(mass_kg) * origin_m;
    store(model.model.gains[joint] * dot(load(chains.frames[frame].z), cross(about_joint_kg_m, free_fall)),
          torques[joint]);
  }
}

/// ripple_phases()
[[gnu::always_inline]] inline void set_ripple_phases(const PreparedModel& model, const PostureLanes& postures,
                                                     ChainLanes& chains) {
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const double periods = model.model.ripple_periods_per_turn[joint];
    if (periods == 0.0 || model.model.joint_types[joint] == JointType::kPrismatic) {
      chains.ripple_phases[joint] = {};
      continue;
    }
    store_turn(periods * model.model.gains[joint] * load(postures.joints[joint]),
               chains.ripple_phases[joint]);
  }
}

[[gnu::always_inline]] inline void chains_of(const PreparedModel& model, const PostureLanes& postures,
                                             ChainLanes& chains) {
  rigid_chains(model, postures, chains);
  chains.turned = postures.turned;
  if (model.has_periods) set_ripple_phases(model, postures, chains);
  if (!model.is_compliant && !model.has_harmonics && !model.has_periods) return;
  PostureLanes moved = postures;
  std::array<Lanes, kJointCount> torques{};
  if (model.is_compliant) torques_nm(model, chains, torques);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    Number by_rad = model.model.compliance_rad_per_nm[joint] * load(torques[joint]);
    if (model.model.joint_types[joint] == JointType::kRevolute) {
      const CosSin& first = model.model.harmonics_rad[joint];
      const CosSin& second = model.model.second_harmonics_rad[joint];
      const Number cos = load(postures.turned[joint].cos), sin = load(postures.turned[joint].sin);
      by_rad += first.cos * cos + first.sin * sin + second.cos * (cos * cos - sin * sin) +
                second.sin * (2.0 * cos * sin);
    }
    if (model.has_periods) {
      const CosSin& ripple = model.model.ripples_rad[joint];
      const CosSinLanes& phases = chains.ripple_phases[joint];
      by_rad += ripple.cos * load(phases.cos) + ripple.sin * load(phases.sin);
    }
    store(load(postures.joints[joint]) + by_rad, moved.joints[joint]);
  }
  turn_joints(model.model.gains, moved);
  rigid_chains(model, moved, chains);
}

/// Of compliances and masses; `by_joint` are the derivatives by the joints' positions.
[[gnu::always_inline]] inline void gravity_derivatives(const PreparedModel& model, const ChainLanes& chains,
                                                       const std::array<Number, kJointCount>& by_joint,
                                                       ArmRowLanes& rows) {
  const auto at = [&](int position) -> Lanes& {
    return rows[static_cast<std::size_t>(nongeometric_index(position))];
  };
  for (int joint = 0; joint < kJointCount; ++joint) at(compliance_position(joint)) = {};
  for (int frame = 1; frame <= kMassCount; ++frame) at(mass_position(frame)) = {};
  if (!model.has_masses) return;
  std::array<Lanes, kJointCount> torques;
  torques_nm(model, chains, torques);
  for (std::size_t joint = 0; joint < kJointCount; ++joint)
    store(by_joint[joint] * load(torques[joint]), at(compliance_position(static_cast<int>(joint))));
  if (!model.is_compliant) return;
  const Vector free_fall = weight_per_kg(model, chains);
  for (std::size_t frame = 1; frame < kFrameCount; ++frame) {
    const PointMass& mass = model.model.masses[frame];
    if (mass.mass_kg == 0.0) continue;
    const Vector center_m =
        in_block(chains.frames[frame], mass.center_in_frame_m) + load(chains.frames[frame].origin_m);
    Number sum = all_lanes(0.0);
    for (std::size_t joint = 0; joint < std::min<std::size_t>(frame, kJointCount); ++joint) {
      const double per_torque =
          model.model.gains[joint] * mass.mass_kg * model.model.compliance_rad_per_nm[joint];
      if (per_torque == 0.0 || model.model.joint_types[joint] == JointType::kPrismatic) continue;
      const ChainLanes::Frame& own = chains.frames[joint + 1];
      sum += by_joint[joint] * per_torque * dot(load(own.z), cross(center_m - load(own.origin_m), free_fall));
    }
    store(sum, at(mass_position(static_cast<int>(frame))));
  }
}

/// Of the cosines and sines of ripple.
[[gnu::always_inline]] inline void ripple_derivatives(const PreparedModel& model, const ChainLanes& chains,
                                                      const std::array<Number, kJointCount>& by_joint,
                                                      ArmRowLanes& rows) {
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const auto cosine =
        static_cast<std::size_t>(nongeometric_index(ripple_position(static_cast<int>(joint))));
    if (!model.has_periods) {
      rows[cosine] = rows[cosine + 1] = {};
      continue;
    }
    const CosSinLanes& phases = chains.ripple_phases[joint];
    store(by_joint[joint] * load(phases.cos), rows[cosine]);
    store(by_joint[joint] * load(phases.sin), rows[cosine + 1]);
  }
}

/// derivatives_along() of error_parameters.cpp, which says why.
[[gnu::always_inline]] inline void derivatives_of(const PreparedModel& model, const ChainLanes& chains,
                                                  const BallLanes& balls, ArmRowLanes& rows) {
  const Vector direction = load(balls.outward);
  const Vector ball_m = load(balls.center_m);
  std::array<Number, kJointCount> by_joint;
  for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
    const ChainLanes::Frame& here = chains.frames[frame];
    const Vector lever = cross(ball_m - load(here.origin_m), direction);
    const Vector x = load(here.x), z = load(here.z);
    const Number about_z = dot(z, lever), along_z = dot(z, direction);
    const std::size_t theta = frame == 0 ? 0 : 5 * frame - 1;
    store(about_z, rows[theta]);
    store(along_z, rows[theta + 1]);
    if (frame > 0 && frame <= kJointCount) by_joint[frame - 1] = about_z;
    if (frame == kFrameCount - 1) break;
    const CosSin& beta = model.beta[frame + 1];
    const std::size_t alpha = 5 * frame + 2;
    store(beta.cos * dot(x, lever) - beta.sin * about_z, rows[alpha]);
    store(beta.cos * dot(x, direction) - beta.sin * along_z, rows[alpha + 1]);
    store(dot(load(here.y), lever), rows[alpha + 4]);
  }
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const bool turns = model.model.joint_types[joint] == JointType::kRevolute;
    by_joint[joint] = (turns ? model.model.gains[joint] : 0.0) * by_joint[joint];
    const auto cosine =
        static_cast<std::size_t>(nongeometric_index(harmonic_position(static_cast<int>(joint))));
    const Number cos = load(chains.turned[joint].cos), sin = load(chains.turned[joint].sin);
    store(by_joint[joint] * cos, rows[cosine]);
    store(by_joint[joint] * sin, rows[cosine + 1]);
    const auto twice =
        static_cast<std::size_t>(nongeometric_index(second_harmonic_position(static_cast<int>(joint))));
    store(by_joint[joint] * (cos * cos - sin * sin), rows[twice]);
    store(by_joint[joint] * (2.0 * cos * sin), rows[twice + 1]);
  }
  ripple_derivatives(model, chains, by_joint, rows);
  gravity_derivatives(model, chains, by_joint, rows);
}

[[gnu::flatten]] void turn_narrow(const std::array<double, kJointCount>& gains, PostureLanes& postures) {
  turn_joints(gains, postures);
}
[[gnu::flatten]] void chains_narrow(const PreparedModel& model, const PostureLanes& postures,
                                    ChainLanes& chains) {
  chains_of(model, postures, chains);
}
[[gnu::flatten]] void derivatives_narrow(const PreparedModel& model, const ChainLanes& chains,
                                         const BallLanes& balls, ArmRowLanes& rows) {
  derivatives_of(model, chains, balls, rows);
}

CALIB_FOR_WIDE_REGISTERS void turn_wide(const std::array<double, kJointCount>& gains,
                                        PostureLanes& postures) {
  turn_joints(gains, postures);
}
CALIB_FOR_WIDE_REGISTERS void chains_wide(const PreparedModel& model, const PostureLanes& postures,
                                          ChainLanes& chains) {
  chains_of(model, postures, chains);
}
CALIB_FOR_WIDE_REGISTERS void derivatives_wide(const PreparedModel& model, const ChainLanes& chains,
                                               const BallLanes& balls, ArmRowLanes& rows) {
  derivatives_of(model, chains, balls, rows);
}

}  // namespace

const LaneArithmetic& narrow_lane_arithmetic() {
  static constexpr LaneArithmetic kNarrow{turn_narrow, chains_narrow, derivatives_narrow};
  return kNarrow;
}

const LaneArithmetic& lane_arithmetic() {
  static constexpr LaneArithmetic kWide{turn_wide, chains_wide, derivatives_wide};
  return has_wide_registers() ? kWide : narrow_lane_arithmetic();
}

}  // namespace calib
