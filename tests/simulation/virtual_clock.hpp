#pragma once

#include <chrono>
#include <cstdint>

/// Time in the simulated world. How it gets into the product's code was a choice of three:
///
/// 1. an interface like `Wake` wherever something waits: every timer of link, client, connection and server
///    would change, and what is tested would no longer be what is shipped;
/// 2. `basic_waitable_timer` over a clock of ours: the same files change, and their types;
/// 3. what is here: the programs of tests/simulation define `steady_clock::now()`, `system_clock::now()` and
///    the few system calls of sockets that Asio makes (system_calls.cpp). The linker takes these before those
///    of the system. Product code stays as it is, to the byte of its object files.
///
/// The third is the plainest, and it is sound: Asio asks for the time and waits in these places only. Without
/// a timerfd (it is told that there is none) its reactor compares its timers with `steady_clock::now()` at
/// each turn and gives `epoll_wait` the time to the next one; the world answers at once and moves the clock.
/// There is one thread, so nothing runs beside. Only what blocks in another way would stand outside: a
/// look-up of a name (Cs8Controller needs none for an address) and the planner's thread (plans are handed
/// in).
namespace simulation {

using Time = std::chrono::nanoseconds;  // since the world began

/// The clocks of one world. While one exists, the process has its time; only one exists at a time. Before and
/// behind it the process has the machine's clocks.
class VirtualClock {
 public:
  VirtualClock();
  ~VirtualClock();
  VirtualClock(const VirtualClock&) = delete;
  VirtualClock& operator=(const VirtualClock&) = delete;

  [[nodiscard]] Time now() const { return now_; }
  /// Not back: an earlier time changes nothing.
  void advance_to(Time time) { now_ = time > now_ ? time : now_; }
  /// Somebody sets the machine's clock of the day; nothing passes.
  void set_wall_clock_ahead(Time ahead) { wall_ahead_ = ahead; }
  [[nodiscard]] Time wall_ahead() const { return wall_ahead_; }

  /// Null while the process has the machine's clocks.
  static VirtualClock* current();

 private:
  Time now_{0};
  Time wall_ahead_{0};
};

}  // namespace simulation
