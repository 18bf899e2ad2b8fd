#include "calib_core/identification/face_distances.hpp"

#include <algorithm>
#include <cmath>

namespace calib {
namespace {

double rms(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.norm() / std::sqrt(static_cast<double>(values.size()));
}

struct Distances {
  Eigen::VectorXd nominal;
  Eigen::VectorXd calibrated;
};

Distances distances_of(const IdentificationProblem& problem, const IdentificationResult& result) {
  std::vector<ContactSurface> planes;
  correct_contact_planes(problem.artefact, result.artefact_errors, planes);
  return {signed_distances_m(problem.nominal, problem.artefact.contact_planes, problem.touches),
          signed_distances_m(result.calibrated, planes, problem.touches)};
}

}  // namespace

std::optional<double> found_offset_m(const IdentificationProblem& problem, const IdentificationResult& result,
                                     std::size_t face) {
  for (Eigen::Index k = 0; k < result.artefact_errors.size(); ++k) {
    const ArtefactParameter& parameter = problem.artefact.parameters[static_cast<std::size_t>(k)];
    const bool is_its_offset =
        parameter.kind == ArtefactKind::kFaceOffset && parameter.shifts[face].constant != 0.0;
    if (is_its_offset && !parameter.std) return result.artefact_errors[k];
  }
  return std::nullopt;
}

std::vector<TouchDistance> touch_distances(const IdentificationProblem& problem,
                                           const IdentificationResult& result) {
  const Distances distances = distances_of(problem, result);
  std::vector<TouchDistance> all;
  for (Eigen::Index i = 0; i < distances.nominal.size(); ++i)
    all.push_back({distances.nominal[i], distances.calibrated[i]});
  return all;
}

std::vector<std::size_t> touches_of(const IdentificationProblem& problem, const IdentificationResult& result,
                                    TouchRole role, int face) {
  std::vector<std::size_t> touches;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    if (problem.touches[i].role != role || problem.touches[i].face != face) continue;
    if (std::ranges::find(result.rejected, i, &RejectedTouch::touch) == result.rejected.end())
      touches.push_back(i);
  }
  return touches;
}

std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result) {
  const auto [nominal, calibrated] = distances_of(problem, result);
  std::vector<FaceDistances> all;
  for (const TouchRole role : {TouchRole::kFit, TouchRole::kHeldOut, TouchRole::kProof}) {
    for (std::size_t face = 0; face < problem.artefact.contact_planes.size(); ++face) {
      const std::vector<std::size_t> here = touches_of(problem, result, role, static_cast<int>(face));
      if (here.empty()) continue;
      const Eigen::VectorXd before = nominal(here), after = calibrated(here);
      all.push_back({static_cast<int>(face), role, static_cast<int>(here.size()), before.mean(), rms(before),
                     after.mean(), rms(after), std::nullopt, found_offset_m(problem, result, face)});
    }
  }
  return all;
}

}  // namespace calib
