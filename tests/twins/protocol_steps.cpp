#include <utility>

#include "cs8_protocol/names.hpp"
#include "tests/twins/parts.hpp"
#include "tests/twins/scenarios.hpp"

namespace twins {
namespace {

using cs8::MessageType;
using sim::Act;
using sim::Trouble;
using sim::TroubleKind;

/// One command that is refused or not, among touches that are carried out.
Scenario asked(const std::string& name, std::uint32_t sequence, const cs8::Payload& command) {
  return {.name = name,
          .steps = begun() + touches(1, 1) + carried_out(sequence, command) + touches(20, 2) + finished()};
}

Scenario with_field(const std::string& name, void (*change)(cs8::Touch&)) {
  cs8::Touch touch = two_speed_touch_at(2);
  change(touch);
  return asked("field: " + name, 2, touch);
}

}  // namespace

std::vector<Scenario> sequences() {
  std::vector<Scenario> all{
      asked("a gap in the sequence", 9, touch_at(3)),
      asked("a stale sequence", 1, touch_at(3)),
      asked("sequence 0", 0, touch_at(3)),
      asked("a retract with nothing to retract", 2, kWayBack),
      asked("a travel", 2, travel_to(0)),
  };
  for (const int move : {1, 2, 3, 4, 5}) {
    const std::string name = " in move " + std::to_string(move);
    const auto among = [&](const std::string& what, const Deed& deed) {
      Steps steps = begun() + touches(1, 1);
      steps.emplace_back(At{Moment::kMoveBegins, move, 12, deed});
      all.push_back({.name = what + name, .steps = steps + touches(2, 3) + finished()});
    };
    among("the same command again", Send{2, touch_at(2)});
    among("the same sequence of another kind", Send{2, travel_to(0)});
    among("another command", Send{3, touch_at(3)});
    among("a stale command", Send{1, touch_at(3)});
    among("a query for another command", Send{0, cs8::ResultQuery{1}});
    among("an early acknowledgement", Send{0, cs8::ResultAcknowledge{2}});
  }
  const Steps kept{Send{2, touch_at(2)}, AwaitResult{2}};
  const Steps again{Send{2, touch_at(2)}, Wait{0.2}, Send{0, cs8::ResultQuery{2}}, Wait{0.2}};
  const Steps acknowledged{Send{0, cs8::ResultAcknowledge{2}}, Send{0, cs8::ResultQuery{2}}, Wait{0.2}};
  all.push_back(
      {.name = "a result asked again before and behind its acknowledgement",
       .steps = begun() + touches(1, 1) + kept + again + acknowledged + touches(3, 1) + finished()});
  all.push_back({.name = "a command before the acknowledgement",
                 .steps = begun() + touches(1, 1) + kept +
                          Steps{Send{3, touch_at(3)}, Await{MessageType::kRejected}} + acknowledged +
                          touches(3, 1) + finished()});
  all.push_back({.name = "an acknowledgement for another command",
                 .steps = begun() + touches(1, 1) + kept + Steps{Send{0, cs8::ResultAcknowledge{1}}} +
                          Steps{Send{3, touch_at(3)}, Await{MessageType::kRejected}} + acknowledged +
                          touches(3, 1) + finished()});
  all.push_back({.name = "a link lost before the acknowledgement",
                 .steps = begun() + touches(1, 1) + kept +
                          Steps{Disconnect{}, Wait{0.2}, Connect{}, Wait{0.2}} + again + acknowledged +
                          begun(2) + touches(3, 2) + finished()});
  for (const MessageType type : {MessageType::kTouch, MessageType::kResultAcknowledge, MessageType::kBegin,
                                 MessageType::kFinish, MessageType::kHello, MessageType::kResultQuery}) {
    for (const auto& [fault_name, fault] : {std::pair{"drop", sim::Fault::kDrop},
                                            {"duplicate", sim::Fault::kDuplicate},
                                            {"close", sim::Fault::kCloseSocket},
                                            {"wrong_sequence", sim::Fault::kWrongSequence}}) {
      if (fault == sim::Fault::kDrop && type == MessageType::kTouch)
        continue;  // the host would wait for ever
      const std::uint32_t nth =
          type == MessageType::kTouch || type == MessageType::kResultAcknowledge ? 2 : 1;
      all.push_back({.name = std::string(fault_name) + " at " + std::string(cs8::name(type)),
                     .steps = begun() + touches(1, 2) + Steps{Send{0, cs8::ResultQuery{2}}, Wait{0.2}} +
                              touches(3, 1) + finished() + recovered(4),
                     .faults = {{.what = sim::LinkFault(fault), .on = type, .nth = nth}}});
    }
  }
  for (const MessageType type : {MessageType::kTouch, MessageType::kBegin, MessageType::kResultAcknowledge})
    for (const double seconds : {0.15, 0.8})
      all.push_back(
          {.name = "delay at " + std::string(cs8::name(type)) + " of " + std::to_string(seconds) + " s",
           .steps = begun() + touches(1, 2) + Steps{Wait{1.0}} + touches(3, 1) + finished() + recovered(4),
           .faults = {{.what = sim::LinkFault(sim::Fault::kDelay, seconds), .on = type, .nth = 1}}});
  for (const MessageType type : {MessageType::kTouchResult, MessageType::kPermit})
    all.push_back({.name = "half_open at " + std::string(cs8::name(type)),
                   .steps = begun() + touches(1, 2) + recovered(2),
                   .faults = {{.what = sim::LinkFault(sim::Fault::kHalfOpen), .on = type, .nth = 2}}});
  return all;
}

std::vector<Scenario> fields() {
  std::vector<Scenario> all{
      with_field("travel speed 0", [](cs8::Touch& t) { t.travel_speed_um_s = 0; }),
      with_field("travel speed too high", [](cs8::Touch& t) { t.travel_speed_um_s = 250'001; }),
      with_field("approach speed 0", [](cs8::Touch& t) { t.approach_speed_um_s = 0; }),
      with_field("approach speed too high", [](cs8::Touch& t) { t.approach_speed_um_s = 20'001; }),
      with_field("search speed negative", [](cs8::Touch& t) { t.search_speed_um_s = -1; }),
      with_field("search too fast", [](cs8::Touch& t) { t.search_speed_um_s = 100'000; }),
      with_field("second speed above the first", [](cs8::Touch& t) { t.second_speed_um_s = 9'000; }),
      with_field("second speed negative", [](cs8::Touch& t) { t.second_speed_um_s = -1; }),
      with_field("back-off too short", [](cs8::Touch& t) { t.second_backoff_dmm = 4'999; }),
      with_field("back-off too long", [](cs8::Touch& t) { t.second_backoff_dmm = 50'001; }),
      with_field("back-off longer than the search", [](cs8::Touch& t) { t.second_backoff_dmm = 50'000; }),
      with_field("no deadline", [](cs8::Touch& t) { t.deadline_ms = 0; }),
      with_field("a search without length", [](cs8::Touch& t) { t.search_end = t.approach; }),
      with_field("a search too long",
                 [](cs8::Touch& t) {
                   t.search_end = t.clear;
                   t.search_end[1] += 40'000'000;
                 }),
      with_field("out of range", [](cs8::Touch& t) { t.clear[4] = 200'000'000; }),
      with_field("unused via out of range", [](cs8::Touch& t) { t.via[0][4] = 200'000'000; }),
      with_field("used via out of range",
                 [](cs8::Touch& t) {
                   t.via_count = 1;
                   t.via[0] = t.clear;
                   t.via[0][2] = -200'000'000;
                 }),
      with_field("two vias",
                 [](cs8::Touch& t) {
                   t.via_count = 2;
                   t.via[0] = t.via[1] = t.clear;
                   t.via[0][0] += 1'000'000;
                 }),
  };
  for (const std::uint32_t deadline_ms : {1U, 40U, 600U, 1'000U, 1'600U, 2'200U, 3'000U}) {
    cs8::Touch touch = touch_at(2);
    touch.deadline_ms = deadline_ms;
    all.push_back({.name = "deadline of " + std::to_string(deadline_ms) + " ms",
                   .steps = begun() + touches(1, 1) + carried_out(2, touch) + recovered(2)});
  }
  return all;
}

std::vector<Scenario> links() {
  std::vector<Scenario> all;
  const auto add = [&all](const std::string& name, const Steps& steps) {
    all.push_back({.name = name, .steps = steps + begun(4) + touches(20, 3) + finished()});
  };
  add("no Hello", {Connect{.says_hello = false}, Wait{2.5}});
  add("Begin before Hello", {Connect{.says_hello = false}, Send{0, cs8::Begin{1, 1000}}, Wait{1.0}});
  add("a message of the controller's before Hello",
      {Connect{.says_hello = false}, Send{0, cs8::Accepted{}}, Wait{1.0}});
  add("a message of the controller's", begun() + Steps{Send{0, cs8::Accepted{}}, Wait{1.0}});
  add("a second client", begun() + Steps{SecondClient{}, Wait{0.2}} + touches(1, 1));
  add("a second client before Hello",
      {Connect{.says_hello = false}, SecondClient{}, Wait{0.1}, Disconnect{}});
  add("a second Hello",
      begun() + Steps{Send{0, cs8::Hello{300}}, Wait{0.3}, Send{1, touch_at(1)}, Wait{0.3}});
  add("a second Hello while awaited", {Connect{}, Await{MessageType::kWelcome}, Send{0, cs8::Begin{1, 5000}},
                                       Wait{0.05}, Send{0, cs8::Hello{500}}, Wait{0.5}});
  for (const std::uint32_t timeout_ms : {0U, 200U, 900U, 5'000U})
    add("a timeout of " + std::to_string(timeout_ms) + " ms",
        {Connect{.says_hello = false}, Send{0, cs8::Hello{timeout_ms}}, Await{MessageType::kWelcome},
         Wait{0.3}, Heartbeats{false}, Wait{2.5}, Heartbeats{true}});
  add("reconnected at once",
      begun() + Steps{Disconnect{}, Connect{}, Wait{0.2}, Disconnect{}, Connect{}, Wait{0.2}});
  add("Stop with nothing running", begun() + Steps{Send{0, cs8::Stop{}}, Wait{0.2}} + touches(1, 1));
  add("Stop with a stored result", begun() +
                                       Steps{Send{1, touch_at(1)}, AwaitResult{1}, Send{0, cs8::Stop{}},
                                             Wait{0.2}, Send{0, cs8::ResultAcknowledge{1}}} +
                                       touches(2, 1));
  add("Finish without a permit", {Connect{}, Wait{0.1}, Send{0, cs8::Finish{}}, Wait{0.1}});
  return all;
}

std::vector<Scenario> permits() {
  std::vector<Scenario> all;
  const Steps asked{Connect{}, Await{MessageType::kWelcome}, Send{0, cs8::Begin{1, 1'000}},
                    Await{MessageType::kPermit}, Wait{0.05}};
  all.push_back({.name = "no touch test", .steps = begun() + touches(1, 1), .touch_tested = false});
  all.push_back({.name = "no power", .steps = begun() + touches(1, 1), .powered = false});
  all.push_back(
      {.name = "nobody confirms", .steps = asked + Steps{Wait{1.5}} + touches(1, 1), .confirms = false});
  all.push_back(
      {.name = "confirmed late", .steps = asked + Steps{Wait{2.5}} + touches(1, 1), .confirms_after_s = 1.4});
  const auto add = [&all](const std::string& name, const Steps& steps) {
    all.push_back({.name = name, .steps = steps + recovered(4)});
  };
  add("a touch while awaited", asked + touches(1, 1));
  add("Finish while awaited", asked + Steps{Send{0, cs8::Finish{}}, Wait{0.5}} + touches(1, 1));
  add("Begin while awaited", asked + Steps{Send{0, cs8::Begin{2, 2'000}}, Wait{0.8}} + touches(1, 1));
  add("Begin while granted", begun() + Steps{Send{0, cs8::Begin{2, 2'000}}, Wait{0.8}} + touches(1, 1));
  add("Begin before the acknowledgement",
      begun() + Steps{Send{1, touch_at(1)}, AwaitResult{1}, Send{0, cs8::Begin{2, 2'000}}, Wait{0.5},
                      Send{0, cs8::ResultAcknowledge{1}}, Wait{0.1}});
  add("a touch without a permit", Steps{Connect{}, Await{MessageType::kWelcome}} + touches(1, 1));
  struct Cause {
    const char* name;
    sim::InjectedEvent what;
  };
  const std::vector<Cause> causes{{"power_off", Act::kPowerOff},
                                  {"manual_mode", Act::kManualMode},
                                  {"local_mode", Act::kLocalMode},
                                  {"open_cell", Act::kOpenCell},
                                  {"hold", Act::kHold},
                                  {"emergency_stop", Act::kEmergencyStop},
                                  {"touch_stylus", Act::kTouchStylus},
                                  {"press_confirm", Act::kPressConfirm},
                                  {"confirmation_key_stuck", Trouble{TroubleKind::kConfirmationKeyStuck}},
                                  {"references_lost", Trouble{TroubleKind::kReferencesLost}},
                                  {"monitor_speed", Trouble{TroubleKind::kMonitorSpeed, 80}},
                                  {"contact_cut", Trouble{TroubleKind::kContactCut}},
                                  {"contact_short", Trouble{TroubleKind::kContactShort}},
                                  {"loop_cut", Trouble{TroubleKind::kLoopCut}},
                                  {"loop_short", Trouble{TroubleKind::kLoopShort}},
                                  {"task_dies", Trouble{TroubleKind::kTaskDies, 61}},
                                  {"jog_home", Act::kJogHome},
                                  {"restart", Trouble{TroubleKind::kRestarts}}};
  for (const Cause& cause : causes) {
    const std::string name = cause.name;
    add(name + " before Begin", Steps{Connect{}, Await{MessageType::kWelcome}, Strike{cause.what}, Wait{0.2},
                                      Send{0, cs8::Begin{1, 1'000}}, Wait{1.2}} +
                                    touches(1, 1));
    add(name + " while awaited", asked + Steps{Strike{cause.what}, Wait{1.2}} + touches(1, 1));
    add(name + " while granted", begun() + Steps{Strike{cause.what}, Wait{0.2}} + touches(1, 1));
  }
  return all;
}

}  // namespace twins
