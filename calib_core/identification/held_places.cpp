#include "calib_core/identification/held_places.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace calib {
namespace {

/// The root mean square of the pushes on a ball along the direction that they show least: below, they do not
/// find its centre. Stems that lean by no more than 5 degrees give as much.
constexpr double kPushesMin = 0.05;

/// The pushes on a ball, in R_7.
struct Pushes {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  // their sum
  int count = 0;

  [[nodiscard]] bool show_all_directions() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> mean(squares / count, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, mean.eigenvalues()[0])) >= kPushesMin;
  }
};

/// Of each further tip that was touched with.
std::map<std::size_t, Pushes> pushes_by_tip(const IdentificationProblem& problem) {
  std::map<std::size_t, Pushes> by_tip;
  const PreparedModel nominal = prepare(problem.nominal);
  for (const Touch& touch : problem.touches) {
    const auto face = static_cast<std::size_t>(touch.face);
    const std::size_t tip = problem.artefact.tip_of(face);
    if (touch.role != TouchRole::kFit || tip == 0 || face >= problem.artefact.contact_planes.size()) continue;
    const Chain chain = forward_chain(nominal, touch.joints);
    const Eigen::Vector3d push =
        contact_at(problem.artefact.contact_planes[face], chain.block_from_frame.back()).push;
    Pushes& pushes = by_tip[tip];
    pushes.squares += push * push.transpose();
    ++pushes.count;
  }
  return by_tip;
}

/// Touches with a tip whose ball they do not find are not fitted yet, and its centre is held.
void hold_tips(const IdentificationProblem& problem, IdentificationProblem& held) {
  const auto pushes = pushes_by_tip(problem);
  const auto is_found = [&](std::size_t tip) {
    const auto found = pushes.find(tip);
    return found != pushes.end() && found->second.show_all_directions();
  };
  bool holds = false;
  for (ArtefactParameter& parameter : held.artefact.parameters) {
    if (parameter.kind != ArtefactKind::kTipCenter) continue;
    const auto touched = std::ranges::find_if(
        parameter.shifts, [](const ArtefactParameter::Shift& shift) { return !shift.ball.isZero(0.0); });
    const auto face = static_cast<std::size_t>(touched - parameter.shifts.begin());
    if (is_found(problem.artefact.tip_of(face))) continue;
    parameter.std = kFreeArtefactStd;
    holds = true;
  }
  if (!holds) return;
  held.attainable.reset();  // fewer tips show less
  for (Touch& touch : held.touches) {
    const std::size_t tip = problem.artefact.tip_of(static_cast<std::size_t>(touch.face));
    if (touch.role == TouchRole::kFit && tip > 0 && !is_found(tip)) touch.role = TouchRole::kProof;
  }
}

}  // namespace

IdentificationProblem with_held_places(const IdentificationProblem& problem) {
  IdentificationProblem held = problem;
  for (const PlaceParameters& place : problem.artefact.places) {
    const bool is_touched = std::ranges::any_of(problem.touches, [&](const Touch& touch) {
      return touch.role == TouchRole::kFit &&
             problem.artefact.place_of(static_cast<std::size_t>(touch.face)) ==
                 static_cast<std::size_t>(place.place);
    });
    for (int k = place.first; !is_touched && k < place.first + kPlaceParameterCount; ++k) {
      auto& std = held.artefact.parameters[static_cast<std::size_t>(k)].std;
      std = std.value_or(kFreeArtefactStd);
    }
  }
  if (problem.artefact.tip_count > 1) hold_tips(problem, held);
  return held;
}

}  // namespace calib
