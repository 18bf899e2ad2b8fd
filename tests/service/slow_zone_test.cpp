#include <gtest/gtest.h>

#include "calib_core/touch_planning.hpp"
#include "calib_core/units.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/planning.hpp"
#include "service/acquisition/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

/// Motion that cannot hurt, over whole plans of the shipped cells: where the probe goes fast, and how it goes
/// where it goes slowly.
namespace cell {
namespace {

constexpr double kSlowSpeedMax = 0.020;    // m/s, near to anything that may be touched
constexpr double kSearchSpeedMax = 0.008;  // m/s
constexpr double kStandoffMin = 0.015;     // m, before a face that nobody has touched yet
constexpr double kSearchMin = 0.030;       // m
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
  const double distance_m = 0.025 + cell_.nominal_miss_m;
  std::vector<calib::JointVector> stops{cell_.park_joints};
  for (const calib::PlannedTouch& touch : plan_.touches) stops.push_back(touch.clear_joints);
  stops.push_back(cell_.park_joints);
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const auto via = calib::find_transfer(problem_, stops[i - 1], stops[i]);
    ASSERT_TRUE(via) << "to stop " << i;
    calib::JointVector at = stops[i - 1];
    for (const calib::JointVector& next : *via) {
      EXPECT_TRUE(stays_out(at, next, distance_m)) << "to stop " << i;
      at = next;
    }
    EXPECT_TRUE(stays_out(at, stops[i], distance_m)) << "to stop " << i;
  }
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
    EXPECT_GE(standoff_m, std::max(kStandoffMin, cell_.nominal_miss_m) - 1e-6);
    EXPECT_GE(touch.search_length_m, std::max(kSearchMin, 2 * cell_.nominal_miss_m) - 1e-6);
  }
  EXPECT_LE(retract_command(cell_).approach_speed_um_s, cs8::um_s_from_metres_per_second(kSlowSpeedMax));
}

}  // namespace
}  // namespace cell
