#pragma once

#include <stdexcept>
#include <string>

#include "config/cell.hpp"

namespace cell {

/// The form that was asked for has no place for something of this arm.
struct NotRepresentable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The arm as a URDF robot (wiki.ros.org/urdf/XML): links block (R_-1), base (R_0), link_1 to link_6 and
/// stylus (R_7, whose origin is the centre of the stylus ball), and the joints between them. Metres, radians,
/// kilograms. A joint value is a joint position as the controller shows it; a gain of -1 is an axis along -z.
///
/// Exact is the rigid arm: at each joint vector the pose of stylus in block is forward_kinematics() of the
/// arm without compliance, harmonics and ripple, within kPositionErrorMaxMetres. URDF has no words for these;
/// the file's comment says which of them the arm has. `origin` is a line for people: where the arm is from.
/// Throws NotRepresentable for a gain that is neither 1 nor -1.
std::string urdf_document(const Arm& arm, const std::string& origin);

}  // namespace cell
