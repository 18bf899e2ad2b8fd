#include "service/run/run_repeats.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "config/identification_problem.hpp"
#include "service/documents/json_view.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Of the paper's arm, at this second of a minute.
StoredTouch stored(int number, int second = 0) {
  const calib::Touch& touch = table3_touches().at(static_cast<std::size_t>(number - 1));
  return {.number = number,
          .plane = touch.face + 1,
          .joints = to_wire(touch.joints),
          .captured_at =
              "2026-01-31T08:15:" + std::string(second < 10 ? "0" : "") + std::to_string(second) + ".250Z"};
}

ReferenceTouch reference(int number, int second) {
  const StoredTouch place = stored(1, second);
  return {.number = number, .joints = place.joints, .captured_at = place.captured_at};
}

/// So many millionths of a degree further on joints 1 and 2: one of them moves the ball along any normal.
cs8::JointsMicrodeg turned(cs8::JointsMicrodeg joints, std::int32_t microdeg) {
  joints[0] += microdeg;
  joints[1] += microdeg;
  return joints;
}

TEST(TouchTimes, AreSecondsSinceTheFirst) {
  const TouchTimes times = times_of({stored(1, 10), stored(2, 18)}, {reference(1, 12), reference(2, 20)});
  EXPECT_THAT(times.touches_s, ElementsAre(0.0, 8.0));
  EXPECT_THAT(times.references_s, ElementsAre(2.0, 10.0));
}

TEST(TouchTimes, CountFromAReferenceTouchWhereTheFirstTouchWasReplaced) {
  const TouchTimes times = times_of({stored(1, 50), stored(2, 18)}, {reference(1, 12), reference(2, 20)});
  EXPECT_THAT(times.touches_s, ElementsAre(38.0, 6.0));
  EXPECT_THAT(times.references_s, ElementsAre(0.0, 8.0));
}

TEST(TouchTimes, AreUnknownWhereAStampIsNoTimeOrTheClockWasSetBack) {
  StoredTouch without = stored(2);
  without.captured_at = "then";
  EXPECT_THAT(times_of({stored(1), without}, {}).touches_s, ElementsAre(0.0, std::nullopt));
  ReferenceTouch nowhen = reference(2, 5);
  nowhen.captured_at.clear();
  EXPECT_THAT(times_of({stored(1)}, {reference(1, 4), nowhen}).references_s, IsEmpty());
  EXPECT_THAT(times_of({stored(1)}, {reference(1, 6), reference(2, 5)}).references_s, IsEmpty());
}

TEST(Repeats, AreTheLatchedFirstContactsAndTheRepetitionsThatAgreed) {
  StoredTouch both = stored(1), polled = stored(2), late = stored(3), of_hand = stored(4), again = stored(5);
  both.first = FirstContact{.joints = turned(both.joints, 5)};
  polled.first = FirstContact{.source = cs8::CaptureSource::kPolled, .joints = polled.joints};
  late.first = FirstContact{.joints = late.joints};
  late.source = cs8::CaptureSource::kPolled;
  of_hand.noise_um = 60.0;
  of_hand.first = FirstContact{.joints = of_hand.joints};
  again.again = turned(again.joints, -7);
  const calib::Repeats repeats = repeats_of({both, polled, late, of_hand, again}, {reference(1, 1)});
  ASSERT_EQ(repeats.two_speed.size(), 1U);
  EXPECT_EQ(to_wire(repeats.two_speed[0].first), both.first->joints);
  EXPECT_EQ(to_wire(repeats.two_speed[0].second), both.joints);
  ASSERT_EQ(repeats.touched_again.size(), 1U);
  EXPECT_EQ(to_wire(repeats.touched_again[0].first), again.joints);
  EXPECT_EQ(to_wire(repeats.touched_again[0].second), *again.again);
  EXPECT_EQ(repeats.references.size(), 1U);
}

/// A run of forty touches with all that can be touched twice.
class RepeatedRun : public ::testing::Test {
 protected:
  RepeatedRun() {
    for (int number = 1; number <= 40; ++number) {
      StoredTouch& touch = touches_.emplace_back(stored(number, number));
      touch.first = FirstContact{.joints = turned(touch.joints, 300 + 17 * (number % 7))};
    }
    touches_[5].again = turned(touches_[5].joints, 900);
    for (int number = 1; number <= 6; ++number) {
      references_.push_back(reference(number, 7 * number));
      references_.back().joints = turned(references_.back().joints, (number % 2 == 0 ? 800 : -700) + number);
    }
  }
  [[nodiscard]] static calib::IdentificationProblem noted(const calib::Repeats& repeats) {
    calib::IdentificationProblem problem = identification_problem(edf(), edf().recipes.at("edf-25"));
    note_repeats(repeats, problem);
    return problem;
  }

  std::vector<StoredTouch> touches_;
  std::vector<ReferenceTouch> references_;
};

