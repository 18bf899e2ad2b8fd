#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"

namespace cell {

/// A cell as the archive knows it. No value: the archive has none.
struct FleetCell {
  std::string cell;
  std::string last_event_at;         // RFC 3339, as all times
  std::string heard_at;              // of that event, when the archive got it, by the archive's clock
  std::optional<std::string> state;  // running: a run was started and has not ended; idle
  std::optional<std::string> arm;    // the type of its arm, as it said last, with its number
  std::optional<std::string> arm_serial;
  std::optional<std::string> last_run_id;  // of the last calibration that ended, with the next four
  std::optional<std::string> recipe;
  std::optional<std::string> outcome;
  std::optional<std::string> verdict;
  std::optional<std::string> ended_at;
  std::optional<std::string> model;        // the hash of the one that is the cell's
  std::optional<std::string> approved_at;  // when it was approved, or came back
  std::optional<std::string> valid_until;
  bool model_over = false;                   // its time, by the archive's clock
  std::optional<double> tip_box_max_mm;      // expanded uncertainty at the worst in the workspace box
  std::optional<std::string> applied_model;  // the hash of the one that is in use, as a person said last
  std::optional<std::string> applied_at;
  std::optional<std::string> applied_to;  // what uses it
  std::optional<std::string> last_proof_at;
  std::optional<std::string> last_proof_verdict;
  std::optional<std::string> last_check_at;
  std::optional<std::string> last_check_verdict;
  std::optional<std::string> last_check_cause;      // of an alarm
  std::optional<std::string> check_due_at;          // the next one
  bool check_overdue = false;                       // by the archive's clock
  std::optional<std::string> certificate_artefact;  // of the first that ends soon: block, probe
  std::optional<std::string> certificate_valid_until;
  bool certificate_over = false;  // it has ended, by the archive's clock
  std::optional<std::string> last_fault_code;
  std::optional<std::string> last_fault_at;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("cell", self.cell);
    fields("last_event_at", self.last_event_at);
    fields("heard_at", self.heard_at);
    fields("state", self.state);
    fields("arm", self.arm);
    fields("arm_serial", self.arm_serial);
    fields("last_run_id", self.last_run_id);
    fields("recipe", self.recipe);
    fields("outcome", self.outcome);
    fields("verdict", self.verdict);
    fields("ended_at", self.ended_at);
    fields("model", self.model);
    fields("approved_at", self.approved_at);
    fields("valid_until", self.valid_until);
    fields("model_over", self.model_over);
    fields("tip_box_max_mm", self.tip_box_max_mm);
    fields("applied_model", self.applied_model);
    fields("applied_at", self.applied_at);
    fields("applied_to", self.applied_to);
    fields("last_proof_at", self.last_proof_at);
    fields("last_proof_verdict", self.last_proof_verdict);
    fields("last_check_at", self.last_check_at);
    fields("last_check_verdict", self.last_check_verdict);
    fields("last_check_cause", self.last_check_cause);
    fields("check_due_at", self.check_due_at);
    fields("check_overdue", self.check_overdue);
    fields("certificate_artefact", self.certificate_artefact);
    fields("certificate_valid_until", self.certificate_valid_until);
    fields("certificate_over", self.certificate_over);
    fields("last_fault_code", self.last_fault_code);
    fields("last_fault_at", self.last_fault_at);
  }
};

/// touchcal/fleet/1: all cells of an archive, by name.
struct FleetDocument {
  std::string schema = "touchcal/fleet/1";
  std::vector<FleetCell> cells;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("cells", self.cells);
  }
};

