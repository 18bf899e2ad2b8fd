// What touch_executor_at_end.cpp does: every touch of a run is held against all that is known when they are
// made, also one that came when little was known.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "calib_core/geometry/face.hpp"
#include "config/truth.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::IsEmpty;

Eigen::Vector3d nominal_tip_m(const calib::JointVector& joints) {
  return calib::forward_kinematics(cell_of_owners().arm.model, joints).translation();
}

/// The joints at this share of a search, whose line the tip of the nominal arm follows.
calib::JointVector on_search(const calib::JointVector& from, const calib::JointVector& to, double share) {
  constexpr double kSmallRad = 1e-6;
  const Eigen::Vector3d at_m = nominal_tip_m(from) + share * (nominal_tip_m(to) - nominal_tip_m(from));
  calib::JointVector joints = from + share * (to - from);
  for (int step = 0; step < 3; ++step) {
    Eigen::Matrix3d slopes;
    for (int joint = 0; joint < 3; ++joint) {
      calib::JointVector turned = joints;
      turned[joint] += kSmallRad;
      slopes.col(joint) = (nominal_tip_m(turned) - nominal_tip_m(joints)) / kSmallRad;
    }
    joints.head<3>() += slopes.fullPivLu().solve(at_m - nominal_tip_m(joints));
  }
  return joints;
}

/// A run with the paper's arm, whose controller tells of some contacts that they were deeper than the face.
class LyingController : public ExecutorBench {
 protected:
  LyingController() {
    controller.on_touch = [this](const cs8::Touch& command) {
      ++touch_count_;
      const int number = made_again() ? lie_at_ : active_.run.touches_done() + 1;
      const bool lies = number == lie_at_ && lies_left_ > 0;
      if (lies) --lies_left_;
      return contact_of(command, noise_(chance_) - (lies ? lie_m_ : 0.0));
    };
  }
  /// The touch of this number is told to be so deep, and its first repetitions too.
  void lie(int number, double deep_m, int times = 1) {
    lie_at_ = number;
    lie_m_ = deep_m;
    lies_left_ = times;
  }
  void run_to_the_end() {
    for (int step = 0; status.state() == State::kExecute && step < 2 * kTotal; ++step)
      run(touches_.make_next_touch(active_));
  }
  [[nodiscard]] const calib::IdentificationResult& result() const { return active_.run.latest(); }
  [[nodiscard]] double replaced_count() const {
    return static_cast<double>(store.superseded_touches(active_.run.id()).size());
  }

  static constexpr int kTotal = 32;
  static constexpr int kFitted = 28;
  int touch_count_ = 0;

 private:
  [[nodiscard]] bool made_again() const { return !active_.run.next(); }
  [[nodiscard]] double true_off_m(int face, const calib::JointVector& joints) const {
    const Cell& cell = cell_of_owners();
    const auto plane =
        calib::contact_plane(cell.block.faces[static_cast<std::size_t>(face)], cell.probe.stylus);
    return signed_distance_m(plane, calib::forward_kinematics(truth_, joints).translation());
  }
  /// Where the true ball is so far outside of its contact with the face that is searched.
  [[nodiscard]] cs8::TouchResult contact_of(const cs8::Touch& command, double off_m) const {
    const int face = preparation.made()->touch.face;
    const calib::JointVector from = from_wire(command.approach), to = from_wire(command.search_end);
    double outside = 0.0, inside = 1.0;
    for (int i = 0; i < 30; ++i) {
      const double middle = (outside + inside) / 2.0;
      (true_off_m(face, on_search(from, to, middle)) > off_m ? outside : inside) = middle;
    }
    cs8::TouchResult result = contact();
    result.contact = to_wire(on_search(from, to, outside));
    result.first_contact = result.contact;
    return result;
  }

  const calib::KinematicModel truth_ =
      calib::apply(cell_of_owners().arm.model, read_truth(kSourceDir / "config/cells/edf/truth.json").errors);
  std::mt19937_64 chance_{1};
  std::normal_distribution<double> noise_{0.0, cell_of_owners().touch_noise_m};
  int lie_at_ = 0;
  double lie_m_ = 0.0;
  int lies_left_ = 0;
};

TEST_F(LyingController, ThatTellsTheTruthHasNothingMadeAgain) {
  run_to_the_end();
  EXPECT_EQ(status.state(), State::kCompleting) << (faults.empty() ? "" : faults.back());
  EXPECT_EQ(touch_count_, kTotal);
  EXPECT_FALSE(status.latest().warning);
}

struct Lie {
  int number;
  double deep_m;
};

class OneLie : public LyingController, public ::testing::WithParamInterface<Lie> {};

