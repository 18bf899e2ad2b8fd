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
  std::vector<Plane> planes;
  correct_contact_planes(problem.artefact, result.artefact_errors, planes);
  return {signed_distances_m(problem.nominal, problem.artefact.contact_planes, problem.touches),
          signed_distances_m(result.calibrated, planes, problem.touches)};
}

}  // namespace

std::vector<TouchDistance> touch_distances(const IdentificationProblem& problem,
                                           const IdentificationResult& result) {
  const Distances distances = distances_of(problem, result);
  std::vector<TouchDistance> all;
  for (Eigen::Index i = 0; i < distances.nominal.size(); ++i)
    all.push_back({distances.nominal[i], distances.calibrated[i]});
  return all;
}

std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result) {
  const auto [nominal, calibrated] = distances_of(problem, result);
  std::vector<bool> rejected(problem.touches.size(), false);
  for (const RejectedTouch& touch : result.rejected) rejected[touch.touch] = true;
  std::vector<FaceDistances> all;
  for (const TouchRole role : {TouchRole::kFit, TouchRole::kHeldOut, TouchRole::kProof}) {
    for (std::size_t face = 0; face < problem.artefact.contact_planes.size(); ++face) {
      std::vector<Eigen::Index> here;
      for (std::size_t i = 0; i < problem.touches.size(); ++i) {
        const Touch& touch = problem.touches[i];
        const bool counts = touch.role == role && static_cast<std::size_t>(touch.face) == face;
        if (counts && !rejected[i]) here.push_back(static_cast<Eigen::Index>(i));
      }
      if (here.empty()) continue;
      const Eigen::VectorXd before = nominal(here), after = calibrated(here);
      all.push_back({static_cast<int>(face), role, static_cast<int>(here.size()), before.mean(), rms(before),
                     after.mean(), rms(after)});
    }
  }
  return all;
}

}  // namespace calib