/// What the cells with arms of one type told in one month. A figure without a value: none of them told it.
struct FleetTrend {
  std::optional<std::string> arm;        // the type; none: of cells that never said theirs
  std::string month;                     // "2026-11", UTC, by the clock of each cell
  std::int64_t cells = 0;                // that told any of this
  std::int64_t calibrations = 0;         // that came to their end, with or without a verdict
  std::int64_t rejected = 0;             // of them
  std::int64_t approved = 0;             // models
  std::optional<double> tip_box_max_mm;  // median of those models
  std::int64_t checks = 0;
  std::int64_t alarms = 0;           // of them
  std::optional<double> growth_ppm;  // median of the checks
  std::int64_t proofs = 0;
  std::int64_t failed_proofs = 0;  // of them
  std::int64_t faults = 0;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("arm", self.arm);
    fields("month", self.month);
    fields("cells", self.cells);
    fields("calibrations", self.calibrations);
    fields("rejected", self.rejected);
    fields("approved", self.approved);
    fields("tip_box_max_mm", self.tip_box_max_mm);
    fields("checks", self.checks);
    fields("alarms", self.alarms);
    fields("growth_ppm", self.growth_ppm);
    fields("proofs", self.proofs);
    fields("failed_proofs", self.failed_proofs);
    fields("faults", self.faults);
  }
};

/// touchcal/fleet-trends/1: all cells of an archive by the type of their arm and by month, the newest month
/// first.
struct FleetTrendsDocument {
  std::string schema = "touchcal/fleet-trends/1";
  std::vector<FleetTrend> trends;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("trends", self.trends);
  }
};

/// A fact of a cell as it told it.
struct ArchivedFact {
  std::int64_t seq = 0;
  std::string
      kind;  // run_started, touch_set_closed, run_ended, proof, check, approved, rolled_back, fault, ...
  std::string at;  // RFC 3339
  std::optional<std::string> run_id;
  CarriedJson body;  // by the kind (surfaces.md, section 9)

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("seq", self.seq);
    fields("kind", self.kind);
    fields("at", self.at);
    fields("run_id", self.run_id);
    fields("body", self.body);
  }
};

/// touchcal/history/1: what one cell told the archive, newest first.
struct HistoryDocument {
  std::string schema = "touchcal/history/1";
  std::string cell;
  std::vector<ArchivedFact> facts;
  std::optional<std::int64_t> next_before;  // from where older ones go on; nothing: there are none

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("cell", self.cell);
    fields("facts", self.facts);
    fields("next_before", self.next_before);
  }
};

/// The events of one cell in an archive: each has the hash of the one before, so that the last stands for
/// all.
struct ArchivedChain {
  std::string cell;
  std::int64_t first = 0;  // more than 1: those before were never archived, or are gone
  std::int64_t last = 0;
  std::string last_sha256;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("cell", self.cell);
    fields("first", self.first);
    fields("last", self.last);
    fields("last_sha256", self.last_sha256);
  }
};

/// touchcal/archive/1: what is wrong with an archive, and how much was looked at.
struct ArchiveDocument {
  std::string schema = "touchcal/archive/1";
  std::int64_t events = 0;
  std::int64_t cells = 0;
  std::vector<ArchivedChain> chains;  // of each cell
  std::vector<std::string> damage;    // a line each

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("events", self.events);
    fields("cells", self.cells);
    fields("chains", self.chains);
    fields("damage", self.damage);
  }
};

/// Of the body of a touch_set_closed: what goes with it. Daemons of earlier versions did not tell all of it.
struct ClosedTouchSet {
  std::optional<std::int64_t> touches;
  std::optional<std::string> touch_rows_sha256;
  std::optional<std::string> result_sha256;
  std::optional<std::string> arm_sha256;
  std::optional<std::string> plan_sha256;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("touches", self.touches);
    fields("touch_rows_sha256", self.touch_rows_sha256);
    fields("result_sha256", self.result_sha256);
    fields("arm_sha256", self.arm_sha256);
    fields("plan_sha256", self.plan_sha256);
  }
};

std::string document_text(const FleetDocument& document);
std::string document_text(const FleetTrendsDocument& document);
std::string document_text(const HistoryDocument& document);
std::string document_text(const ArchiveDocument& document);

/// What a verification found, as document_text() wrote it. DocumentError where it is none.
ArchiveDocument archive_document_from(std::string_view text);
/// DocumentError where it is none.
ClosedTouchSet closed_touch_set_from(std::string_view text);

}  // namespace cell
