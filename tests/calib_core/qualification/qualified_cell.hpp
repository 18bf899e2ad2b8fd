#pragma once

#include <numbers>
#include <stdexcept>
#include <variant>
#include <vector>

#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/qualification/qualification.hpp"
#include "calib_core/qualification/qualification_planning.hpp"
#include "tests/calib_core/proof/proved_cell.hpp"
#include "tests/calib_core/tx90.hpp"

/// The drawn cell of proofs and checks, and the touches of a qualification in it.
namespace calib::qualified {

/// Of the paper's block on its plate (plane 5); outward normals of both pairs.
inline const std::vector<KnownLength> kLengths{{{2, 4}, 0.150, 0.0}, {{0, 3}, 0.150, 0.0}};

inline std::vector<ContactSurface> surfaces() {
  std::vector<ContactSurface> all;
  for (const Face& face : tx90::faces()) all.push_back(surface_of(face));
  return all;
}

inline PlanningProblem planning_problem() {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = 0.003},
                          .scene = tx90::scene(0.003),
                          .park_joints = tx90::park_joints(),
                          .tilt_max_rad = radians_from_degrees(70),
                          .candidate_count = kQualifyingCandidates};
  for (int face = 0; face < 5; ++face) problem.requests.push_back({face, 1, 20, 0});
  return problem;
}

inline std::vector<Touch> planned_touches() {
  const auto plan = plan_qualification(planning_problem(), kLengths);
  std::vector<Touch> touches;
  for (const PlannedTouch& planned : std::get<TouchPlan>(plan).touches)
    touches.push_back({planned.face, planned.joints, planned.role});
  return touches;
}

/// Errors of frame 7 that move the ball across the stylus and nothing else.
inline ErrorVector bent(double bend_m) {
  ErrorVector errors = ErrorVector::Zero();
  errors[error_parameter_index("d7").value()] = bend_m;
  return errors;
}

class Cell {
 public:
  Cell() : planned_(planned_touches()), chance_(7) {}

  [[nodiscard]] const std::vector<Touch>& planned() const { return planned_; }
  [[nodiscard]] const CalibrationRecord& record() const { return proved_.record(); }
  [[nodiscard]] const KinematicModel& true_arm() const { return proved_.true_arm(); }

  /// The planned touches as `arm` makes them.
  std::vector<Touch> touches(const KinematicModel& arm, const SidewaysPretravel& sideways = {},
                             double noise_m = proved::kNoiseMetres, double smaller_ball_m = 0.0) {
    std::vector<Touch> made = planned_;
    for (Touch& touch : made) {
      ContactSurface surface = proved_.surface(touch.face);
      surface.sideways = sideways;
      surface.offset_m += noise_m * study::normal(chance_) - smaller_ball_m;
      touch = moved_onto_plane(arm, surface, touch);
    }
    return made;
  }

  [[nodiscard]] QualificationProblem problem(bool with_calibration) const {
    QualificationProblem problem{.nominal = proved_.problem().nominal,
                                 .surfaces = proved_.problem().artefact.contact_planes,
                                 .lengths = kLengths,
                                 .limits = {.scatter_max_m = proved::kNoiseMetres}};
    if (with_calibration) problem.record = &proved_.record();
    return problem;
  }

 private:
  proved::Cell proved_;
  std::vector<Touch> planned_;
  UniformChance chance_;
};

}  // namespace calib::qualified
