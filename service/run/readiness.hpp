#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// What a person at the cell must do before the arm may move.
struct AwaitedAction {
  std::string_view name;   // in the API: "touch_test"
  std::string_view words;  // what to do
};

/// What a refused Begin waits for; null if no person at the cell can remove the reason. The touch test comes
/// before other reasons, since it is made in manual mode or with power off, but not while the two inputs of
/// the probe disagree, and not while a face holds the stylus: there the arm is jogged off it. `flags` are
/// those of State.
const AwaitedAction* awaited_after_rejection(cs8::RejectReason refusal, std::uint32_t flags);

/// What a start waits for whose precondition of this name (a code of the fault table) is not met; null if no
/// person at the cell can meet it.
const AwaitedAction* awaited_by_precondition(std::string_view name);

/// What an accepted Begin waits for.
const AwaitedAction& awaited_confirmation();

/// The touch test by hand.
const AwaitedAction& awaited_touch_test();

/// The instruction for an API name; the name itself if it is unknown.
std::string_view awaited_instruction(std::string_view name);

/// The fault when the action was not done in time.
Fault not_ready_fault(const AwaitedAction& awaited);

/// The part of a State that decides about a refusal: while it is unchanged, so is the refusal.
struct Readiness {
  std::uint32_t flags = 0;
  cs8::WorkingMode mode{};
  std::int32_t emergency_stop = 0;
  std::int32_t monitor_speed_percent = 0;

  bool operator==(const Readiness&) const = default;
};
Readiness readiness_of(const cs8::State& state);

}  // namespace cell
