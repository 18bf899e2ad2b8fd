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
struct AtConnection {};  // somebody connects; not the ones that are turned away
struct AtTouch {         // a touch comes to this phase
  cs8::Phase phase = cs8::Phase::kSearch;
};
/// A message type: just before the controller takes such a message, or just before it sends one.
using Trigger = std::variant<AtOnce, AtConnection, AtTouch, cs8::MessageType>;

using Misfortune = std::variant<LinkFault, Trouble, Act>;

/// One fault, at the nth time its trigger comes since it was planned; counts from 1.
struct PlannedFault {
  Misfortune what;
  Trigger on = AtOnce{};
  std::uint32_t nth = 1;
  bool every = false;    // not only the nth time
  double after_s = 0.0;  // simulated time from the trigger
};

/// Counts messages and touches and tells which faults are due. A value without a clock.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<PlannedFault> faults = {});

  void add(const PlannedFault& fault);

  /// A connection or a message, which counts as one more of its type: what of the link's faults meets it.
  /// Other faults that come with it are due from now on.
  std::vector<LinkFault> meet_connection();
  std::vector<LinkFault> meet(cs8::MessageType type);

  /// Where the arm is: the sequence of the touch that runs, 0 for none, and its phase. To be told at each
  /// tick.
  void follow(std::uint32_t touch_sequence, cs8::Phase phase);

  /// What is due when so much simulated time has passed since the last call, in the order it was planned;
  /// each once. To be asked at each tick.
  std::vector<Misfortune> pass(double seconds);
  /// Something is due after some more time.
  [[nodiscard]] bool waits() const { return !waiting_.empty(); }

 private:
  struct Counted {
    PlannedFault planned;
    std::uint32_t seen = 0;
    bool in_its_touch = false;
  };
  struct Waiting {
    Misfortune what;
    double left_s = 0.0;
  };

  static bool comes(Counted& fault);
  void take_touch();
  void enter(cs8::Phase phase);
  template <class IsMet>
  std::vector<LinkFault> meet_those(IsMet is_met);

  std::vector<Counted> faults_;
  std::vector<Waiting> waiting_;
  std::uint32_t touch_ = 0;
  cs8::Phase phase_ = cs8::Phase::kIdle;
};

}  // namespace sim