TEST_F(RepeatedRun, SaysWhatEachKindOfRepetitionShows) {
  const calib::IdentificationProblem problem = noted(repeats_of(touches_, references_));
  const calib::RepeatSources& sources = problem.repeat_sources;
  EXPECT_EQ(sources.reference_touches.noise->degrees_of_freedom, 4.0) << "six about a line";
  EXPECT_EQ(sources.two_speed.noise->degrees_of_freedom, 38.0) << "forty on two planes";
  EXPECT_EQ(sources.touched_again.noise->degrees_of_freedom, 1.0);
  EXPECT_LT(sources.two_speed.noise->std_m, sources.reference_touches.noise->std_m / 2.0);
  EXPECT_FALSE(sources.two_speed.used) << "a lower bound";
  ASSERT_TRUE(sources.touched_again.used);
  EXPECT_EQ(problem.pure_error->degrees_of_freedom, 5.0);
  EXPECT_GT(problem.drift_uncertainty.std_m, 0.0);
  EXPECT_EQ(problem.drift_uncertainty.degrees_of_freedom, 4.0);
}

TEST_F(RepeatedRun, DoesNotTakeCopiesOfTouchesForRepetitions) {
  for (StoredTouch& touch : touches_) touch.again = turned(touch.joints, touch.number % 2 == 0 ? 1 : -1);
  EXPECT_FALSE(noted(repeats_of(touches_, references_)).repeat_sources.touched_again.noise);
}

TEST_F(RepeatedRun, WithoutReferenceTouchesDoesNotTakeTheLowerBoundForItsNoise) {
  touches_[5].again.reset();
  const calib::IdentificationProblem problem = noted(repeats_of(touches_, {}));
  EXPECT_TRUE(problem.repeat_sources.two_speed.noise);
  EXPECT_FALSE(problem.pure_error);
  EXPECT_EQ(problem.drift_uncertainty.std_m, 0.0);
}

TEST_F(RepeatedRun, ItsTouchesDocumentReadsBackToTheSameFiguresToTheBit) {
  const std::string document = touches_document(edf(), touches_, references_);
  const TouchesFile file = touches_from_json("document", document, document.size(), edf());
  const calib::Repeats stored = repeats_of(touches_, references_);
  EXPECT_EQ(file.repeats.reference_times_s, stored.reference_times_s);
  EXPECT_EQ(stored.reference_times_s.size(), references_.size());
  ASSERT_EQ(file.repeats.two_speed.size(), stored.two_speed.size());
  for (std::size_t i = 0; i < stored.two_speed.size(); ++i)
    EXPECT_EQ(file.repeats.two_speed[i].first, stored.two_speed[i].first);
  ASSERT_EQ(file.repeats.touched_again.size(), 1U);
  EXPECT_EQ(file.repeats.touched_again[0].second, stored.touched_again[0].second);
  const calib::IdentificationProblem offline = noted(file.repeats), live = noted(stored);
  EXPECT_EQ(offline.pure_error->std_m, live.pure_error->std_m);
  EXPECT_EQ(offline.repeat_sources.two_speed.noise->std_m, live.repeat_sources.two_speed.noise->std_m);
  EXPECT_EQ(offline.drift_uncertainty.std_m, live.drift_uncertainty.std_m);
}

TEST_F(RepeatedRun, KnowsItsFirstContactsAfterARestart) {
  const TipRegions regions(edf());
  cell::Run live(1, regions, edf().recipes.at("edf-25"), "start"), restored = live;
  for (const StoredTouch& touch : touches_) live.add(touch);
  live.note_references(references_);
  restored.restore(touches_, 100);
  restored.note_references(references_);
  ASSERT_TRUE(restored.problem().repeat_sources.two_speed.noise);
  EXPECT_EQ(restored.problem().repeat_sources.two_speed.noise->std_m,
            live.problem().repeat_sources.two_speed.noise->std_m);
  EXPECT_EQ(restored.problem().pure_error->std_m, live.problem().pure_error->std_m);
}

TEST_F(RepeatedRun, CountsARepetitionFromThenOnAndNoLongerWhenItsTouchIsReplaced) {
  const TipRegions regions(edf());
  cell::Run run(1, regions, edf().recipes.at("edf-25"), "start");
  touches_[5].again.reset();
  for (const StoredTouch& touch : touches_) run.add(touch);
  EXPECT_FALSE(run.problem().pure_error);
  run.confirm(6, turned(touches_[5].joints, 900));
  ASSERT_TRUE(run.problem().pure_error);
  EXPECT_TRUE(run.problem().repeat_sources.touched_again.used);
  EXPECT_TRUE(run.identification_is_due());
  run.replace(touches_[5]);
  EXPECT_FALSE(run.problem().pure_error);
}

}  // namespace
}  // namespace cell
