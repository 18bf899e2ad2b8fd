#include "service/acquisition/place_check.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {

PlaceCheck::PlaceCheck(calib::PlanningProblem problem, const BlockPose& place)
    : arm_error_m_(problem.nominal_position_error_m),
      face_error_m_(std::max(arm_error_m_, place_error_m(place.covariance, problem.faces))) {
  for (const calib::RegistrationTouch& touch : place.touches)
    problem.knowledge.touch_noise_m = std::max(problem.knowledge.touch_noise_m, touch.std_m);
  aim_.emplace(problem);
  for (const calib::RegistrationTouch& touch : place.touches) {
    aim_->add({.face = touch.face, .joints = touch.joints});
    faces_.insert(touch.face);
  }
}

std::optional<Fault> PlaceCheck::check(const calib::Touch& touch) {
  if (!aim_ || !faces_met_.insert(touch.face).second) return std::nullopt;
  const calib::PredictedContact contact = aim_->add(touch);
  if (std::ranges::includes(faces_met_, faces_)) aim_.reset();
  const bool is_known = contact.predicted_position_error_m < arm_error_m_;
  const double expected_m = is_known ? contact.predicted_position_error_m : face_error_m_;
  if (std::abs(contact.position_error_m) <= expected_m) return std::nullopt;
  return Fault{FaultCode::kBlockMoved,
               fmt::format("contact {1:.1f} mm off the located plane {0}; {2:.1f} mm at most were expected",
                           touch.face + 1, calib::mm_from_metres(contact.position_error_m),
                           calib::mm_from_metres(expected_m))};
}

Fault PlaceCheck::explain(Fault fault, int face) const {
  const bool missed = fault.code == FaultCode::kNoContact || fault.code == FaultCode::kEarlyContact ||
                      fault.code == FaultCode::kUnexpectedContact;
  if (!missed || !aim_ || faces_met_.contains(face)) return fault;
  return {FaultCode::kBlockMoved, fmt::format("at plane {} {}", face + 1, describe(fault.code).cause)};
}

}  // namespace cell
