#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// Something that a person at the cell does before the arm may move.
struct Awaited {
  std::string_view name;   // in the API: "touch_test"
  std::string_view words;  // what to do
};

/// What a refused Begin waits for; nothing when no person at the cell can mend it. The touch test comes
/// before what else is missing, as it is made in manual mode or with power off, but not with a probe whose
/// inputs disagree. `flags` are State's.
const Awaited* awaited_after(cs8::RejectReason refusal, std::uint32_t flags);

/// A Begin that was taken waits for this.
const Awaited& awaited_confirmation();

/// The touch test by hand, whatever else is missing.
const Awaited& awaited_touch_test();

/// What to do for what the API calls `name`; the name itself when it is none.
std::string_view awaited_words(std::string_view name);

/// It was waited for in vain.
Fault not_ready_fault(const Awaited& awaited);

/// All of a State that a refusal can come from: while it stays, so does the refusal.
struct Readiness {
  std::uint32_t flags = 0;
  cs8::WorkingMode mode{};
  std::int32_t emergency_stop = 0;
  std::int32_t monitor_speed_percent = 0;

  bool operator==(const Readiness&) const = default;
};
Readiness readiness_of(const cs8::State& state);

}  // namespace cell
