#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"
#include "service/run/packml_state.hpp"
#include "service/store/refused_result.hpp"
#include "service/store/run_store.hpp"
#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// A motion command in the moment in which it left the host, with what the host was and knew then.
struct MotionSent {
  Time at{};
  cs8::MessageType type{};
  std::uint32_t sequence = 0;
  cell::State state{};
  std::optional<std::int64_t> run;
  cs8::Permit permit;       // the last that the host had read on this connection
  Time permit_read_at{-1};  // before the world began: none
};

/// A command of the controller's application: its session and its number there.
struct CommandNumber {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  auto operator<=>(const CommandNumber&) const = default;
};

/// An answer that the host acknowledged: from then on the controller has it no more.
struct Acknowledged {
  Time at{};
  CommandNumber command;
  cs8::TouchResult result;
  /// Why the host may have kept no touch of it: a word of its own about that command. Empty: it must be
  /// stored.
  std::string excuse;
};

/// What the store has of a run.
struct RunRecord {
  cell::StoredRun run;
  std::vector<cell::StoredTouch> touches;
  std::vector<cell::SupersededTouch> superseded;
  std::optional<std::string> result_json;
  /// The document that the same touches give in one piece, when nothing ever failed.
  std::optional<std::string> undisturbed_json;
  std::vector<std::string> reasons;  // of a complete run that is not accepted
  std::vector<cell::RefusedResult> refused = {};
};

/// What the store had at some time, and how many answers had been acknowledged by then.
struct StoreRecord {
  Time at{};
  std::string occasion;  // "killed", "the end"
  std::size_t acknowledged_count = 0;
  std::vector<RunRecord> runs;
};

struct StateRecord {
  Time at{};
  cell::State state{};
  std::vector<cell::Command> exits;
};

/// How a cell stands behind what went wrong at one step (Scenario::script), before any person has come.
struct RestRecord {
  std::optional<Time> struck_at;  // the step was reached
  std::optional<Time> at;         // it came to rest: what follows holds
  cell::State state{};
  std::optional<cell::FaultCode> fault, warning;  // shown there
  std::optional<std::string> waiting_for;
  std::vector<cell::Command> exits;
  bool is_clear = false;  // no way back from a face is due
  // From the step to the rest.
  std::vector<std::string> told;  // "fault link_lost", "warning probe_bounced", "refused run_active"
  Time told_at{};                 // what is shown at rest
  std::optional<Time> last_moved_at;
  bool was_commanded = false;              // a motion command was with the controller then
  std::vector<std::string> next_messages;  // on the wire: "host: touch 3"
  int next_writes = 0;                     // of the disk, before those had passed
};

/// What came of a request at the daemon's HTTP port.
struct HttpAnswer {
  enum class End { kAnswered, kClosed, kOpen };  // kOpen: the world ended before
  Time asked_at{}, at{};
  std::string request;  // "POST /api/v1/runs"
  std::string key;
  End end{};
  int status = 0;    // 0: none
  std::string body;  // as far as it came
};

/// All that the invariants of a world are judged by.
struct Record {
  int touches_planned = 0;  // of each run
  std::vector<MotionSent> motions;
  std::map<CommandNumber, cs8::TouchResult> answers;  // as the controller gave them
  std::vector<Acknowledged> acknowledged;
  std::vector<StoreRecord> stores;  // in time; the last one is the end's
  std::vector<StateRecord> states;
  std::vector<HttpAnswer> http_answers;
  RestRecord rest;
  std::vector<cell::Command> person_did;  // behind the rest
  bool said_answer_not_kept = false;      // to a key: the host could not write it
  bool came_to_end = false;               // within the time that a person would wait
  /// What nobody caught: it would have ended the process of a daemon or of the controller.
  std::optional<std::string> thrown;
};

}  // namespace simulation
