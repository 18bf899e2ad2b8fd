#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

/// Motion that cannot hurt, over whole plans of the shipped cells: where the probe goes fast, and how it goes
/// where it goes slowly.
namespace cell {
namespace {

constexpr double kSlowSpeedMax = 0.020;      // m/s, near to anything that may be touched
constexpr double kSearchSpeedMax = 0.008;    // m/s
constexpr double kStandoffMin = 0.015;       // m, before a face as long as no touch has aimed
constexpr double kAimedStandoffMin = 0.005;  // m, later
constexpr double kLookEveryMetres = 0.005;
constexpr double kReachMetres = 1.3;  // no point of the arm is farther from a joint's axis

class SlowZone : public ::testing::TestWithParam<const char*> {
 protected:
  SlowZone()
      : cell_(read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + GetParam() + "/cell.json")),
        problem_(planning_problem(cell_, cell_.recipes.at(cell_.default_recipe))),
        plan_(std::get<calib::TouchPlan>(calib::plan_touches(problem_))) {
    // The probe alone, with its tip, and everything there is to touch.
    const Eigen::Vector3d tip = Eigen::Vector3d::Zero();
    probe_.obstacles = problem_.scene.obstacles;
    probe_.bodies = cell_.probe.bodies;
    probe_.bodies.push_back({"tip", calib::kFrameCount - 1, tip, tip, cell_.probe.stylus.radius_m});
  }

  /// How near the probe comes to anything, at most, on a straight joint move, both ends included.
  [[nodiscard]] bool stays_out(const calib::JointVector& from, const calib::JointVector& to,
                               double distance_m) const {
    const calib::JointVector move = to - from;
    const int steps = static_cast<int>(move.cwiseAbs().sum() * kReachMetres / kLookEveryMetres) + 1;
    for (int step = 0; step <= steps; ++step) {
      const calib::Chain chain = calib::forward_chain(cell_.arm.model, from + move * step / steps);
      if (calib::find_clash(probe_, chain, distance_m)) return false;
    }
    return true;
  }

  const Cell cell_;
  const calib::PlanningProblem problem_;
  const calib::TouchPlan plan_;
  calib::CollisionScene probe_;
};

INSTANTIATE_TEST_SUITE_P(Cells, SlowZone, ::testing::Values("edf", "demo"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(SlowZone, TravelStaysOutOfItAlsoWithAnArmThatMisses) {
  calib::JointVector at = cell_.park_joints;
  double miss_m = plan_.touches.front().predicted_position_error_m;
  const auto follow = [&](std::vector<calib::JointVector> way, const calib::JointVector& to,
                          double miss_there_m, const std::string& name) {
    way.push_back(to);
    for (const calib::JointVector& next : way) {
      EXPECT_TRUE(stays_out(at, next, 0.025 + std::min(miss_m, miss_there_m))) << name;
      at = next;
    }
    miss_m = miss_there_m;
  };
  for (std::size_t i = 0; i < plan_.touches.size(); ++i) {
    const calib::PlannedTouch& touch = plan_.touches[i];
    EXPECT_GT(touch.predicted_position_error_m, 0.0);
    follow(touch.via, touch.clear_joints, touch.predicted_position_error_m,
           "to touch " + std::to_string(i + 1));
  }
  follow(plan_.park_via, cell_.park_joints, miss_m, "to the park posture");
}

TEST_P(SlowZone, EveryMoveInItIsSlowAndEverySearchSlowerAndLongEnough) {
  for (const calib::PlannedTouch& touch : plan_.touches) {
    const cs8::Touch command = touch_command(cell_, touch, {});
    EXPECT_LE(command.approach_speed_um_s, cs8::um_s_from_metres_per_second(kSlowSpeedMax));
    EXPECT_LE(command.search_speed_um_s, cs8::um_s_from_metres_per_second(kSearchSpeedMax));
    EXPECT_LE(command.second_speed_um_s, command.search_speed_um_s);
    const auto tip_m = [&](const calib::JointVector& joints) -> Eigen::Vector3d {
      return calib::forward_kinematics(cell_.arm.model, joints).translation();
    };
    const double standoff_m = (tip_m(touch.approach_joints) - tip_m(touch.joints)).norm();
    const bool is_aimed = touch.predicted_position_error_m < cell_.nominal_position_error_m;
    const double least_m =
        std::max(is_aimed ? kAimedStandoffMin : kStandoffMin, touch.predicted_position_error_m);
    EXPECT_GE(standoff_m, least_m - 1e-6);
    EXPECT_GE(touch.search_length_m, 2 * least_m - 1e-6);
  }
  EXPECT_LE(retract_command(cell_).approach_speed_um_s, cs8::um_s_from_metres_per_second(kSlowSpeedMax));
}

}  // namespace
}  // namespace cell
