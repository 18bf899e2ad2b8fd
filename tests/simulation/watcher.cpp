#include "tests/simulation/watcher.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"

namespace simulation {
namespace {

/// Faults and warnings by which the host says that the answer it has just acknowledged is no measurement.
constexpr std::array<std::string_view, 11> kNoMeasurement{
    "early_contact",      "implausible_touch",  "repeated_touch",  "overtravel",
    "touch_spread",       "retries_worse",      "permission_lost", "monitor_speed_changed",
    "touch_does_not_fit", "first_touch_biased", "reference_drift"};

/// "fault NAME: ..." and "warning NAME: ..." of the daemon's log.
bool says_no_measurement(std::string_view line) {
  return std::ranges::any_of(kNoMeasurement, [line](std::string_view name) {
    return line.starts_with(fmt::format("fault {}:", name)) ||
           line.starts_with(fmt::format("warning {}:", name));
  });
}

/// So far apart are the two contacts of a touch that nobody would keep.
bool is_clean(const cs8::TouchResult& result) {
  return result.monitor_speed_percent == 100 && result.edges <= 1 &&
         result.source == cs8::CaptureSource::kLatched;
}

std::string details(const cs8::Payload& payload) {
  if (const auto* touch = std::get_if<cs8::TouchResult>(&payload))
    return fmt::format(" {} {} {}", cs8::name(touch->outcome), cs8::name(touch->phase), touch->contact[0]);
  if (const auto* move = std::get_if<cs8::MoveResult>(&payload))
    return fmt::format(" {}", cs8::name(move->outcome));
  if (const auto* rejected = std::get_if<cs8::Rejected>(&payload))
    return fmt::format(" {}", cs8::name(rejected->reason));
  if (const auto* permit = std::get_if<cs8::Permit>(&payload))
    return fmt::format(" run {} {} {}", permit->run, cs8::name(permit->state), cs8::name(permit->reason));
  if (const auto* acknowledged = std::get_if<cs8::ResultAcknowledge>(&payload))
    return fmt::format(" {}", acknowledged->command_sequence);
  if (const auto* query = std::get_if<cs8::ResultQuery>(&payload))
    return fmt::format(" {}", query->command_sequence);
  if (const auto* welcome = std::get_if<cs8::Welcome>(&payload))
    return fmt::format(" session {}, open {}", welcome->session, welcome->open_sequence);
  return {};
}

}  // namespace

Watcher::Watcher(const VirtualClock& clock, Journal& journal, Record& record)
    : clock_(clock), journal_(journal), record_(record) {}

void Watcher::on_bytes(bool from_host, bool sent, std::span<const std::uint8_t> bytes) {
  if (from_host && sent) sent_.take(bytes);
  if (!from_host && !sent) read_.take(bytes);
  if (!from_host && sent && on_sight) told_.take(bytes);
}

void Watcher::on_connection() {
  journal_.note("network", "a connection");
  sent_.begin_connection();
  read_.begin_connection();
  told_.begin_connection();
  permit_ = {};
  permit_read_at_ = Time{-1};
}

void Watcher::on_connection_end() {
  journal_.note("network", "the connection ends");
  permit_ = {};
  permit_read_at_ = clock_.now();
}

void Watcher::on_sent(const cs8::Message& message) {
  const cs8::MessageType type = cs8::type_of(message);
  if (type == cs8::MessageType::kHeartbeat) return;
  journal_.note("host",
                fmt::format("-> {} {}{}", cs8::name(type), message.sequence, details(message.payload)));
  if (type == cs8::MessageType::kTouch || type == cs8::MessageType::kTravel ||
      type == cs8::MessageType::kRetract) {
    const cell::Status status = operation_->status();
    record_.motions.push_back(
        {clock_.now(), type, message.sequence, status.state, status.run_id, permit_, permit_read_at_});
    if (status.run_id) run_of_[{session_, message.sequence}] = *status.run_id;
    asked_for_.reset();
  }
  tell_sent(message);
  if (const auto* query = std::get_if<cs8::ResultQuery>(&message.payload))
    asked_for_ = CommandNumber{session_, query->command_sequence};
  if (const auto* acknowledged = std::get_if<cs8::ResultAcknowledge>(&message.payload))
    on_acknowledge(acknowledged->command_sequence);
  if (type == cs8::MessageType::kFinish) {
    permit_.state = cs8::PermitState::kNone;
    permit_read_at_ = clock_.now();
  }
}

void Watcher::on_read(const cs8::Message& message) {
  if (const auto* state = std::get_if<cs8::State>(&message.payload)) {
    session_ = state->session;
    if (on_sight) tell_phase(*state);
    return;
  }
  journal_.note("controller", fmt::format("-> {} {}{}", cs8::name(cs8::type_of(message)), message.sequence,
                                          details(message.payload)));
  tell_from_controller("read", message);
  if (const auto* welcome = std::get_if<cs8::Welcome>(&message.payload)) session_ = welcome->session;
  if (const auto* permit = std::get_if<cs8::Permit>(&message.payload)) {
    permit_ = *permit;
    permit_read_at_ = clock_.now();
  }
  if (const auto* result = std::get_if<cs8::TouchResult>(&message.payload))
    record_.answers[{session_, message.sequence}] = *result;
  if (std::holds_alternative<cs8::ResultUnknown>(message.payload))
    unknown_.insert({session_, message.sequence});
}

std::string Watcher::excuse_of(const CommandNumber& command, const cs8::TouchResult& result) const {
  const auto run = run_of_.find(command);
  if (run == run_of_.end()) return "nobody knows of which run it was";
  const cell::ActiveRun* active = operation_->active_run();
  if (active == nullptr || active->run.id() != run->second)
    return "its run was over before this daemon began";
  if (asked_for_ == command && !is_clean(result)) return "it was asked for again, and is no measurement";
  return {};
}

void Watcher::on_acknowledge(std::uint32_t sequence) {
  const CommandNumber command{session_, sequence};
  if (unknown_.contains(command)) return;
  const auto answer = record_.answers.find(command);
  if (answer == record_.answers.end() || answer->second.outcome != cs8::Outcome::kContact) return;
  Acknowledged acknowledged{clock_.now(), command, answer->second, excuse_of(command, answer->second)};
  if (!acknowledged.excuse.empty()) journal_.note("watcher", acknowledged.excuse);
  record_.acknowledged.push_back(std::move(acknowledged));
}

void Watcher::on_log(std::string_view line) {
  journal_.note("daemon", line);
  if (line.starts_with("fault ") || line.starts_with("warning "))
    tell(std::string(line.substr(0, line.find(':'))));
  if (line.starts_with("the answer to an Idempotency-Key could not be stored"))
    record_.said_answer_not_kept = true;
  if (record_.acknowledged.empty() || !says_no_measurement(line)) return;
  Acknowledged& last = record_.acknowledged.back();
  if (last.at == clock_.now() && last.excuse.empty()) last.excuse = line;
}

void Watcher::on_status(const cell::Status& status) {
  if (std::exchange(state_, status.state) == status.state) return;
  journal_.note("daemon", cell::state_name(status.state));
  record_.states.push_back({clock_.now(), status.state, operation_->exits()});
  tell("state " + std::string(cell::state_name(status.state)));
}

// ---- what is seen, in words ----

std::string Watcher::named(std::uint32_t sequence) const {
  const auto name = names_.find({session_, sequence});
  return name == names_.end() ? "" : " of " + name->second;
}

void Watcher::tell_sent(const cs8::Message& message) {
  if (!on_sight) return;
  const cs8::MessageType type = cs8::type_of(message);
  std::string text(cs8::name(type));
  if (type == cs8::MessageType::kTouch) text += fmt::format(" {}", ++touches_sent_);
  if (message.sequence != 0) names_[{session_, message.sequence}] = text;
  if (const auto* acknowledged = std::get_if<cs8::ResultAcknowledge>(&message.payload))
    text += named(acknowledged->command_sequence);
  tell("host: " + text);
}

void Watcher::tell_from_controller(std::string_view who, const cs8::Message& message) {
  if (!on_sight || cs8::type_of(message) == cs8::MessageType::kState) return;
  std::string text(cs8::name(cs8::type_of(message)));
  if (const auto* permit = std::get_if<cs8::Permit>(&message.payload))
    text += fmt::format(" {}", cs8::name(permit->state));
  tell(fmt::format("{}: {}{}", who, text, named(message.sequence)));
}

void Watcher::tell_phase(const cs8::State& state) {
  if (state.active_sequence == 0) return;
  const std::string command = named(state.active_sequence);
  if (std::string phase = fmt::format("phase: {}{}", cs8::name(state.phase), command); phase != phase_)
    tell(phase_ = std::move(phase));
  if (cs8::probe_inputs(state.flags).touched()) tell("contact" + command);
}

void Watcher::note_store(std::string occasion, std::vector<RunRecord> runs) {
  record_.stores.push_back({clock_.now(), std::move(occasion), record_.acknowledged.size(), std::move(runs)});
}

}  // namespace simulation
