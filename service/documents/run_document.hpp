#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// A run in the list of runs.
struct RunSummary {
  std::string id;
  std::string kind;                   // calibration, proof, check, qualification
  std::optional<std::string> of_run;  // the calibration that is proved or checked
  std::string recipe;
  std::optional<std::string> touch_mode;  // automatic, guided
  RunOutcome outcome = RunOutcome::kRunning;
  Verdict verdict = Verdict::kNone;
  int touches_done = 0;
  std::optional<int> touches_total;  // once it is planned
  std::string started_at;
  std::optional<std::string> ended_at;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("id", self.id);
    fields("kind", self.kind);
    fields("of_run", self.of_run);
    fields("recipe", self.recipe);
    fields("touching", self.touch_mode);
    fields("outcome", self.outcome);
    fields("verdict", self.verdict);
    fields("touches_done", self.touches_done);
    fields("touches_total", self.touches_total);
    fields("started_at", self.started_at);
    fields("ended_at", self.ended_at);
    fields("fault_code", self.fault_code);
    fields("fault_message", self.fault_message);
  }
};

/// Where a run is from that another daemon made.
struct ImportedFrom {
  std::string cell;
  std::string run_id;  // there
  std::string exported_at;
  std::string imported_at;
  std::string sha256;  // of the file

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("cell", self.cell);
    fields("run_id", self.run_id);
    fields("exported_at", self.exported_at);
    fields("imported_at", self.imported_at);
    fields("sha256", self.sha256);
  }
};

/// One run's own document.
struct RunDocument : RunSummary {
  std::optional<CarriedJson> conditions;
  std::optional<ImportedFrom> imported_from;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    RunSummary::visit(self, fields);
    fields("conditions", self.conditions);
    fields("imported_from", self.imported_from);
  }
};

/// A run of which only the number can be told: its row in the database is damaged.
struct DamagedRunDocument {
  std::string id;
  std::string detail;  // file, table, run and remedy

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("id", self.id);
    fields("detail", self.detail);
  }
};

/// A page of the history.
struct RunsDocument {
  std::vector<RunSummary> runs;
  std::vector<DamagedRunDocument> damaged;
  std::optional<std::string> next_before;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("runs", self.runs);
    fields("damaged", self.damaged);
    fields("next_before", self.next_before);
  }
};

/// What POST /runs takes.
struct StartDocument {
  std::optional<double> arm_moving_min;
  std::optional<double> block_temperature_c;
  std::optional<std::string> kind;  // calibration if absent
  std::optional<std::string> of_run;
  std::optional<std::string> operator_name;
  std::optional<std::string> plan_id;
  std::optional<std::string> recipe;
  std::optional<double> std_block_temperature_k;
  std::optional<std::string> stiffness;
  std::optional<std::string> tool;  // of the kind tool
  std::optional<std::string> touch_mode;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields.if_set("arm_moving_min", self.arm_moving_min);
    fields.if_set("block_temperature_c", self.block_temperature_c);
    fields.if_set("kind", self.kind);
    fields.if_set("of_run", self.of_run);
    fields.if_set("operator", self.operator_name);
    fields.if_set("plan_id", self.plan_id);
    fields.if_set("recipe", self.recipe);
    fields.if_set("std_block_temperature_k", self.std_block_temperature_k);
    fields.if_set("stiffness", self.stiffness);
    fields.if_set("tool", self.tool);
    fields.if_set("touching", self.touch_mode);
  }
};

std::string document_text(const RunDocument& document);
std::string document_text(const RunsDocument& document);
std::string document_text(const StartDocument& document);

/// DocumentError when the text is no such document.
RunDocument read_run(std::string_view text);
RunsDocument read_runs(std::string_view text);

}  // namespace cell
