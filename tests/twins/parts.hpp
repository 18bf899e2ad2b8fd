#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/twins/scenario.hpp"

/// What scenarios are made of.
namespace twins {

using Steps = std::vector<Step>;

Steps& operator+=(Steps& steps, const Steps& more);
Steps operator+(Steps steps, const Steps& more);

/// Touches of the demo block's top face, each at another place of it; they begin and end close to it.
inline constexpr int kPlaces = 5;
cs8::Touch touch_at(int place);
cs8::Touch two_speed_touch_at(int place);
/// Whose search ends above the face, and whose is 35 mm long.
cs8::Touch shallow_touch_at(int place);
cs8::Touch long_touch_at(int place);
/// By the pendant, from the clear posture to where the search ends, until the probe trips; and back.
cell::JogOrder jog_to_end_of(int place);
cell::JogOrder jog_to_clear_of(int place);
/// Between two clear postures.
cs8::Travel travel_to(int place);
inline constexpr cs8::Retract kWayBack{.approach_speed_um_s = 20'000, .deadline_ms = 60'000};

/// Connects, and asks for a run until it is granted or refused.
Steps begun(std::uint32_t run = 1);
/// A command, its result, the acknowledgement.
Steps carried_out(std::uint32_t sequence, const cs8::Payload& command);
/// So many touches from that sequence on.
Steps touches(std::uint32_t from, int count);
Steps finished();
/// Somebody puts everything right, touch test with power off included; then the host connects, asks for the
/// result of that command, acknowledges it, goes back by a Retract and makes two touches more.
Steps recovered(std::uint32_t broken_sequence);

}  // namespace twins
