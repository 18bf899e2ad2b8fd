#include "tests/simulation/virtual_clock.hpp"

#include <ctime>
#include <stdexcept>

namespace simulation {
namespace {

VirtualClock* the_clock = nullptr;

/// When a world begins: the clock of the day in 2026, the other one where zero means nothing.
constexpr std::chrono::seconds kWallBegin{1'790'000'000};
constexpr std::chrono::seconds kSteadyBegin{1'000'000};

Time of_machine(clockid_t id) {
  timespec now{};
  ::clock_gettime(id, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace

VirtualClock::VirtualClock() {
  if (the_clock != nullptr) throw std::logic_error("two simulated worlds at a time");
  the_clock = this;
}

VirtualClock::~VirtualClock() { the_clock = nullptr; }

VirtualClock* VirtualClock::current() { return the_clock; }

}  // namespace simulation

// NOLINTBEGIN(cert-dcl58-cpp): this is how time enters, see virtual_clock.hpp.
namespace std::chrono {
inline namespace _V2 {

steady_clock::time_point steady_clock::now() noexcept {
  const simulation::VirtualClock* clock = simulation::the_clock;
  return time_point(clock ? duration(simulation::kSteadyBegin + clock->now())
                          : duration(simulation::of_machine(CLOCK_MONOTONIC)));
}

system_clock::time_point system_clock::now() noexcept {
  const simulation::VirtualClock* clock = simulation::the_clock;
  return time_point(clock ? duration(simulation::kWallBegin + clock->now() + clock->wall_ahead())
                          : duration(simulation::of_machine(CLOCK_REALTIME)));
}

}  // namespace _V2
}  // namespace std::chrono
// NOLINTEND(cert-dcl58-cpp)
