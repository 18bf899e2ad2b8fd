#include "calib_core/kinematics/error_parameters.hpp"

#include <algorithm>
#include <stdexcept>

#include "calib_core/kinematics/gravity.hpp"

namespace calib {
namespace {

constexpr std::array kKindsInOrder{ParameterKind::kAlpha, ParameterKind::kD, ParameterKind::kTheta,
                                   ParameterKind::kR, ParameterKind::kBeta};

std::array<ErrorParameter, kErrorParameterCount> list_parameters() {
  std::array<ErrorParameter, kErrorParameterCount> parameters;
  std::size_t next = 0;
  for (int frame = 0; frame < kFrameCount; ++frame) {
    for (const ParameterKind kind : kKindsInOrder) {
      // alpha0, d0 and beta0 are null by definition (section II).
      const bool exists = frame > 0 || kind == ParameterKind::kTheta || kind == ParameterKind::kR;
      if (exists) parameters[next++] = {frame, kind};
    }
  }
  return parameters;
}

std::string_view kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kAlpha:
      return "alpha";
    case ParameterKind::kD:
      return "d";
    case ParameterKind::kTheta:
      return "theta";
    case ParameterKind::kR:
      return "r";
    case ParameterKind::kBeta:
      return "beta";
  }
  return "";
}

template <class Model>
auto& value_of(Model& model, const ErrorParameter& parameter) {
  auto& link = model.links[static_cast<std::size_t>(parameter.frame)];
  switch (parameter.kind) {
    case ParameterKind::kAlpha:
      return link.alpha_rad;
    case ParameterKind::kD:
      return link.d_m;
    case ParameterKind::kTheta:
      return link.theta_rad;
    case ParameterKind::kR:
      return link.r_m;
    case ParameterKind::kBeta:
      return link.beta_rad;
  }
  throw std::logic_error("parameter_value: no such kind");
}

/// Derivatives of each joint's deflection by the parameters beside rigid kinematics; the torques are held
/// constant.
struct Deflections {
  JointVector by_compliance = JointVector::Zero();         // of the joint itself, Nm
  Eigen::Matrix<double, kJointCount, kMassCount> by_mass;  // rad; only of a compliant arm
  bool is_compliant = false;
};

Deflections deflections(const PreparedModel& prepared, const Chain& chain) {
  Deflections result;
  if (!prepared.has_masses) return result;
  result.is_compliant = prepared.is_compliant;
  if (!result.is_compliant) {
    result.by_compliance = gravity_torques_nm(prepared, chain);
    return result;
  }
  const Eigen::Map<const JointVector> compliance(prepared.model.compliance_rad_per_nm.data());
  const auto torques_nm = gravity_torques_of_masses_nm(prepared, chain);
  result.by_compliance = torques_nm.rowwise().sum();
  result.by_mass = compliance.asDiagonal() * torques_nm;
  return result;
}

/// Index of a frame's theta. The five parameters of a frame are contiguous: alpha d theta r beta.
constexpr Eigen::Index theta_index(Eigen::Index frame) { return frame == 0 ? 0 : 5 * frame - 1; }