TEST_P(OneLie, IsMadeAgainWhereverItComesAndTheResultIsThatOfAnHonestRun) {
  lie(GetParam().number, GetParam().deep_m);
  run_to_the_end();
  ASSERT_EQ(status.state(), State::kCompleting) << (faults.empty() ? "" : faults.back());
  EXPECT_EQ(touch_count_, kTotal + 1);
  EXPECT_EQ(replaced_count(), 1);
  EXPECT_EQ(store.superseded_touches(active_.run.id()).front().touch.number, GetParam().number);
  expect_run_is_as_stored();
  for (const StoredTouch& touch : store.touches(active_.run.id())) {
    EXPECT_FALSE(touch.again) << "an outlier is no noise";
    EXPECT_EQ(touch.first.value().joints, touch.joints) << "as this controller has them";
  }
  EXPECT_EQ(store.touches(active_.run.id())[static_cast<std::size_t>(GetParam().number - 1)].joints,
            active_.run.touches()[static_cast<std::size_t>(GetParam().number - 1)].joints);
  EXPECT_THAT(result().rejected, IsEmpty());
  EXPECT_EQ(result().fitted_touch_count, kFitted);
  ASSERT_TRUE(result().lack_of_fit);
  EXPECT_GT(result().lack_of_fit->p, cell_of_owners().acceptance.lack_of_fit_p_min);
  EXPECT_FALSE(status.latest().warning) << "it fits now";
}

// First, second, in the middle, the last that is fitted, the last of all.
INSTANTIATE_TEST_SUITE_P(Everywhere, OneLie,
                         ::testing::Values(Lie{1, 0.005}, Lie{2, 0.005}, Lie{16, 0.005}, Lie{28, 0.005},
                                           Lie{32, 0.005}, Lie{1, 0.011}, Lie{2, 0.011}, Lie{16, 0.011},
                                           Lie{28, 0.011}, Lie{32, 0.011}));

TEST_F(LyingController, ThatLiesTheSameAgainIsToldOfAndTheFirstTouchStays) {
  lie(1, 0.005, 2);
  run_to_the_end();
  ASSERT_EQ(status.state(), State::kCompleting) << (faults.empty() ? "" : faults.back());
  EXPECT_EQ(touch_count_, kTotal + 1) << "once";
  EXPECT_EQ(replaced_count(), 0);
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kTouchOutlier);
  EXPECT_NE(status.latest().warning->detail.find("touch 1"), std::string::npos);
  EXPECT_FALSE(active_.run.touches().front().again) << "half a millimetre apart: noise of no touch";
}

TEST_F(LyingController, ATouchThatItsRepetitionAgreesWithKeepsItAsAPair) {
  lie(kTotal, 0.005, 2);
  run_to_the_end();
  ASSERT_EQ(status.state(), State::kCompleting) << (faults.empty() ? "" : faults.back());
  EXPECT_EQ(touch_count_, kTotal + 1) << "once";
  const std::vector<StoredTouch> kept = store.touches(active_.run.id());
  ASSERT_TRUE(kept.back().again) << "both are believed";
  EXPECT_EQ(kept.back().again, active_.run.touches().back().again);
  EXPECT_FALSE(active_.run.problem().repeat_sources.touched_again.noise)
      << "both at the search's end: copies";
}

TEST_F(LyingController, ARepetitionThatCannotBeStoredHoldsTheRunAndIsStoredWhenItGoesOn) {
  lie(kTotal, 0.005, 2);
  while (active_.run.next()) run(touches_.make_next_touch(active_));
  break_store();
  run(touches_.make_next_touch(active_));
  mend_store();
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_FALSE(active_.run.touches().back().again);
  const int made = touch_count_;
  status.enter(State::kExecute);
  run_to_the_end();
  EXPECT_EQ(touch_count_, made) << "it is not touched twice";
  EXPECT_TRUE(store.touches(active_.run.id()).back().again);
}

TEST_F(LyingController, ATouchThatCannotBeMadeAgainHoldsAndSkipLeavesItWithAWarning) {
  lie(1, 0.005);
  while (active_.run.next()) run(touches_.make_next_touch(active_));
  run(touches_.make_next_touch(active_));  // all are looked at
  ASSERT_EQ(status.state(), State::kExecute);
  controller.on_touch = [](const cs8::Touch&) {
    return cs8::TouchResult{.outcome = cs8::Outcome::kNoContact};
  };
  run(touches_.make_next_touch(active_));
  ASSERT_EQ(status.state(), State::kHolding);
  EXPECT_EQ(touches_.held_by(), HeldBy::kOutlier);
  touches_.settle_hold(active_, Command::kSkip);
  EXPECT_TRUE(run(touches_.store_answer(active_)));
  status.enter(State::kExecute);
  run_to_the_end();
  EXPECT_EQ(status.state(), State::kCompleting);
  EXPECT_EQ(active_.run.touches_done(), kTotal);
  EXPECT_EQ(active_.run.skipped_count(), 0);
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kTouchOutlier);
}

}  // namespace
}  // namespace cell
