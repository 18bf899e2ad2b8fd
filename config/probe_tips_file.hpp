#pragma once

#include <vector>

#include "calib_core/motion/collision.hpp"
#include "config/cell.hpp"
#include "config/json_value.hpp"

namespace cell {

/// Whether a body of the probe is the ball of this tip by the drawing.
bool is_ball_of(const ProbeTip& tip, const calib::Capsule& body);

/// Whether it is the stem that holds this ball: it ends at it.
bool is_stem_of(const ProbeTip& tip, const calib::Capsule& body);

/// The bodies of the tips may be as far from where they are drawn as each tip's ball.
void loosen_bodies(Probe& probe);

/// A probe's "tips": the further ones of a star stylus. The radius and the bodies of `probe` are read
/// already. Refused are balls that may touch each other, a ball that trips before it touches, and a tip whose
/// ball or stem is not among the bodies: planner and simulator find them there. ConfigError.
std::vector<ProbeTip> probe_tips_from_json(const JsonValue& value, const Probe& probe);

}  // namespace cell
