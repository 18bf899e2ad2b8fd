// A person moves the simulated arm with the pendant.
#include "sim_controller/jog.hpp"

#include "bench.hpp"

namespace sim::testing {
namespace {

class Jogging : public DemoTouch {
 protected:
  void SetUp() override {
    cabinet_.drives.joints = motion().waypoints.back();
    cabinet_.panel.mode = cs8::WorkingMode::kManual;
    cabinet_.panel.powered = true;
  }
  /// Until it is over; how many ticks that took.
  int carry_out() {
    int ticks = 0;
    for (; cabinet_.jog && ticks < 100'000; ++ticks) tick(plant_, cabinet_);
    return ticks;
  }
  static cell::JogOrder down(double way_m, double speed_m_s) {
    return {.joints = {}, .move_m = -way_m * aimed().face.plane.outward, .speed_m_s = speed_m_s};
  }
  [[nodiscard]] double height_m() const {
    return signed_distance_m(aimed().contact_plane, tip_m(plant_.truth, cabinet_.drives.joints));
  }

  Plant plant_ = plant();
  Cabinet cabinet_ = make_cabinet(plant_, 1);
};

TEST_F(Jogging, EndsWhereTheJointsWereOrdered) {
  const calib::JointVector target = motion().waypoints.back() + calib::JointVector::Constant(0.02);
  ASSERT_FALSE(begin_jog(plant_, cabinet_, {.joints = target, .move_m = {}, .speed_m_s = 0.1}));
  EXPECT_GT(carry_out(), 1);
  EXPECT_LT((cabinet_.drives.joints - target).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_TRUE(cabinet_.jogged);
}

TEST_F(Jogging, StopsAtTheFaceWithTheProbeTouched) {
  ASSERT_FALSE(begin_jog(plant_, cabinet_, down(2.0 * kClearMetres, 0.005)));
  carry_out();
  EXPECT_TRUE(cabinet_.probe_touched());
  EXPECT_LT(std::abs(height_m()), 0.5e-3);  // what 5 mm/s needs to stop, and what the trip differs
}

TEST_F(Jogging, IsNoFasterThanManualModeAllows) {
  ASSERT_FALSE(begin_jog(plant_, cabinet_, down(0.02, 10.0 * kJogSpeedMaxMetresPerSecond)));
  const double from_m = height_m();
  const int ticks = carry_out();
  EXPECT_NEAR(from_m - height_m(), 0.02, 1e-3);
  EXPECT_GT(ticks * kTickSeconds, (from_m - height_m()) / kJogSpeedMaxMetresPerSecond);
}

TEST_F(Jogging, StopsWhenThePersonLosesThePower) {
  const calib::JointVector target = motion().waypoints.back() + calib::JointVector::Constant(0.2);
  ASSERT_FALSE(begin_jog(plant_, cabinet_, {.joints = target, .move_m = {}, .speed_m_s = 0.05}));
  tick(plant_, cabinet_);
  cabinet_.panel.powered = false;
  carry_out();
  EXPECT_GT((cabinet_.drives.joints - target).cwiseAbs().maxCoeff(), 0.1);
}

TEST_F(Jogging, IsRefusedOutsideManualModeWithoutPowerOnHoldInMotionAndOutOfReach) {
  const auto refused = [this](const cell::JogOrder& order = down(0.01, 0.01)) {
    return begin_jog(plant_, cabinet_, order).has_value();
  };
  cabinet_.panel.mode = cs8::WorkingMode::kRemote;
  EXPECT_TRUE(refused());
  cabinet_.panel.mode = cs8::WorkingMode::kManual;
  cabinet_.panel.powered = false;
  EXPECT_TRUE(refused());
  cabinet_.panel.powered = true;
  cabinet_.panel.held = true;
  EXPECT_TRUE(refused());
  cabinet_.panel.held = false;
  cabinet_.panel.emergency_stop = 1;
  EXPECT_TRUE(refused());
  cabinet_.panel.emergency_stop = 0;
  EXPECT_TRUE(refused(down(5.0, 0.1)));
  EXPECT_TRUE(refused({.joints = calib::JointVector::Constant(10.0), .move_m = {}}));
  EXPECT_FALSE(refused());
  EXPECT_TRUE(refused()) << "while the arm moves";
}

}  // namespace
}  // namespace sim::testing