/// Derivatives along a unit vector of a point fixed in R_last_frame.
ArmRow derivatives_along(const PreparedModel& prepared, const Chain& chain, const Deflections& deflections,
                         const Eigen::Vector3d& point_m, int last_frame, const Eigen::Vector3d& direction) {
  ArmRow row = ArmRow::Zero();
  // A rotation about an axis through the frame's origin moves the point along `direction` by axis . lever, a
  // translation along the axis by axis . direction. theta and r act about and along z of R_j; alpha and d of
  // the next frame about and along x of R_j rotated by its beta; that beta about y of R_j.
  for (Eigen::Index frame = 0; frame <= last_frame; ++frame) {
    const auto& here = chain.block_from_frame[static_cast<std::size_t>(frame)];
    const Eigen::Vector3d lever = (point_m - here.translation()).cross(direction);
    const auto x = here.linear().col(0), y = here.linear().col(1), z = here.linear().col(2);
    const double about_z = z.dot(lever), along_z = z.dot(direction);
    const Eigen::Index theta = theta_index(frame);
    row[theta] = about_z;
    row[theta + 1] = along_z;
    if (frame == last_frame) break;
    const CosSin& beta = prepared.beta[static_cast<std::size_t>(frame) + 1];
    const Eigen::Index alpha = theta_index(frame + 1) - 2;
    row[alpha] = beta.cos * x.dot(lever) - beta.sin * about_z;
    row[alpha + 1] = beta.cos * x.dot(direction) - beta.sin * along_z;
    row[alpha + 4] = y.dot(lever);
  }
  JointVector by_joint = JointVector::Zero();
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    if (prepared.model.joint_types[index] == JointType::kPrismatic) continue;
    by_joint[joint] = prepared.model.gains[index] * row[theta_index(joint + 1)];
    row[nongeometric_index(harmonic_position(joint))] = by_joint[joint] * chain.turned[index].cos;
    row[nongeometric_index(harmonic_position(joint)) + 1] = by_joint[joint] * chain.turned[index].sin;
    const CosSin twice = twice_a_turn(chain.turned[index]);
    row[nongeometric_index(second_harmonic_position(joint))] = by_joint[joint] * twice.cos;
    row[nongeometric_index(second_harmonic_position(joint)) + 1] = by_joint[joint] * twice.sin;
  }
  if (prepared.has_periods) {
    const auto phases = ripple_phases(prepared.model, chain.commanded);
    for (int joint = 0; joint < kJointCount; ++joint) {
      const CosSin& phase = phases[static_cast<std::size_t>(joint)];
      row[nongeometric_index(ripple_position(joint))] = by_joint[joint] * phase.cos;
      row[nongeometric_index(ripple_position(joint)) + 1] = by_joint[joint] * phase.sin;
    }
  }
  row.segment<kJointCount>(nongeometric_index(compliance_position(0))) =
      by_joint.cwiseProduct(deflections.by_compliance);
  if (deflections.is_compliant) {
    row.segment<kMassCount>(nongeometric_index(mass_position(1))).noalias() =
        by_joint.transpose() * deflections.by_mass;
  }
  return row;
}

}  // namespace

ParameterGroup ErrorParameter::group() const {
  if (frame == 7) return ParameterGroup::kTool;
  // theta0 r0 alpha1 d1 theta1 r1 are the pose of the block; beta1 does not add a direction to them.
  return frame <= 1 && kind != ParameterKind::kBeta ? ParameterGroup::kBlockPose : ParameterGroup::kArm;
}

std::string ErrorParameter::name() const { return std::string(kind_name(kind)) + std::to_string(frame); }

const std::array<ErrorParameter, kErrorParameterCount>& error_parameters() {
  static const auto parameters = list_parameters();
  return parameters;
}

std::string arm_parameter_name(int index) {
  if (index < kErrorParameterCount) return error_parameters()[static_cast<std::size_t>(index)].name();
  return nongeometric_parameters()[static_cast<std::size_t>(index - kErrorParameterCount)].name();
}

bool is_place_error(int index) {
  return index < kErrorParameterCount && error_parameters()[static_cast<std::size_t>(index)].frame <= 1;
}

ArmVector errors_by_growth(const KinematicModel& model, double share) {
  ArmVector errors = ArmVector::Zero();
  const auto& all = error_parameters();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const ErrorParameter& parameter = all[static_cast<std::size_t>(i)];
    const bool is_length = parameter.kind == ParameterKind::kD || parameter.kind == ParameterKind::kR;
    if (is_length && parameter.frame > 1 && parameter.frame < kFrameCount - 1)
      errors[i] = share * parameter_value(model, i);
  }
  return errors;
}

