#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// What a person's word did to the models of the cell.
enum class ApprovalKind {
  kApproved,    // the model of a run became the cell's
  kRolledBack,  // it was taken back: the one before is the cell's again
  kApplied,     // what it corrects is in use at the robot; the cell's model stays what it is
};

std::string_view approval_kind_name(ApprovalKind kind);  // "rolled_back"

/// A row of the table of models: rows are appended, never changed or deleted.
struct Approval {
  std::int64_t id = 0;  // from 1, without a gap
  ApprovalKind kind = ApprovalKind::kApproved;
  std::int64_t run_id = 0;  // of the model that was approved, taken back or applied
  std::string at;           // RFC 3339
  std::optional<std::string> operator_name;
  std::string hash;                        // of that model: model_hash() in documents/model_document.hpp
  std::optional<std::string> valid_until;  // RFC 3339; nothing: no end was set
  std::optional<std::string> applied_to;   // what uses it, in a person's words; of kApplied only

  bool operator==(const Approval&) const = default;
};

/// The model of a run, to be approved.
struct NewApproval {
  std::int64_t run_id = 0;
  std::string at;
  std::optional<std::string> operator_name;
  std::string hash;
  std::optional<std::string> valid_until;
  std::string document;  // JSON, what is told of the model
  std::string arm_json;  // the calibrated arm as it was stored with the run
  /// How often the cell is to be checked, by its file: the plant is told, the model keeps it not.
  std::optional<std::chrono::days> check_every;
};

/// A person's word that what a model corrects is in use.
struct NewApplication {
  std::int64_t run_id = 0;  // of the model, which was approved once
  std::string hash;         // of it
  std::string to;           // "pick.dtx on the robot"
  std::string at;
  std::optional<std::string> operator_name;
};

/// The approvals behind each other that a rollback takes back one by one: the last is the current model.
/// `history`: all rows, oldest first.
std::vector<Approval> standing_approvals(const std::vector<Approval>& history);

/// The models of the cell. What a call writes is durable on return. Each row has a checksum and the hash of
/// the row before with its own content. Throws what the database throws; DamagedStore for a row that is not
/// as it was written or is gone.
class ModelStore {
 public:
  explicit ModelStore(SharedDatabase database) : database_(std::move(database)) {}

  /// All rows, oldest first, without their documents.
  [[nodiscard]] std::vector<Approval> history() const;
  /// The document and the arm of an approval; nothing for another row.
  [[nodiscard]] std::optional<std::string> document(std::int64_t id) const;
  [[nodiscard]] std::optional<std::string> arm_json(std::int64_t id) const;

  /// Makes the model of a run the current one. Where it is already, nothing is written. Returns the current
  /// approval.
  Approval approve(const NewApproval& model);
  /// Takes the current approval back; returns the one before, which is current then. Throws std::logic_error
  /// where there is none before it: look at history() first, on the same thread.
  Approval roll_back(const std::string& at, const std::optional<std::string>& operator_name);
  /// Notes that a model is in use; returns the row.
  Approval note_applied(const NewApplication& application);

 private:
  SharedDatabase database_;
};

/// Rows that do not follow from the one before, or are gone, a line each. Of a file of kModelSchema or later.
std::vector<std::string> find_model_damage(SQLite::Database& database);

}  // namespace cell
