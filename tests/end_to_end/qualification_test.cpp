// Qualifications of the probe: alone, against a calibration, and what they say to the next one.
#include "calib_core/qualification/qualification.hpp"

#include <gmock/gmock.h>

#include "calib_core/kinematics/error_parameters.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/qualification_document.hpp"
#include "service/documents/result_document.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::RunKind;
using cell::State;
using cell::Verdict;
using ::testing::HasSubstr;

constexpr int kTouchesWithLengths = calib::kRepeatCount + calib::kTurnCount - 1 + 4 * calib::kStepTouches;

/// Across the axis of joint 6, in R_6.
Eigen::Vector2d ball_beside_axis_m(const calib::KinematicModel& arm) {
  const auto frames = calib::forward_chain(calib::prepare(arm), calib::JointVector::Zero()).block_from_frame;
  return (frames[calib::kFrameCount - 2].inverse() * frames.back().translation()).head<2>();
}

class ProbeQualification : public ::testing::Test {
 protected:
  ProbeQualification() { loop_.use(shipped_cell("demo"), 4'000); }

  /// The demo arm; `bend_m`: its stylus, across.
  void serve(double bend_m = 0.0) {
    calib::ErrorVector errors = shipped_truth("demo");
    errors[calib::error_parameter_index("d7").value()] += bend_m;
    loop_.serve(sim::make_plant(loop_.cell, errors), {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
  }
  cell::StoredRun made(const cell::StartRequest& request) {
    const auto answer = loop_.ask_to_start(request);
    if (const auto* refusal = std::get_if<cell::CommandRefusal>(&answer))
      throw std::runtime_error(refusal->unmet.empty() ? refusal->detail : refusal->unmet.front().detail);
    loop_.run_until_over();
    EXPECT_EQ(loop_.fault_name(), "");
    return loop_.store().run(std::get<cell::Started>(answer).run.id).value();
  }
  cell::StoredRun qualified() { return made({.kind = RunKind::kQualification}); }
  cell::QualificationDocument document_of(const cell::StoredRun& run) {
    return cell::read_qualification(loop_.store().result_json(run.id).value());
  }

  LoopbackCell loop_;
};

TEST_F(ProbeQualification, NeedsNoCalibrationAndFindsTheRunOutOfTheStylus) {
  serve();
  loop_.launch();
  loop_.run_until(State::kIdle);
  const cell::StoredRun run = qualified();
  const cell::QualificationDocument found = document_of(run);
  EXPECT_EQ(run.verdict, Verdict::kAccepted) << ::testing::PrintToString(found.verdict.reasons);
  EXPECT_EQ(run.of_run, std::nullopt);
  EXPECT_EQ(run.touches_done, kTouchesWithLengths);
  EXPECT_THAT(found.no_of_run.value(), HasSubstr("there is no accepted calibration"));
  EXPECT_TRUE(found.lengths.empty());
  EXPECT_NEAR(found.scatter.std_um.value(), 20.0, 15.0);
  const calib::KinematicModel& nominal = loop_.cell.arm.model;
  const Eigen::Vector2d run_out_m =
      ball_beside_axis_m(calib::apply(nominal, shipped_truth("demo"))) - ball_beside_axis_m(nominal);
  // The arm leans by a hundredth less or more than the nominal one.
  EXPECT_NEAR(found.run_out.size_mm.value(), 1e3 * run_out_m.norm(),
              4.0 * found.run_out.std_mm.value() + 10.0 * run_out_m.norm());
  EXPECT_LT(found.run_out.std_mm.value(), 0.02);
}

TEST_F(ProbeQualification, SpeaksToTheCalibrationAfterItAndSeesAStylusThatBentSince) {
  serve();
  loop_.launch();
  loop_.run_until(State::kIdle);
  const cell::StoredRun before = qualified();
  ASSERT_EQ(before.verdict, Verdict::kAccepted);

  const cell::StoredRun calibration = made({.recipe = kFewCandidates});
  ASSERT_EQ(calibration.verdict, Verdict::kAccepted);
  const auto said = cell::read_conditions(calibration.conditions_json.value()).qualification.value().value();
  EXPECT_EQ(said.run_id, std::to_string(before.id));
  EXPECT_NEAR(said.scatter_um, document_of(before).scatter.std_um.value(), 1e-6);
  const auto fit = cell::read_result(loop_.store().result_json(calibration.id).value()).fit;
  EXPECT_EQ(fit.repeats_sources.back().source, "qualification");
  EXPECT_EQ(fit.repeats_sources.back().degrees_of_freedom, calib::kRepeatCount - 1);

  const cell::StoredRun after = qualified();
  EXPECT_EQ(after.of_run, calibration.id);
  const cell::QualificationDocument healthy = document_of(after);
  EXPECT_EQ(after.verdict, Verdict::kAccepted) << ::testing::PrintToString(healthy.verdict.reasons);
  ASSERT_EQ(healthy.lengths.size(), 2U);
  for (const auto& length : healthy.lengths)
    EXPECT_LT(std::abs(length.error_mm.value()), 4.0 * length.std_mm.value());
  EXPECT_LT(healthy.change.size_mm.value(), 0.1);

  loop_.stop_serving();
  loop_.run_until([](const cell::Status& status) { return !status.controller.connected; });
  serve(0.3e-3);
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(cell::Command::kReset);
  loop_.run_until(State::kIdle);
  const cell::StoredRun bent = qualified();
  EXPECT_EQ(bent.verdict, Verdict::kRejected);
  EXPECT_THAT(::testing::PrintToString(document_of(bent).verdict.reasons),
              HasSubstr("not where it was when the arm was calibrated"));

  // A probe that did not pass says nothing to the next calibration.
  const cell::StoredRun next = made({.recipe = kFewCandidates});
  EXPECT_EQ(cell::read_conditions(next.conditions_json.value()).qualification.value(), std::nullopt);
}

}  // namespace
}  // namespace touchcal::testing
