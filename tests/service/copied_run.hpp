#pragma once

#include <string>

#include "service/store/run_copy.hpp"
#include "tests/service/same_touch.hpp"

namespace cell {

/// A run that ended with at least one of all that is stored of a run.
inline RunCopy copied_run() {
  const std::string time = "2026-01-31T08:15:30.250Z";
  RunCopy copy;
  copy.run = {.id = 7,
              .recipe = "edf-25",
              .touches_total = 3,
              .touches_done = 2,
              .started_at = time,
              .ended_at = "2026-01-31T08:25:30.250Z",
              .outcome = RunOutcome::kComplete,
              .verdict = Verdict::kAccepted,
              .fault_code = "store_slow",
              .fault_message = "it was slow",
              .operator_name = "M. Curie",
              .block_temperature = StoredTemperature{21.5, 0.25, time, "run"},
              .stiffness = "on",
              .config_digest = "abc",
              .conditions_json = R"({"arm_moving_min":45})"};
  const StoredTouch touch{.number = 1,
                          .plane = 2,
                          .role = calib::TouchRole::kHeldOut,
                          .joints = {1, -2, 3, -4, 5, -6},
                          .overtravel_dmm = 3,
                          .captured_at = time,
                          .session = 4'000'000'000U,
                          .sequence = 5,
                          .aimed_with = kNominalMiss,
                          .noise_um = 12.3456789012345678,
                          .first = FirstContact{cs8::CaptureSource::kPolled, {6, 5, 4, 3, 2, 1}},
                          .again = cs8::JointsMicrodeg{1, 1, 1, 1, 1, 1}};
  StoredTouch other = touch, before = touch;
  other.number = 2;
  other.first.reset();
  other.noise_um.reset();
  other.again.reset();
  before.number = 2;
  before.sequence = 4;
  copy.touches = {touch, other};
  copy.superseded = {{before, "the face was missed"}, {before, "and once more"}};
  copy.references = {
      {.number = 1, .touches_done = 0, .joints = {1, 2, 3, 4, 5, 6}, .drift_mm = {}, .captured_at = time},
      {.number = 2,
       .touches_done = 2,
       .joints = {1, 2, 3, 4, 5, 7},
       .drift_mm = -0.0123,
       .captured_at = time}};
  copy.plan_changes = {{PlanChange::Kind::kDefer, 1}, {PlanChange::Kind::kSkip, 2}};
  copy.refused = {{.session = 4,
                   .sequence = 9,
                   .joints = {9, 8, 7, 6, 5, 4},
                   .reason = "it belongs to no command",
                   .at = time}};
  return copy;
}

}  // namespace cell
