#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// The arm's forward kinematics for numbers that carry derivatives (ceres::Jet), revolute joints with gain 1.
namespace bench {

/// alpha d theta r beta of a frame, the order of calib::error_parameters().
template <class T>
struct Link {
  std::array<T, 5> values;

  const T& alpha() const { return values[0]; }
  const T& d() const { return values[1]; }
  const T& theta() const { return values[2]; }
  const T& r() const { return values[3]; }
  const T& beta() const { return values[4]; }
};

template <class T>
using Links = std::array<Link<T>, calib::kFrameCount>;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// The nominal links with errors[k] added to parameter columns[k].
template <class T>
Links<T> links_with_errors(const calib::KinematicModel& nominal, const std::vector<int>& columns,
                           const T* errors) {
  Links<T> links;
  for (std::size_t frame = 0; frame < links.size(); ++frame) {
    const calib::LinkParameters& link = nominal.links[frame];
    links[frame] = {T(link.alpha_rad), T(link.d_m), T(link.theta_rad), T(link.r_m), T(link.beta_rad)};
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const calib::ErrorParameter& parameter = calib::error_parameters()[static_cast<std::size_t>(columns[k])];
    links[static_cast<std::size_t>(parameter.frame)].values[static_cast<std::size_t>(parameter.kind)] +=
        errors[k];
  }
  return links;
}

inline double joint_of_frame(const calib::JointVector& joints, std::size_t frame) {
  return frame > 0 && frame < calib::kFrameCount - 1 ? joints[static_cast<Eigen::Index>(frame - 1)] : 0.0;
}

/// R_7's origin in R_-1 as calib::forward_kinematics computes it: frame by frame, a rotation and a
/// translation.
template <class T>
Vector3<T> tip_by_frames(const Links<T>& links, const calib::JointVector& joints) {
  using std::cos;
  using std::sin;
  Eigen::Matrix<T, 3, 3> rotation = Eigen::Matrix<T, 3, 3>::Identity();
  Vector3<T> translation = Vector3<T>::Zero();
  for (std::size_t frame = 0; frame < links.size(); ++frame) {
    const Link<T>& link = links[frame];
    const T theta = link.theta() + joint_of_frame(joints, frame);
    const T ca = cos(link.alpha()), sa = sin(link.alpha());
    const T cb = cos(link.beta()), sb = sin(link.beta());
    const T ct = cos(theta), st = sin(theta);
    const Vector3<T> x(cb, T(0.0), -sb);
    const Vector3<T> y(sb * sa, ca, cb * sa);
    const Vector3<T> z(sb * ca, -sa, cb * ca);
    Eigen::Matrix<T, 3, 3> turned;
    turned.col(0) = x * ct + y * st;
    turned.col(1) = y * ct - x * st;
    turned.col(2) = z;
    const Vector3<T> along = x * link.d() + z * link.r();
    translation += rotation * along;
    rotation = (rotation * turned).eval();
  }
  return translation;
}

/// What no joint moves of a link, computed once for many touches.
template <class T>
struct Prepared {
  T cos_alpha, sin_alpha, d, theta, r, cos_beta, sin_beta;
};

template <class T>
std::array<Prepared<T>, calib::kFrameCount> prepare(const Links<T>& links) {
  using std::cos;
  using std::sin;
  std::array<Prepared<T>, calib::kFrameCount> prepared;
  for (std::size_t frame = 0; frame < links.size(); ++frame) {
    const Link<T>& link = links[frame];
    prepared[frame] = {cos(link.alpha()), sin(link.alpha()), link.d(),        link.theta(),
                       link.r(),          cos(link.beta()),  sin(link.beta())};
  }
  return prepared;
}

/// The same from the tip back to the block: a point is carried instead of rotations.
template <class T>
Vector3<T> tip_by_point(const std::array<Prepared<T>, calib::kFrameCount>& links,
                        const calib::JointVector& joints) {
  using std::cos;
  using std::sin;
  T x(0.0), y(0.0), z(0.0);
  for (std::size_t frame = links.size(); frame-- > 0;) {
    const Prepared<T>& link = links[frame];
    const T theta = link.theta + joint_of_frame(joints, frame);
    const T ct = cos(theta), st = sin(theta);
    z += link.r;
    const T turned_x = ct * x - st * y + link.d;
    const T turned_y = st * x + ct * y;
    y = link.cos_alpha * turned_y - link.sin_alpha * z;
    const T raised_z = link.sin_alpha * turned_y + link.cos_alpha * z;
    x = link.cos_beta * turned_x + link.sin_beta * raised_z;
    z = link.cos_beta * raised_z - link.sin_beta * turned_x;
  }
  return {x, y, z};
}

}  // namespace bench
