#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/link_faults.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/troubles.hpp"

namespace sim {

// ---- when a fault comes ----

struct AtOnce {};
struct AtConnection {};  // a host connects and is accepted
struct AtTouch {         // a touch reaches this phase
  cs8::Phase phase = cs8::Phase::kSearch;
};
/// A message type: just before the controller takes such a message, or just before it sends one.
using Trigger = std::variant<AtOnce, AtConnection, AtTouch, cs8::MessageType>;

using InjectedEvent = std::variant<LinkFault, Trouble, Act>;

/// One fault, at the nth time its trigger comes since it was planned; counts from 1.
struct PlannedFault {
  InjectedEvent what;
  Trigger on = AtOnce{};
  std::uint32_t nth = 1;
  bool every = false;    // not only the nth time
  double after_s = 0.0;  // simulated time from the trigger
};

/// Counts messages and touches and returns the faults that are due. Reads no clock.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<PlannedFault> faults = {});

  void add(const PlannedFault& fault);

  /// Counts one more connection, or one more message of this type. Returns the link faults that apply to it;
  /// other events planned for it start to wait.
  std::vector<LinkFault> faults_at_connection();
  std::vector<LinkFault> faults_at(cs8::MessageType type);

  /// Call at each tick with the sequence of the touch that runs, 0 for none, and its phase.
  void on_touch_phase(std::uint32_t touch_sequence, cs8::Phase phase);

  /// Call at each tick with the simulated time since the last call. Returns the events that are due, each
  /// once, in the order in which they were planned.
  std::vector<InjectedEvent> advance(double seconds);
  /// True while an event waits for its time.
  [[nodiscard]] bool waits() const { return !waiting_.empty(); }

 private:
  struct Counted {
    PlannedFault planned;
    std::uint32_t seen = 0;
    bool in_its_touch = false;
  };
  struct Waiting {
    InjectedEvent what;
    double left_s = 0.0;
  };

  static bool count_trigger(Counted& fault);
  void count_touch();
  void start_faults_of(cs8::Phase phase);
  template <class Matches>
  std::vector<LinkFault> matching_faults(Matches matches);

  std::vector<Counted> faults_;
  std::vector<Waiting> waiting_;
  std::uint32_t touch_ = 0;
  cs8::Phase phase_ = cs8::Phase::kIdle;
};

}  // namespace sim
