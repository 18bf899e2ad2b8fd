#include "calib_core/proof/proof_alternatives.hpp"

#include <array>
#include <utility>

namespace calib {
namespace {

bool is_arm_droop(int position) {
  constexpr int kLastJoint = 2;  // the wrist carries too little for its droop to be worth anything
  return position >= compliance_position(0) && position <= compliance_position(kLastJoint);
}

/// Of the tip by all effects at their standard deviations.
double tip_rms_m(const Eigen::MatrixXd& displacements, const TipRegion& region) {
  const Eigen::MatrixXd of_arm = displacements.topRows<kArmParameterCount>();
  return region.rms_m(ArmMatrix(of_arm * of_arm.transpose())).value_or(0.0);
}

}  // namespace

std::vector<ProofAlternative> proof_alternatives(const CalibrationRecord& record, const TipRegion& region,
                                                 double worth_m) {
  using Kind = std::pair<const char*, bool (*)(int)>;
  constexpr std::array kKinds{Kind{"droop", is_arm_droop}, Kind{"eccentric gears", is_harmonic},
                              Kind{"oval gears", is_second_harmonic}};
  const NongeometricDeviations& std = record.problem().nongeometric_std;
  std::vector<ProofAlternative> alternatives;
  for (const auto& [name, is_of_kind] : kKinds) {
    ProofAlternative found{name, Eigen::MatrixXd(record.unknown_count(), 0)};
    for (int position = 0; position < kNongeometricCount; ++position) {
      const int column = nongeometric_index(position);
      const auto& deviation = std[static_cast<std::size_t>(position)];
      if (!is_of_kind(position) || !deviation || record.is_estimated(column)) continue;
      const Eigen::VectorXd displacement = *deviation * record.displacement_by(column);
      // Joints give way in the direction of the load, all of them: one effect, which has no other sign.
      if (is_of_kind == is_arm_droop && found.displacements.cols() > 0) {
        found.displacements.col(0) += displacement;
        continue;
      }
      found.displacements.conservativeResize(Eigen::NoChange, found.displacements.cols() + 1);
      found.displacements.rightCols<1>() = displacement;
    }
    const double rms_m = found.displacements.cols() > 0 ? tip_rms_m(found.displacements, region) : 0.0;
    if (rms_m == 0.0) continue;
    found.displacements *= worth_m / rms_m;
    alternatives.push_back(std::move(found));
  }
  return alternatives;
}

}  // namespace calib
