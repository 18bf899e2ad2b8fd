#include "service/run/calibrated_arm.hpp"

#include <gtest/gtest.h>

#include "calib_core/identification/identify.hpp"
#include "config/arm_file.hpp"
#include "config/identification_problem.hpp"
#include "service/run/tip_prediction.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

class ArmOfAResult : public ::testing::Test {
 protected:
  ArmOfAResult() {
    const Recipe& recipe = edf().recipes.at("edf-25");
    calib::IdentificationProblem problem = identification_problem(edf(), recipe);
    problem.touches = table3_touches();
    result_ = calib::identify(problem, recipe.identification);
  }
  [[nodiscard]] Arm written_and_read() const {
    return read_arm_text("arm.json", calibrated_arm_document(edf(), result_));
  }

  calib::IdentificationResult result_;
};

TEST_F(ArmOfAResult, HasTheModelAndAsLargeATipErrorAsTheResultPredictsInTheArmsOwnFrame) {
  const Arm arm = written_and_read();
  const calib::KinematicModel& nominal = edf().arm.model;
  const calib::TipRegion box = calib::region_over_box(nominal, edf().arm.joint_ranges, edf().workspace_box);
  const auto of_arm = predicted_rms_m(box, calib::in_arm_frame(result_.uncertainty.value()));
  ASSERT_TRUE(of_arm);
  ASSERT_TRUE(arm.covariance);
  EXPECT_NEAR(box.rms_m(*arm.covariance).value(), *of_arm, 1e-6 * *of_arm);
  EXPECT_GT(*of_arm, 1e-6);
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    EXPECT_NEAR(calib::parameter_value(arm.model, i), calib::parameter_value(result_.calibrated, i), 1e-15)
        << calib::arm_parameter_name(i);
  }
}

TEST_F(ArmOfAResult, NamesTheRobotOfTheCell) {
  Cell cell = edf();
  EXPECT_FALSE(written_and_read().serial);
  cell.arm_serial = "F10_12A";
  EXPECT_EQ(read_arm_text("arm.json", calibrated_arm_document(cell, result_)).serial, "F10_12A");
}

TEST_F(ArmOfAResult, HasNoUncertaintyWhereAnErrorOfAnySizeIsPossible) {
  calib::UncertaintyBudget& uncertainty = result_.uncertainty.value();
  uncertainty.unseen_without_tolerance = {calib::error_parameter_index("theta6").value()};
  uncertainty.unknown_directions = calib::ArmVector::Unit(uncertainty.unseen_without_tolerance.front());
  EXPECT_FALSE(written_and_read().covariance);
  uncertainty.unseen_without_tolerance = {calib::error_parameter_index("r0").value()};
  uncertainty.unknown_directions = calib::ArmVector::Unit(uncertainty.unseen_without_tolerance.front());
  EXPECT_TRUE(written_and_read().covariance) << "the block's place is nobody's but the block's";
  result_.uncertainty.reset();
  EXPECT_FALSE(written_and_read().covariance);
}

}  // namespace
}  // namespace cell