std::optional<int> error_parameter_index(std::string_view name) {
  const auto& all = error_parameters();
  const auto found =
      std::ranges::find_if(all, [&](const auto& parameter) { return parameter.name() == name; });
  if (found == all.end()) return std::nullopt;
  return static_cast<int>(found - all.begin());
}

double parameter_value(const KinematicModel& model, int index) {
  return value_of(model, error_parameters()[static_cast<std::size_t>(index)]);
}

KinematicModel apply(const KinematicModel& model, const ErrorVector& errors) {
  KinematicModel changed = model;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    value_of(changed, error_parameters()[static_cast<std::size_t>(i)]) += errors[i];
  }
  return changed;
}

KinematicModel apply(const KinematicModel& model, const ArmVector& errors) {
  KinematicModel changed = apply(model, errors.head<kErrorParameterCount>());
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const auto number = static_cast<int>(joint);
    changed.compliance_rad_per_nm[joint] += errors[nongeometric_index(compliance_position(number))];
    changed.harmonics_rad[joint].cos += errors[nongeometric_index(harmonic_position(number))];
    changed.harmonics_rad[joint].sin += errors[nongeometric_index(harmonic_position(number)) + 1];
    changed.second_harmonics_rad[joint].cos += errors[nongeometric_index(second_harmonic_position(number))];
    changed.second_harmonics_rad[joint].sin +=
        errors[nongeometric_index(second_harmonic_position(number)) + 1];
    changed.ripples_rad[joint].cos += errors[nongeometric_index(ripple_position(number))];
    changed.ripples_rad[joint].sin += errors[nongeometric_index(ripple_position(number)) + 1];
  }
  for (int frame = 1; frame < kFrameCount; ++frame) {
    changed.masses[static_cast<std::size_t>(frame)].mass_kg *=
        1.0 + errors[nongeometric_index(mass_position(frame))];
  }
  return changed;
}

Eigen::Matrix<double, 3, kErrorParameterCount> tip_derivatives(const KinematicModel& model,
                                                               const Chain& chain) {
  return tip_arm_derivatives(model, chain).leftCols<kErrorParameterCount>();
}

ArmRow distance_derivatives(const PreparedModel& prepared, const Chain& chain,
                            const Eigen::Vector3d& outward) {
  return distance_derivatives(prepared, chain, chain.tip_in_block_m(), outward);
}

ArmRow distance_derivatives(const PreparedModel& prepared, const Chain& chain,
                            const Eigen::Vector3d& point_in_block_m, const Eigen::Vector3d& outward) {
  return derivatives_along(prepared, chain, deflections(prepared, chain), point_in_block_m, kFrameCount - 1,
                           outward);
}

ArmRow distance_derivatives(const KinematicModel& model, const Chain& chain, const Eigen::Vector3d& outward) {
  return distance_derivatives(prepare(model), chain, outward);
}

Eigen::Matrix<double, 3, kArmParameterCount> tip_arm_derivatives(const KinematicModel& model,
                                                                 const Chain& chain) {
  return point_arm_derivatives(model, chain, chain.tip_in_block_m(), kFrameCount - 1);
}

Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const PreparedModel& prepared,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame) {
  const Deflections deflected = deflections(prepared, chain);
  Eigen::Matrix<double, 3, kArmParameterCount> derivatives;
  for (int i = 0; i < 3; ++i) {
    derivatives.row(i) =
        derivatives_along(prepared, chain, deflected, point_in_block_m, last_frame, Eigen::Vector3d::Unit(i));
  }
  return derivatives;
}

Eigen::Matrix<double, 3, kArmParameterCount> point_arm_derivatives(const KinematicModel& model,
                                                                   const Chain& chain,
                                                                   const Eigen::Vector3d& point_in_block_m,
                                                                   int last_frame) {
  return point_arm_derivatives(prepare(model), chain, point_in_block_m, last_frame);
}

}  // namespace calib
