#pragma once

#include <optional>

#include "calib_core/collision.hpp"
#include "calib_core/joint_vector.hpp"
#include "calib_core/kinematic_model.hpp"

namespace calib {

/// How much nearer than the clearance two things may come between the postures that find_clash_on_way looks
/// at.
inline constexpr double kSweptErrorMaxMetres = 1e-3;

/// find_clash on a straight joint move, both ends included. Conservative advancement: the next look comes
/// when the joints have gone far enough to use up the least distance (Mirtich, Impulse-based dynamic
/// simulation of rigid body systems, 1996), so nothing deeper than kSweptErrorMaxMetres is missed.
std::optional<Clash> find_clash_on_way(const CollisionScene& scene, const KinematicModel& model,
                                       const JointVector& from, const JointVector& to, double clearance_m);

}  // namespace calib
