#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace cell {

class RunStore;

/// A contact that the controller answered and that counts for nothing: kept before the controller forgets it.
struct RefusedResult {
  std::uint32_t session = 0;  // of the controller's application
  std::uint32_t sequence = 0;
  cs8::JointsMicrodeg joints{};  // 10^-6 degrees
  std::string reason;            // in words
  std::string at;                // RFC 3339, when it was refused

  bool operator==(const RefusedResult&) const = default;
};

/// At most so many of a run: more than its touches have tries, unless something is broken. What comes behind
/// them is in the log only.
inline constexpr int kRefusedKept = 200;

/// Durable on return; where the answer to this command is kept already, as refused or as a touch, nothing is
/// written. False, and
/// nothing is written, where the run has kRefusedKept of them already, or is not in the store. Throws what
/// the database throws.
bool keep_refused(RunStore& store, std::int64_t run_id, const RefusedResult& refused);

/// The run that an answer is kept with which no run of this daemon asked for: the one whose last touch
/// command it answers, else the newest; nothing where there is no run.
std::optional<std::int64_t> run_of_answer(const RunStore& store, std::uint32_t session,
                                          std::uint32_t sequence);

/// Of a run, oldest first. DamagedStore for a row that is not as it was written, or gone from a run that
/// ended.
std::vector<RefusedResult> refused_results(const RunStore& store, std::int64_t run_id);

}  // namespace cell
