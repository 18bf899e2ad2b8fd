#include "service/acquisition/preconditions.hpp"

#include <gmock/gmock.h>

#include "tests/service/acquisition/scripted_controller.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> codes(const std::vector<Unmet>& unmet) {
  std::vector<std::string> found;
  for (const Unmet& one : unmet) found.push_back(one.code);
  return found;
}

TEST(Preconditions, WithoutALinkOnlyThatIsSaidWithItsFault) {
  const auto unmet =
      unmet_by_controller(false, ScriptedController::ready_state(), Fault{FaultCode::kLinkLost, "why"});
  EXPECT_THAT(codes(unmet), ElementsAre("controller_not_connected"));
  EXPECT_NE(unmet.front().detail.find("why"), std::string::npos);
}

TEST(Preconditions, AllThatIsMissingIsSaidAtOnce) {
  cs8::State state = ScriptedController::ready_state();
  EXPECT_THAT(codes(unmet_by_controller(true, state, {})), IsEmpty());
  state.emergency_stop = 2;
  state.mode = cs8::WorkingMode::kManual;
  state.flags &= ~static_cast<std::uint32_t>(cs8::kPowered);
  state.monitor_speed_percent = 10;
  EXPECT_THAT(codes(unmet_by_controller(true, state, {})),
              ElementsAre("emergency_stop", "not_remote", "not_powered", "monitor_speed"));
}

TEST(Preconditions, AProbeThatTouchesIsFineWhereTheRunsFirstMotionTakesItOff) {
  cs8::State state = ScriptedController::ready_state();
  state.flags |= cs8::kProbeTouched;
  EXPECT_THAT(codes(unmet_by_controller(true, state, {})), ElementsAre("probe_touched"));
  state.flags |= cs8::kRetractDue;
  EXPECT_THAT(codes(unmet_by_controller(true, state, {})), IsEmpty());
}

TEST(Preconditions, AFaultIsToBeReadFirstButForOneOfTheLink) {
  const auto with = [](FaultCode code) {
    return codes(unmet_for_run({}, edf(), {}, Fault{code, {}}, nullptr));
  };
  const auto without = codes(unmet_for_run({}, edf(), {}, {}, nullptr));
  EXPECT_EQ(with(FaultCode::kLinkLost), without);
  EXPECT_EQ(with(FaultCode::kCollision).size(), without.size() + 1);
}

TEST(Preconditions, AProbeThatWasCalibratedAtAnotherSpeedIsOneOfThem) {
  Cell with_ball = edf();
  with_ball.probe.tip_is_contact_point = false;
  with_ball.probe.calibration_speed_m_s = with_ball.speeds.contact_m_s();
  EXPECT_THAT(codes(unmet_for_run({}, with_ball, {}, {}, nullptr)), IsEmpty());
  with_ball.probe.calibration_speed_m_s = 2 * with_ball.speeds.contact_m_s();
  const auto unmet = unmet_for_run({}, with_ball, {}, {}, nullptr);
  EXPECT_THAT(codes(unmet), ElementsAre("probe_not_calibrated"));
  EXPECT_THAT(unmet_without_motion(unmet), IsEmpty()) << "touches by hand have no speed";
}

TEST(Preconditions, ARecipeWithoutAPlanSaysWhy) {
  const PlanRefusal refusal{.message = "no room", .efforts = {}};
  const auto unmet = unmet_for_run({}, edf(), {}, {}, &refusal);
  ASSERT_FALSE(unmet.empty());
  EXPECT_EQ(unmet.back().code, "recipe_unreachable");
}

TEST(Preconditions, ATemperatureThatIsTooOldIsOneOfThem) {
  const auto now = std::chrono::system_clock::time_point{} + std::chrono::hours(100);
  const auto measured = [&](int hours_ago) {
    return codes(unmet_for_run(
        {}, edf(), {BlockTemperature{25.0, 0.5, now - std::chrono::hours(hours_ago)}, now}, {}, nullptr));
  };
  EXPECT_THAT(measured(8), IsEmpty());
  EXPECT_THAT(measured(9), ElementsAre("temperature_old"));
  EXPECT_THAT(measured(-1), ElementsAre("temperature_in_future"));
}

TEST(Preconditions, APlaceThatTheLastRunHadAndNobodyHasNowIsOneOfThem) {
  const StoredRun at_place{
      .id = 7, .config_digest = "digest", .conditions_json = R"({"place":{"shift_mm":[1]}})"};
  EXPECT_EQ(unmet_by_lost_place({.runs = {at_place}}, "digest", false).value().code, "place_lost");
  EXPECT_FALSE(unmet_by_lost_place({.runs = {at_place}}, "digest", true));
  const Unmet of_other_files = unmet_by_lost_place({.runs = {at_place}}, "another", false).value();
  EXPECT_EQ(of_other_files.code, "place_lost");
  EXPECT_THAT(of_other_files.detail, ::testing::HasSubstr("files that have changed since"));
  EXPECT_FALSE(unmet_by_lost_place({.runs = {at_place}}, "another", true));
  EXPECT_FALSE(unmet_by_lost_place({}, "digest", false));
  const StoredRun at_files{.id = 8, .config_digest = "digest", .conditions_json = R"({"place":null})"};
  EXPECT_FALSE(unmet_by_lost_place({.runs = {at_files, at_place}}, "digest", false));
}

TEST(Preconditions, ALastRunThatCannotBeReadCallsForAPlaceUnlessThereIsOne) {
  const DamagedRun damaged{9, "the file: table runs, run 9: not what was written"};
  const StoredRun at_files{.id = 8, .config_digest = "digest", .conditions_json = R"({"place":null})"};
  const RunPage newest{.runs = {at_files}, .damaged = {damaged}};
  EXPECT_FALSE(unmet_by_lost_place(newest, "digest", true));
  const Unmet unmet = unmet_by_lost_place(newest, "digest", false).value();
  EXPECT_EQ(unmet.code, "place_lost");
  EXPECT_THAT(unmet.detail, ::testing::AllOf(::testing::HasSubstr("touchcal locate"),
                                             ::testing::HasSubstr("table runs, run 9")));
  StoredRun behind = at_files;
  behind.id = 10;
  EXPECT_FALSE(unmet_by_lost_place({.runs = {behind}, .damaged = {damaged}}, "digest", false))
      << "it is not the last one any more";
}

TEST(Preconditions, ARunByHandNeedsNothingThatOnlyMotionNeeds) {
  cs8::State state = ScriptedController::ready_state();
  state.mode = cs8::WorkingMode::kManual;
  state.flags = cs8::kProbeTouched;
  EXPECT_THAT(codes(unmet_without_motion(unmet_by_controller(true, state, {}))),
              ElementsAre("not_calibrated"));
}

}  // namespace
}  // namespace cell
