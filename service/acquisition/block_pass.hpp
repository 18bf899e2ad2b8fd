#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"
#include "config/cell.hpp"

namespace cell {

/// A pass around the block keeps the ball this far off the faces, and goes this slowly.
inline constexpr double kPassMetres = 0.030;
inline constexpr double kPassSpeedShare = 0.1;

/// A posture over each of the touches that found the block, with the ball kPassMetres off the face, clear by
/// Cell::face_error_m(), in the touch's orientation where that is possible; in `cell` the block stands where
/// it was found. Touches for which there is none are left out as long as each of their faces keeps one; else
/// it is said which face has none.
std::variant<std::vector<calib::JointVector>, std::string> pass_postures(
    const Cell& cell, const std::vector<calib::RegistrationTouch>& touches);

/// A joint move and the postures on it.
struct PassWay {
  std::vector<calib::JointVector> via;
  calib::JointVector to;
};

/// Clear ways from where the arm stands by all of the postures to the park posture; nothing where one has no
/// clear way.
std::optional<std::vector<PassWay>> pass_ways(const Cell& cell, const calib::JointVector& from,
                                              std::vector<calib::JointVector> postures);

}  // namespace cell
