#include "tests/simulation/table_steps.hpp"

#include <spdlog/fmt/fmt.h>

#include "tests/simulation/setting.hpp"

namespace simulation {
namespace {

using cell::Command;
using Steps = std::vector<ScriptStep>;

/// Neither the first nor the last one: touches are stored before it and due behind it.
constexpr int kMiddleTouch = 3;
static_assert(kMiddleTouch < kTouchesMin);

DrawnFault of_kind(FaultKind kind) { return {.kind = kind}; }

Steps operator+(Steps script, ScriptStep next) {
  script.push_back(std::move(next));
  return script;
}

Steps until(const Steps& before, const std::string& sight) { return before + ScriptStep{sight, {}}; }

Steps started() { return {{"state IDLE", {commanded(Command::kStart)}}}; }

/// That at the sight `text` of the touch.
Steps at_touch(const char* text, int number = kMiddleTouch) {
  return until(started(), fmt::format("{} touch {}", text, number));
}

/// ... and then this.
Steps then(Steps script, const DrawnFault& what) {
  script.back().then.push_back(what);
  return script;
}

Steps paused() { return until(then(at_touch("phase: search of"), commanded(Command::kPause)), "state HELD"); }

/// The link was cut in a search and is there again: the arm stands at the face, and a way back is due.
Steps held_at_face() {
  return until(until(then(at_touch("phase: search of"), of_kind(FaultKind::kLinkCut)), "state HELD"),
               "read: welcome");
}

/// A hand was on the stylus before the touch; it is gone when the run is on hold.
Steps held_for_touch() {
  const Steps touched =
      then(at_touch("controller: touch_result of"), of_controller(R"({"fault":"touch_stylus"})"));
  return then(until(touched, "state HELD"), of_controller(R"({"fault":"release_stylus"})"));
}

Steps stopped_at_face() { return until(then(held_at_face(), commanded(Command::kStop)), "state STOPPED"); }

std::vector<TableStep> steps_of_touch() {
  return {
      {"command on its way", at_touch("host:")},
      {"command taken", at_touch("controller: accepted of")},
      {"way to the approach", at_touch("phase: travel of")},
      {"approach", at_touch("phase: approach of")},
      {"search", at_touch("phase: search of")},
      // Between two States the probe can be free again: this is a touch whose contact one of them shows.
      {"contact", at_touch("contact of", 1)},
      {"way back from the face", at_touch("phase: retract of")},
      {"answer on its way", at_touch("controller: touch_result of")},
      {"answer stored", until(at_touch("read: touch_result of"), "disk: synced")},
      {"answer acknowledged", at_touch("host: result_acknowledge of")},
  };
}

std::vector<TableStep> steps_of_run() {
  return {
      {"link is made", {{"host: hello", {}}}},
      {"ready", {{"state IDLE", {}}}},
      {"permit is asked for", until(started(), "host: begin")},
      {"key is awaited", until(started(), "controller: permit awaited")},
      {"run is confirmed", until(started(), "state EXECUTE")},
      {"search of the first touch", at_touch("phase: search of", 1)},
      {"search of the last touch", at_touch("phase: search of", kTouchesMin)},
      {"last answer on its way", at_touch("controller: touch_result of", kTouchesMin)},
      {"conclusion, way to the park posture", until(started(), "phase: travel of travel")},
      {"run is complete", until(started(), "state COMPLETE")},
  };
}

std::vector<TableStep> steps_of_hold() {
  const Steps resumed = then(held_at_face(), commanded(Command::kResume));
  return {
      {"pause, touch ends",
       until(then(at_touch("phase: search of"), commanded(Command::kPause)), "state HOLDING")},
      {"on hold, arm clear", paused()},
      {"on hold for a touch, probe free again", held_for_touch()},
      {"resumes", until(then(paused(), commanded(Command::kResume)), "state UNHOLDING")},
      {"first command behind a hold",
       until(then(paused(), commanded(Command::kResume)), fmt::format("host: touch {}", kMiddleTouch + 1))},
      {"suspended by the monitor speed",
       until(then(at_touch("phase: search of"), of_controller(R"({"fault":"monitor_speed","percent":50})")),
             "state SUSPENDED")},
      {"on hold, arm at the face", held_at_face()},
      {"resumes, key is awaited", until(resumed, "controller: permit awaited")},
      {"resumes, way back", until(resumed, "phase: retract of retract")},
      {"on hold behind a restart of the daemon",
       until(then(at_touch("phase: search of"), of_kind(FaultKind::kKilled)), "state HELD")},
  };
}

std::vector<TableStep> steps_of_end() {
  const Steps reset = then(stopped_at_face(), commanded(Command::kReset));
  const Steps aborted = then(at_touch("phase: search of"), commanded(Command::kAbort));
  const Steps stopped = then(at_touch("phase: search of"), commanded(Command::kStop));
  return {
      {"stop, arm still moves", until(stopped, "state STOPPING")},
      {"stopped, arm back at its approach", until(stopped, "state STOPPED")},
      {"stopped, arm at the face", stopped_at_face()},
      {"reset, key is awaited", until(reset, "controller: permit awaited")},
      {"way back behind a stop", until(reset, "phase: retract of retract")},
      {"abort, arm still moves", until(aborted, "state ABORTING")},
      {"aborted", until(aborted, "state ABORTED")},
  };
}

std::vector<TableStep> all_steps() {
  std::vector<TableStep> steps = steps_of_run();
  const std::vector<TableStep> touch = steps_of_touch();
  steps.insert(steps.begin() + 5, touch.begin(), touch.end());  // behind the confirmation
  for (const auto& more : {steps_of_hold(), steps_of_end()})
    steps.insert(steps.end(), more.begin(), more.end());
  return steps;
}

}  // namespace

std::span<const TableStep> table_steps() {
  static const std::vector<TableStep> steps = all_steps();
  return steps;
}

}  // namespace simulation
