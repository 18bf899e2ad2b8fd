#pragma once

#include <string>

#include "config/cell.hpp"

namespace cell {

/// The arm's frames as two tables of Denavit-Hartenberg parameters, from the block's frame to the centre of
/// the stylus ball. Both give the same poses; what a program calls DH may be either.
///
/// modified  (Khalil and Kleinfinger): row j is the pose of frame j in frame j-1,
///           Rot(y,beta) Rot(x,alpha) Trans(x,a) Rot(z,theta) Trans(z,d), rows 0 to 7
/// standard  (Denavit and Hartenberg): row j is Rot(z,theta) Trans(z,d) Rot(y,beta) Rot(x,alpha) Trans(x,a),
/// rows
///           0 to 7: the turn about x and the shift along it belong to the row before
///
/// At a joint gain * position is added to theta (to d where it slides). beta is Hayati's parameter, in the
/// place that is written above. Degrees and millimetres. Compliance, harmonics and ripple have no column.
/// `origin` is a line for people: where the arm is from.
///
/// CSV: lines of "# " first, then the heads convention,row,joint,theta_deg,d_mm,a_mm,alpha_deg,beta_deg,gain.
std::string dh_csv(const Arm& arm, const std::string& origin);
/// JSON of schema touchcal/dh/1 with the same rows.
std::string dh_json(const Arm& arm, const std::string& origin);

}  // namespace cell
