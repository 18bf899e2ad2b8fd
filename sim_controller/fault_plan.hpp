#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace sim {

/// How the simulated controller misbehaves at a message, received or about to be sent.
enum class Fault {
  kCloseSocket,    // the connection ends, the message is lost
  kGoSilent,       // the controller works on, but sends nothing more on this connection
  kGarbage,        // bytes that are no frame are sent in place of it; a received one is lost
  kDrop,           // the message is lost
  kWrongSequence,  // its sequence is raised by kSequenceOffset
};

inline constexpr std::uint32_t kSequenceOffset = 1000;

/// One fault, at the nth message of a type since the server started; counts from 1.
struct PlannedFault {
  Fault fault{};
  cs8::MessageType on{};
  std::uint32_t nth = 1;
};

/// Counts messages and tells when a fault is due.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<PlannedFault> faults) : faults_(std::move(faults)) {}

  /// The fault for this message, which counts as one more of its type.
  std::optional<Fault> next(cs8::MessageType type) {
    const std::uint32_t count = ++counts_[type];
    for (const PlannedFault& planned : faults_) {
      if (planned.on == type && planned.nth == count) return planned.fault;
    }
    return std::nullopt;
  }

 private:
  std::vector<PlannedFault> faults_;
  std::map<cs8::MessageType, std::uint32_t> counts_;
};

}  // namespace sim
