#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "service/acquisition/cell_operation.hpp"
#include "tests/simulation/journal.hpp"
#include "tests/simulation/record.hpp"
#include "tests/simulation/wire.hpp"

namespace simulation {

/// Reads along what host and controller say to each other, and what the host logs and shows; fills the record
/// and the journal. It changes nothing.
class Watcher {
 public:
  Watcher(const VirtualClock& clock, Journal& journal, Record& record);

  /// The present daemon; null while there is none.
  void watch(cell::CellOperation* operation) { operation_ = operation; }
  void on_bytes(bool from_host, bool sent, std::span<const std::uint8_t> bytes);
  void on_connection();
  void on_connection_end();
  void on_log(std::string_view line);
  void on_status(const cell::Status& status);
  void on_disk_sync() { tell("disk: synced"); }
  /// Called with each thing that is seen, where it is set: "state HELD", "host: touch 3" (it left the host;
  /// the touches of a world are counted), "controller: touch_result of touch 3" (it left the controller),
  /// "read: touch_result of touch 3" (the host has it), "phase: search of touch 3", "contact of touch 3",
  /// "disk: synced", "fault link_lost", "warning probe_bounced". It must do nothing to what is watched.
  std::function<void(std::string_view sight)> on_sight;
  /// The power fails on a disk that had told that it does not write: the commands whose answers wait may be
  /// forgotten with it.
  void on_power_failure_of_failed_disk() { run_of_.clear(); }
  void note_store(std::string occasion, std::vector<RunRecord> runs);

 private:
  void on_sent(const cs8::Message& message);
  void on_read(const cs8::Message& message);
  void on_acknowledge(std::uint32_t sequence);
  void tell(const std::string& sight) {
    if (on_sight) on_sight(sight);
  }
  void tell_sent(const cs8::Message& message);
  void tell_from_controller(std::string_view who, const cs8::Message& message);
  void tell_phase(const cs8::State& state);
  [[nodiscard]] std::string named(std::uint32_t sequence) const;
  [[nodiscard]] std::string excuse_of(const CommandNumber& command, const cs8::TouchResult& result) const;

  const VirtualClock& clock_;
  Journal& journal_;
  Record& record_;
  cell::CellOperation* operation_ = nullptr;
  WireReader sent_{[this](const cs8::Message& message) { on_sent(message); }};
  WireReader read_{[this](const cs8::Message& message) { on_read(message); }};
  WireReader told_{[this](const cs8::Message& message) { tell_from_controller("controller", message); }};
  cs8::Permit permit_;
  Time permit_read_at_{-1};
  std::uint32_t session_ = 0;
  std::optional<CommandNumber> asked_for_;  // by a query, the last one
  std::map<CommandNumber, std::int64_t> run_of_;
  /// The controller said that it has no answer of these any more: an acknowledgement takes none away.
  std::set<CommandNumber> unknown_;
  std::optional<cell::State> state_;
  // For on_sight alone.
  int touches_sent_ = 0;
  std::map<CommandNumber, std::string> names_;  // of the motion commands: "touch 3"
  std::string phase_;
};

}  // namespace simulation
