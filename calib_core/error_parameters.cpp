#include "calib_core/error_parameters.hpp"

#include <algorithm>
#include <cmath>

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
      break;
  }
  return link.beta_rad;
}

}  // namespace

ParameterGroup ErrorParameter::group() const {
  if (frame == 7) return ParameterGroup::kTool;
  // theta0 r0 alpha1 d1 theta1 r1 say where the block stands; beta1 is the same direction as these.
  return frame <= 1 && kind != ParameterKind::kBeta ? ParameterGroup::kPlace : ParameterGroup::kArm;
}

std::string ErrorParameter::name() const { return std::string(kind_name(kind)) + std::to_string(frame); }

const std::array<ErrorParameter, kErrorParameterCount>& error_parameters() {
  static const auto parameters = list_parameters();
  return parameters;
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

Eigen::Matrix<double, 3, kErrorParameterCount> tip_derivatives(const KinematicModel& model,
                                                               const Chain& chain) {
  Eigen::Matrix<double, 3, kErrorParameterCount> derivatives;
  const Eigen::Vector3d tip = chain.tip_in_block_m();
  const auto& parameters = error_parameters();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const ErrorParameter& parameter = parameters[static_cast<std::size_t>(i)];
    const auto frame = static_cast<std::size_t>(parameter.frame);
    const Eigen::Isometry3d& here = chain.block_from_frame[frame];
    const Eigen::Isometry3d before =
        frame == 0 ? Eigen::Isometry3d::Identity() : chain.block_from_frame[frame - 1];
    const double beta = model.links[frame].beta_rad;
    // theta and r act about and along z of R_j; alpha and d about and along x of R_(j-1) once turned by beta;
    // beta about y of R_(j-1). Rotations leave the displacement axis x (tip - point on the axis).
    const Eigen::Vector3d z_here = here.linear().col(2);
    const Eigen::Vector3d x_turned =
        std::cos(beta) * before.linear().col(0) - std::sin(beta) * before.linear().col(2);
    switch (parameter.kind) {
      case ParameterKind::kAlpha:
        derivatives.col(i) = x_turned.cross(tip - before.translation());
        break;
      case ParameterKind::kD:
        derivatives.col(i) = x_turned;
        break;
      case ParameterKind::kTheta:
        derivatives.col(i) = z_here.cross(tip - here.translation());
        break;
      case ParameterKind::kR:
        derivatives.col(i) = z_here;
        break;
      case ParameterKind::kBeta:
        derivatives.col(i) = before.linear().col(1).cross(tip - before.translation());
        break;
    }
  }
  return derivatives;
}

}  // namespace calib
