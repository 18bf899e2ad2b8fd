#include "tests/sim_controller/bench.hpp"
#include "tests/twins/parts.hpp"
#include "tests/twins/scenarios.hpp"

namespace twins {
namespace {

using cs8::MessageType;
using sim::Act;

/// A run that follows its drift touches one place again and again among the others.
Scenario followed(std::uint64_t seed) {
  constexpr std::uint32_t kTouches = 6;
  Steps steps = begun();
  for (std::uint32_t i = 1; i <= kTouches; ++i)
    steps +=
        i % 2 == 1 ? carried_out(i, two_speed_touch_at(0)) : carried_out(i, touch_at(static_cast<int>(i)));
  return {.name = "reference touches with seed " + std::to_string(seed),
          .steps = steps + finished(),
          .seed = seed};
}

/// Where a block stands is not known when it is located: searches end above it, or are as long as they may
/// be.
std::vector<Scenario> located() {
  std::vector<Scenario> all;
  const Steps shallow = carried_out(1, shallow_touch_at(2));
  all.push_back(
      {.name = "a search that meets nothing, then a deeper one",
       .steps = begun() + shallow + carried_out(2, two_speed_touch_at(2)) + touches(3, 2) + finished()});
  cs8::Touch slow = shallow_touch_at(3);
  slow.second_speed_um_s = 2000;
  slow.second_backoff_dmm = 8000;
  all.push_back({.name = "a two-speed search that meets nothing",
                 .steps = begun() + carried_out(1, slow) + touches(2, 2) + finished()});
  all.push_back(
      {.name = "searches of 35 mm",
       .steps = begun() + carried_out(1, long_touch_at(1)) + carried_out(2, long_touch_at(3)) + finished()});
  Steps stopped = begun();
  stopped.emplace_back(At{Moment::kMoveBegins, 3, 300, Send{0, cs8::Stop{}}});
  stopped += carried_out(1, long_touch_at(2)) + recovered(1);
  all.push_back({.name = "a search of 35 mm that is stopped", .steps = stopped});
  return all;
}

/// A person touches by the pendant; the host listens.
Steps touched_by_hand(int place) {
  return {Jog{jog_to_end_of(place)}, Wait{8.0}, Jog{jog_to_clear_of(place)}, Wait{8.0}};
}

Steps in_manual_mode() { return {Strike{Act::kManualMode}, Wait{0.2}, Strike{Act::kPowerOn}, Wait{0.2}}; }
Steps in_remote_mode() { return {Strike{Act::kRemoteMode}, Wait{0.2}, Strike{Act::kPowerOn}, Wait{0.2}}; }
Steps asked_to_begin(std::uint32_t run) {
  return {Send{0, cs8::Begin{run, 30'000}}, Await{MessageType::kPermit}, Await{MessageType::kPermit}};
}

std::vector<Scenario> guided() {
  std::vector<Scenario> all;
  const Steps near_block = begun() + touches(1, 1) + finished() + in_manual_mode();
  for (std::uint64_t seed = 1; seed <= 2; ++seed)
    all.push_back({.name = "touched by hand with seed " + std::to_string(seed),
                   .steps = near_block + touched_by_hand(1) + touched_by_hand(1) + in_remote_mode() +
                            asked_to_begin(2) + touches(2, 1) + finished(),
                   .seed = seed});
  all.push_back({.name = "touched by hand while the link is lost",
                 .steps = near_block +
                          Steps{Jog{jog_to_end_of(1)}, Wait{0.4}, Disconnect{}, Wait{8.0}, Connect{},
                                Await{MessageType::kWelcome}, Jog{jog_to_clear_of(1)}, Wait{8.0}} +
                          in_remote_mode() + asked_to_begin(2) + touches(2, 1) + finished()});
  all.push_back({.name = "a run that is asked for while a person jogs",
                 .steps = near_block +
                          Steps{Jog{jog_to_end_of(1)}, Wait{0.5}, Send{0, cs8::Begin{2, 1'000}}, Wait{8.0},
                                Jog{jog_to_clear_of(1)}, Wait{8.0}} +
                          in_remote_mode() + asked_to_begin(3) + touches(2, 1) + finished()});
  all.push_back({.name = "a hand touch with the run's permit standing",
                 .steps = begun() + touches(1, 1) + in_manual_mode() + touched_by_hand(1) + in_remote_mode() +
                          touches(2, 1) + asked_to_begin(2) + touches(3, 1) + finished()});
  return all;
}

}  // namespace

/// Runs that follow drift, locate the block or are guided by a person, as the controller sees them.
std::vector<Scenario> measurements() {
  std::vector<Scenario> all;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) all.push_back(followed(seed));
  for (Scenario& scenario : located()) all.push_back(std::move(scenario));
  for (Scenario& scenario : guided()) all.push_back(std::move(scenario));
  return all;
}

}  // namespace twins
