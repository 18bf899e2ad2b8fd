#include "tests/twins/parts.hpp"

#include <array>

#include "sim_controller/admission.hpp"
#include "tests/sim_controller/aimed_touch.hpp"
#include "tests/sim_controller/bench.hpp"

namespace twins {
namespace {

constexpr double kSearchStandoffMetres = 0.010;
constexpr double kLongStandoffMetres = 0.025;
/// Above where the nominal arm believes the face: its true place is some 5 mm off.
constexpr double kAboveMetres = 0.012;

sim::testing::Aim aim_at(int place) {
  return {.u_m = 0.006 * (place - 2),
          .v_m = 0.004 * (place % 3 - 1),
          .standoff_m = kSearchStandoffMetres,
          .end_depth_m = kSearchStandoffMetres};
}

sim::TouchMotion motion_of(const sim::testing::Aim& aim) {
  return sim::testing::aimed_touch(sim::testing::read_cell("demo"), aim).motion;
}

const sim::TouchMotion& motion_at(int place) {
  static const auto motions = [] {
    std::array<sim::TouchMotion, kPlaces> made;
    for (int i = 0; i < kPlaces; ++i) made.at(static_cast<std::size_t>(i)) = motion_of(aim_at(i));
    return made;
  }();
  return motions.at(static_cast<std::size_t>(place % kPlaces));
}

}  // namespace

Steps& operator+=(Steps& steps, const Steps& more) {
  steps.insert(steps.end(), more.begin(), more.end());
  return steps;
}

Steps operator+(Steps steps, const Steps& more) {
  steps += more;
  return steps;
}

cs8::Touch touch_at(int place) { return sim::testing::touch_command(motion_at(place)); }

cs8::Touch two_speed_touch_at(int place) {
  cs8::Touch touch = touch_at(place);
  touch.second_speed_um_s = 2000;
  touch.second_backoff_dmm = 8000;
  return touch;
}

cs8::Touch shallow_touch_at(int place) {
  sim::testing::Aim aim = aim_at(place);
  aim.standoff_m = kLongStandoffMetres;
  aim.end_depth_m = -kAboveMetres;
  return sim::testing::touch_command(motion_of(aim));
}

cs8::Touch long_touch_at(int place) {
  sim::testing::Aim aim = aim_at(place);
  aim.standoff_m = kLongStandoffMetres;
  return sim::testing::touch_command(motion_of(aim));
}

cell::JogOrder jog_to_end_of(int place) {
  return {.joints = motion_at(place).search_end, .speed_m_s = 0.010};
}

cell::JogOrder jog_to_clear_of(int place) {
  return {.joints = motion_at(place).waypoints.back(), .speed_m_s = 0.010, .until_touch = false};
}

cs8::Travel travel_to(int place) { return sim::testing::travel_command(motion_at(place).waypoints.back()); }

Steps begun(std::uint32_t run) {
  return {Connect{}, Await{cs8::MessageType::kWelcome}, Send{0, cs8::Begin{run, 30'000}},
          Await{cs8::MessageType::kPermit}, Await{cs8::MessageType::kPermit, 1.0}};
}

Steps carried_out(std::uint32_t sequence, const cs8::Payload& command) {
  return {Send{sequence, command}, AwaitResult{sequence}, Send{0, cs8::ResultAcknowledge{sequence}}};
}

Steps touches(std::uint32_t from, int count) {
  Steps steps;
  for (std::uint32_t i = from; i < from + static_cast<std::uint32_t>(count); ++i)
    steps += carried_out(i, touch_at(static_cast<int>(i)));
  return steps;
}

Steps finished() { return {Send{0, cs8::Finish{}}, Wait{0.2}}; }

Steps recovered(std::uint32_t broken_sequence) {
  using sim::Act;
  Steps steps{Wait{0.6}};
  for (const sim::InjectedEvent& act : {sim::InjectedEvent{Act::kPowerOff},
                                        {Act::kReleaseEmergencyStop},
                                        {Act::kAcknowledgeEmergencyStop},
                                        {Act::kRemoteMode},
                                        {Act::kCloseCell},
                                        {Act::kMove},
                                        {sim::Trouble{sim::TroubleKind::kProbeMended}},
                                        {sim::Trouble{sim::TroubleKind::kReferencesFound}},
                                        {sim::Trouble{sim::TroubleKind::kSettles}},
                                        {sim::Trouble{sim::TroubleKind::kMonitorSpeed, 100}}})
    steps.emplace_back(Strike{act});
  steps += {Wait{0.1}, Strike{Act::kTouchStylus}, Wait{0.1}, Strike{Act::kReleaseStylus},
            Wait{0.1}, Strike{Act::kPowerOn},     Wait{0.1}};
  steps += {Connect{},
            Wait{0.1},
            Send{0, cs8::ResultQuery{broken_sequence}},
            Wait{0.2},
            Send{0, cs8::ResultAcknowledge{broken_sequence}},
            Wait{0.1},
            Send{0, cs8::Begin{2, 30'000}},
            Wait{0.6}};
  steps += carried_out(broken_sequence + 1, kWayBack);
  steps += {Wait{0.2}, Send{0, cs8::Begin{3, 30'000}}, Wait{0.6}};
  steps += touches(broken_sequence + 2, 2);
  return steps + finished();
}

}  // namespace twins
