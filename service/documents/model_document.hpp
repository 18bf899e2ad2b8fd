#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell.hpp"
#include "service/documents/carried_json.hpp"
#include "service/documents/tip_document.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// touchcal/model/1: the model of a run as a person approved it; stored with the approval and told as it was
/// stored.
struct ModelDocument {
  std::string schema = "touchcal/model/1";
  std::string hash;  // model_hash()
  std::string run_id;
  std::optional<std::string> approved_by;
  std::string approved_at;                  // RFC 3339
  std::optional<std::string> valid_until;   // RFC 3339; no value: no end was set
  std::optional<std::string> proof_run_id;  // no value: the model is not proved
  std::string arm;
  /// As the cell's file had them when the run began; no value: it had none.
  std::optional<std::string> arm_serial;
  std::optional<std::string> controller_serial;
  std::optional<std::string> config_digest;  // of the cell's files of the run
  std::optional<double> arm_moving_min;      // before the run: how warm the arm was
  std::optional<double> block_temperature_c;
  Carried<TipDocument> tip_uncertainty;  // these three as in the run's result
  CarriedJson parameters;
  CarriedJson nongeometric_parameters;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("hash", self.hash);
    fields("run_id", self.run_id);
    fields("approved_by", self.approved_by);
    fields("approved_at", self.approved_at);
    fields("valid_until", self.valid_until);
    fields("proof_run_id", self.proof_run_id);
    fields("arm", self.arm);
    fields("arm_serial", self.arm_serial);
    fields("controller_serial", self.controller_serial);
    fields("config_digest", self.config_digest);
    fields("arm_moving_min", self.arm_moving_min);
    fields("block_temperature_c", self.block_temperature_c);
    fields("tip_uncertainty", self.tip_uncertainty);
    fields("parameters", self.parameters);
    fields("nongeometric_parameters", self.nongeometric_parameters);
  }
};

/// One approval, rollback or application.
struct ApprovalRow {
  std::string id;
  std::string kind;    // approved, rolled_back, applied
  std::string run_id;  // of the model that it is about
  std::string hash;    // of that model
  std::optional<std::string> by;
  std::string at;  // RFC 3339
  std::optional<std::string> valid_until;
  bool current = false;                   // the approval by which that model is the cell's
  std::optional<std::string> applied_to;  // what uses it; of an application only

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("id", self.id);
    fields("kind", self.kind);
    fields("run_id", self.run_id);
    fields("hash", self.hash);
    fields("by", self.by);
    fields("at", self.at);
    fields("valid_until", self.valid_until);
    fields("current", self.current);
    fields("applied_to", self.applied_to);
  }
};

/// A page of the approvals, newest first.
struct ModelsDocument {
  std::vector<ApprovalRow> models;
  std::optional<std::string> next_before;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("models", self.models);
    fields("next_before", self.next_before);
  }
};

/// What POST runs/{id}/approve, POST models/rollback and POST models/applied take.
struct ApprovalRequest {
  std::optional<std::string> operator_name;
  std::optional<int> valid_days;    // of an approval
  std::optional<std::string> to;    // of an application, which must have it: what uses the model
  std::optional<std::string> hash;  // likewise: of the model; that of the cell's where it is left out

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields.if_set("operator", self.operator_name);
    fields.if_set("valid_days", self.valid_days);
    fields.if_set("to", self.to);
    fields.if_set("hash", self.hash);
  }
};

/// SHA-256, in hexadecimal, of a JSON text without white space and with sorted keys: `arm` (the stored
/// calibrated arm, as a text), `config_digest` (or null), `run_id` (a text), `touches`. Each touch has
/// `again_microdeg`, `aimed_with`, `captured_at`, `first_microdeg`, `first_source`, `joints_microdeg`,
/// `noise_um`, `number`, `overtravel_dmm`, `plane`, `role`, `sequence`, `session`, `source`, as stored; null
/// for what it has not.
std::string model_hash(const StoredRun& run, const std::vector<StoredTouch>& touches,
                       const std::string& arm_json);

/// The model of a run that ended, by what was stored of it; approved_by, approved_at and valid_until are the
/// caller's. DocumentError where `arm_json` or `result_json` cannot be read.
ModelDocument model_of(const StoredRun& run, const std::vector<StoredTouch>& touches,
                       const std::string& arm_json, const std::string& result_json);

/// The name of the arm in a stored arm. DocumentError.
std::string name_of_arm(std::string_view arm_json);

/// Why a model is not of the arm that the cell has now: another name, or another serial number where both are
/// known. Nothing when it is.
std::optional<std::string> why_other_arm(const ModelDocument& model, const Cell& cell);

/// The `limit` newest rows of a history (oldest first) before `before_id`.
ModelsDocument models_page(const std::vector<Approval>& history, std::size_t limit,
                           std::optional<std::int64_t> before_id);

std::string document_text(const ModelDocument& document);
std::string document_text(const ModelsDocument& document);
std::string document_text(const ApprovalRequest& document);

/// DocumentError when the text is no such document.
ModelDocument read_model(std::string_view text);
ModelsDocument read_models(std::string_view text);

}  // namespace cell
