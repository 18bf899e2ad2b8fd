#include "tests/simulation/rest.hpp"

#include <algorithm>
#include <utility>

namespace simulation {
namespace {

using namespace std::chrono_literals;
using cell::State;

/// The link was looked for again and again meanwhile.
constexpr Time kQuietWhereItWaits = 20s;
/// Longer than the confirmation at the cell is waited for, and than a touch may take.
constexpr Time kQuietWhereItActs = 3min;
constexpr Time kRestPatience = 15min;
/// So many messages belong to the step that was struck.
constexpr std::size_t kNextMessages = 2;

bool waits_for_person(State state) {
  return state == State::kIdle || state == State::kComplete || state == State::kHeld ||
         state == State::kSuspended || state == State::kStopped || state == State::kAborted;
}

bool is_message(std::string_view sight) {
  return sight.starts_with("host: ") || sight.starts_with("controller: ");
}

bool is_told(std::string_view sight) {
  return sight.starts_with("fault ") || sight.starts_with("warning ") || sight.starts_with("refused ");
}

std::optional<cell::FaultCode> code_of(const std::optional<cell::Fault>& fault) {
  return fault ? std::optional(fault->code) : std::nullopt;
}

}  // namespace

bool RestWatch::counts_next() const {
  return rest_.struck_at && !is_over_ && rest_.next_messages.size() < kNextMessages;
}

void RestWatch::see(std::string_view sight) {
  if (!rest_.struck_at || is_over_) return;
  if (is_message(sight) && counts_next()) rest_.next_messages.emplace_back(sight);
  if (is_told(sight) && std::ranges::find(rest_.told, sight) == rest_.told.end())
    rest_.told.emplace_back(sight);
}

void RestWatch::on_struck(Time now, const cs8::State& told) {
  rest_.struck_at = quiet_since_ = now;
  joints_ = told.joints;
  rest_.was_commanded = told.active_sequence != 0;
}

void RestWatch::look_at_arm(Time now, const cs8::State& told) {
  if (std::exchange(joints_, told.joints) == told.joints) return;
  quiet_since_ = now;
  if (rest_.struck_at) rest_.last_moved_at = now;
}

void RestWatch::note_view(Time now, const View& view) {
  if (view == view_) return;
  quiet_since_ = now;
  if (view.fault != view_.fault || view.warning != view_.warning) rest_.told_at = now;
  view_ = view;
}

void RestWatch::note_rest(Time now, const cell::CellOperation& operation, const cs8::State& told) {
  is_over_ = true;
  rest_.at = now;
  rest_.state = view_.state;
  rest_.fault = view_.fault;
  rest_.warning = view_.warning;
  rest_.waiting_for = view_.waiting_for;
  rest_.exits = operation.exits();
  rest_.is_clear = (told.flags & cs8::kRetractDue) == 0;
}

void RestWatch::look(Time now, const cell::CellOperation* operation, const cs8::State& told) {
  if (is_over_) return;
  look_at_arm(now, told);
  if (operation == nullptr) {
    quiet_since_ = now;
  } else {
    const cell::Status status = operation->status();
    note_view(now, {.state = status.state,
                    .run = status.run_id,
                    .fault = code_of(status.fault),
                    .warning = code_of(status.warning),
                    .waiting_for = status.waiting_for,
                    .touches_done = status.touches_done});
  }
  const Time needed = waits_for_person(view_.state) ? kQuietWhereItWaits : kQuietWhereItActs;
  if (rest_.struck_at && operation != nullptr && now - quiet_since_ >= needed)
    return note_rest(now, *operation, told);
  is_over_ = now - rest_.struck_at.value_or(Time{0}) > kRestPatience;
}

}  // namespace simulation
