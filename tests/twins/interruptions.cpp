#include <array>

#include "tests/twins/parts.hpp"
#include "tests/twins/scenarios.hpp"

namespace twins {
namespace {

using sim::Act;
using sim::Trouble;
using sim::TroubleKind;

struct Interruption {
  std::string name;
  Deed deed;
};

Deed acted(Act act) { return Strike{act}; }
Deed troubled(TroubleKind kind, int number = 0, double seconds = 0.0) {
  return Strike{Trouble{kind, number, seconds}};
}
Deed sent(const cs8::Payload& payload) { return Send{0, payload}; }

/// Every fault of probe, controller and people, and what a host can do, by the faults' names.
std::vector<Interruption> interruptions() {
  return {
      {"probe_stuck", troubled(TroubleKind::kStylusSticks)},
      {"probe_touched", troubled(TroubleKind::kStylusStaysTouched)},
      {"probe_dead", troubled(TroubleKind::kStylusNeverTouches)},
      {"probe_bounces", troubled(TroubleKind::kProbeBounces, 3)},
      {"vibration", troubled(TroubleKind::kVibration, 0, 0.008)},
      {"latch_lost", troubled(TroubleKind::kLatchLost)},
      {"contact_cut", troubled(TroubleKind::kContactCut)},
      {"contact_short", troubled(TroubleKind::kContactShort)},
      {"loop_cut", troubled(TroubleKind::kLoopCut)},
      {"loop_short", troubled(TroubleKind::kLoopShort)},
      {"probe_mended", troubled(TroubleKind::kProbeMended)},
      {"task_dies", troubled(TroubleKind::kTaskDies, 20)},
      {"restart", troubled(TroubleKind::kRestarts)},
      {"monitor_speed", troubled(TroubleKind::kMonitorSpeed, 50)},
      {"references_lost", troubled(TroubleKind::kReferencesLost)},
      {"references_found", troubled(TroubleKind::kReferencesFound)},
      {"motion_error", troubled(TroubleKind::kMotionError, 150)},
      {"collision", troubled(TroubleKind::kCollision)},
      {"never_settles", troubled(TroubleKind::kNeverSettles)},
      {"settles", troubled(TroubleKind::kSettles)},
      {"power_on", acted(Act::kPowerOn)},
      {"power_off", acted(Act::kPowerOff)},
      {"manual_mode", acted(Act::kManualMode)},
      {"local_mode", acted(Act::kLocalMode)},
      {"remote_mode", acted(Act::kRemoteMode)},
      {"open_cell", acted(Act::kOpenCell)},
      {"close_cell", acted(Act::kCloseCell)},
      {"touch_stylus", acted(Act::kTouchStylus)},
      {"release_stylus", acted(Act::kReleaseStylus)},
      {"press_confirm", acted(Act::kPressConfirm)},
      {"release_confirm", acted(Act::kReleaseConfirm)},
      {"confirmation_key_stuck", troubled(TroubleKind::kConfirmationKeyStuck)},
      {"confirms_late", troubled(TroubleKind::kConfirmsLate, 0, 0.3)},
      {"hold", acted(Act::kHold)},
      {"move", acted(Act::kMove)},
      {"emergency_stop", acted(Act::kEmergencyStop)},
      {"release_emergency_stop", acted(Act::kReleaseEmergencyStop)},
      {"acknowledge_emergency_stop", acted(Act::kAcknowledgeEmergencyStop)},
      {"overruns", troubled(TroubleKind::kOverruns, 2)},
      {"jog_home", acted(Act::kJogHome)},
      {"stop", sent(cs8::Stop{})},
      {"lost_link", Disconnect{}},
      {"silence", Heartbeats{false}},
      {"second_hello", sent(cs8::Hello{500})},
      {"finish", sent(cs8::Finish{})},
      {"begin", sent(cs8::Begin{7, 5'000})},
      {"query", sent(cs8::ResultQuery{2})},
  };
}

/// Where it strikes: in a touch of so many moves, the travel the first.
struct Place {
  std::string name;
  Moment moment = Moment::kMoveBegins;
  int nth = 1;
  int ticks_after = 10;
};

Scenario struck(const Interruption& what, const Place& place, const cs8::Touch& touch) {
  Steps steps = begun() + touches(1, 1);
  steps.emplace_back(At{place.moment, place.nth, place.ticks_after, what.deed});
  steps += carried_out(2, touch) + recovered(2);
  return {.name = what.name + " " + place.name, .steps = steps};
}

}  // namespace

std::vector<Scenario> interrupted_touches() {
  const std::array places{Place{"in the travel"},
                          Place{"in the approach", Moment::kMoveBegins, 2},
                          Place{"in the search", Moment::kMoveBegins, 3},
                          Place{"behind the trigger", Moment::kProbeTrips, 1, 6},
                          Place{"in the retract", Moment::kMoveBegins, 4},
                          Place{"on the way to clear", Moment::kMoveBegins, 5, 25}};
  std::vector<Scenario> all;
  for (const Interruption& what : interruptions()) {
    for (const Place& place : places) all.push_back(struck(what, place, touch_at(2)));
  }
  return all;
}

std::vector<Scenario> interrupted_second_touches() {
  const std::array places{Place{"in the back-off", Moment::kMoveBegins, 4},
                          Place{"in the second search", Moment::kMoveBegins, 5},
                          Place{"behind the second trigger", Moment::kProbeTrips, 2, 6}};
  std::vector<Scenario> all;
  for (const Interruption& what : interruptions()) {
    for (const Place& place : places) all.push_back(struck(what, place, two_speed_touch_at(2)));
  }
  return all;
}

/// A second stop, or something else, on the way back of a stopped search; a retract that is broken off.
std::vector<Scenario> interrupted_ways_back() {
  std::vector<Scenario> all;
  for (const Interruption& what : interruptions()) {
    Steps stopped = begun() + touches(1, 1);
    stopped.emplace_back(At{Moment::kMoveBegins, 3, 60, Send{0, cs8::Stop{}}});
    stopped.emplace_back(At{Moment::kMoveBegins, 4, 4, what.deed});
    stopped += carried_out(2, touch_at(2)) + recovered(2);
    all.push_back({.name = what.name + " in the return of a stopped search", .steps = stopped});
    Steps retracted = begun() + touches(1, 1);
    retracted.emplace_back(At{Moment::kMoveBegins, 3, 60, Send{0, cs8::Stop{}}});
    retracted += carried_out(2, touch_at(2)) + Steps{Wait{0.2}};
    retracted.emplace_back(At{Moment::kMoveBegins, 1, 10, what.deed});
    retracted += carried_out(3, kWayBack) + recovered(3);
    all.push_back({.name = what.name + " in a retract", .steps = retracted});
  }
  Steps freed = begun() + touches(1, 1);
  freed.emplace_back(At{Moment::kMoveBegins, 3, 60, Send{0, cs8::Stop{}}});
  freed += carried_out(2, touch_at(2)) +
           Steps{Wait{0.2}, Strike{Act::kManualMode}, Wait{0.2}, Strike{Act::kJogHome}, Wait{0.2}};
  all.push_back({.name = "freed by hand behind a stopped search", .steps = freed + recovered(2)});
  return all;
}

}  // namespace twins
