#include "service/store/model_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <stdexcept>
#include <string_view>

#include "service/base/digest.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/internal/fact.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/internal/touch_change.hpp"

namespace cell {
namespace {

/// Of a row, in the order of approval_in(). The document of a row of kApplied is what uses the model.
constexpr const char* kApprovalColumns =
    "id, kind, run_id, at, operator_name, hash, valid_until, CASE kind WHEN 'applied' THEN document END";
constexpr int kApprovalColumnCount = 8;

std::optional<std::string> text_if_any(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getString());
}

/// Of another text the first: where it matters, the text is compared with that.
ApprovalKind kind_of(const std::string& name) {
  for (const ApprovalKind kind : {ApprovalKind::kRolledBack, ApprovalKind::kApplied})
    if (name == approval_kind_name(kind)) return kind;
  return ApprovalKind::kApproved;
}

Approval approval_in(SQLite::Statement& row) {
  return {.id = row.getColumn(0).getInt64(),
          .kind = kind_of(row.getColumn(1).getString()),
          .run_id = row.getColumn(2).getInt64(),
          .at = row.getColumn(3).getString(),
          .operator_name = text_if_any(row.getColumn(4)),
          .hash = row.getColumn(5).getString(),
          .valid_until = text_if_any(row.getColumn(6)),
          .applied_to = text_if_any(row.getColumn(7))};
}

/// The number of the last row that was ever written.
std::int64_t last_id(SQLite::Database& database) {
  SQLite::Statement query(database,
                          "SELECT coalesce(max(seq), 0) FROM sqlite_sequence WHERE name = 'models'");
  query.executeStep();
  return query.getColumn(0).getInt64();
}

std::string chained_hash(SQLite::Database& database, std::int64_t id) {
  SQLite::Statement query(database, "SELECT chained FROM models WHERE id = ?");
  query.bind(1, id);
  return query.executeStep() ? query.getColumn(0).getString() : std::string();
}

/// SHA-256 of the hash of the row before and then of each field, as its length in bytes, a colon and its
/// text; a field without a value is empty.
std::string chain_on(std::string text, const Approval& row, const std::optional<std::string>& document,
                     const std::optional<std::string>& arm_json) {
  for (const std::string& field :
       {std::to_string(row.id), std::string(approval_kind_name(row.kind)), std::to_string(row.run_id), row.at,
        row.operator_name.value_or(""), row.hash, row.valid_until.value_or(""), document.value_or(""),
        arm_json.value_or("")})
    text += std::to_string(field.size()) + ":" + field;
  return sha256_hex(text);
}

/// `row` gets its number. Inside the caller's transaction.
void append_row(SQLite::Database& database, Approval& row, const std::optional<std::string>& document,
                const std::optional<std::string>& arm_json) {
  const std::int64_t before = last_id(database);
  row.id = before + 1;
  SQLite::Statement insert(database,
                           "INSERT INTO models(id, kind, run_id, at, operator_name, hash, valid_until, "
                           "document, arm, chained, checksum)" +
                               row::model_rows().values(10));
  insert.bind(1, row.id);
  insert.bind(2, std::string(approval_kind_name(row.kind)));
  insert.bind(3, row.run_id);
  insert.bind(4, row.at);
  row::bind_or_null(insert, 5, row.operator_name);
  insert.bind(6, row.hash);
  row::bind_or_null(insert, 7, row.valid_until);
  row::bind_or_null(insert, 8, document);
  row::bind_or_null(insert, 9, arm_json);
  insert.bind(10, chain_on(chained_hash(database, before), row, document, arm_json));
  insert.exec();
}

/// A column of one row, which is as it was written.
std::optional<std::string> text_of_model(SQLite::Database& database, const char* column, std::int64_t id) {
  SQLite::Statement query(database, std::string("SELECT ") + column + ", " + row::model_rows().is_whole() +
                                        ", run_id FROM models WHERE id = ?");
  query.bind(1, id);
  if (!query.executeStep()) return std::nullopt;
  if (query.getColumn(1).getInt() != 1) {
    throw DamagedStore(database.getFilename(),
                       row::place_of("models", query.getColumn(2).getInt64(), static_cast<int>(id)),
                       row::kOtherChecksum);
  }
  return text_if_any(query.getColumn(0));
}

}  // namespace

std::string_view approval_kind_name(ApprovalKind kind) {
  switch (kind) {
    case ApprovalKind::kApproved:
      return "approved";
    case ApprovalKind::kRolledBack:
      return "rolled_back";
    case ApprovalKind::kApplied:
      return "applied";
  }
  return "";
}

std::vector<Approval> standing_approvals(const std::vector<Approval>& history) {
  std::vector<Approval> standing;
  for (const Approval& row : history) {
    if (row.kind == ApprovalKind::kApproved) {
      standing.push_back(row);
    } else if (row.kind == ApprovalKind::kRolledBack && !standing.empty()) {
      standing.pop_back();
    }
  }
  return standing;
}

std::vector<Approval> ModelStore::history() const {
  SQLite::Statement query(*database_, std::string("SELECT ") + kApprovalColumns + ", " +
                                          row::model_rows().is_whole() + " FROM models ORDER BY id");
  std::vector<Approval> rows;
  while (query.executeStep()) {
    rows.push_back(approval_in(query));
    if (query.getColumn(kApprovalColumnCount).getInt() == 1) continue;
    throw DamagedStore(database_->getFilename(),
                       row::place_of("models", rows.back().run_id, static_cast<int>(rows.back().id)),
                       row::kOtherChecksum);
  }
  // Which model is the cell's follows from all rows.
  if (static_cast<std::int64_t>(rows.size()) != last_id(*database_))
    throw DamagedStore(database_->getFilename(), "table models", "approvals that it had are not there");
  return rows;
}

std::optional<std::string> ModelStore::document(std::int64_t id) const {
  return text_of_model(*database_, "CASE kind WHEN 'approved' THEN document END", id);
}

std::optional<std::string> ModelStore::arm_json(std::int64_t id) const {
  return text_of_model(*database_, "arm", id);
}

Approval ModelStore::approve(const NewApproval& model) {
  row::WriteTransaction transaction(*database_);
  const std::vector<Approval> standing = standing_approvals(history());
  if (!standing.empty() && standing.back().hash == model.hash) return standing.back();
  Approval row{.kind = ApprovalKind::kApproved,
               .run_id = model.run_id,
               .at = model.at,
               .operator_name = model.operator_name,
               .hash = model.hash,
               .valid_until = model.valid_until};
  append_row(*database_, row, model.document, model.arm_json);
  row::append_fact(*database_, {FactKind::kApproved, row.at, row.run_id,
                                row::model_body({.hash = row.hash,
                                                 .operator_name = row.operator_name,
                                                 .valid_until = row.valid_until,
                                                 .current = row.hash,
                                                 .document = model.document,
                                                 .check_every = model.check_every})});
  transaction.commit();
  return row;
}

Approval ModelStore::roll_back(const std::string& at, const std::optional<std::string>& operator_name) {
  row::WriteTransaction transaction(*database_);
  const std::vector<Approval> standing = standing_approvals(history());
  if (standing.size() < 2) throw std::logic_error("there is no model before the current one");
  Approval row{.kind = ApprovalKind::kRolledBack,
               .run_id = standing.back().run_id,
               .at = at,
               .operator_name = operator_name,
               .hash = standing.back().hash};
  append_row(*database_, row, {}, {});
  const Approval& now = standing[standing.size() - 2];
  row::append_fact(*database_, {FactKind::kRolledBack, row.at, row.run_id,
                                row::model_body({.hash = row.hash,
                                                 .operator_name = row.operator_name,
                                                 .valid_until = now.valid_until,
                                                 .current = now.hash,
                                                 .document = document(now.id).value_or("")})});
  transaction.commit();
  return now;
}

Approval ModelStore::note_applied(const NewApplication& application) {
  row::WriteTransaction transaction(*database_);
  Approval row{.kind = ApprovalKind::kApplied,
               .run_id = application.run_id,
               .at = application.at,
               .operator_name = application.operator_name,
               .hash = application.hash,
               .applied_to = application.to};
  append_row(*database_, row, application.to, {});
  row::append_fact(*database_, {FactKind::kApplied, row.at, row.run_id, row::application_body(row)});
  transaction.commit();
  return row;
}

std::vector<std::string> find_model_damage(SQLite::Database& database) {
  std::vector<std::string> damage;
  SQLite::Statement query(database, std::string("SELECT ") + kApprovalColumns +
                                        ", document, arm, chained FROM models ORDER BY id");
  std::string before;
  std::int64_t expected = 0;
  bool is_broken = false;
  while (query.executeStep()) {
    const Approval row = approval_in(query);
    const std::string chained = query.getColumn(kApprovalColumnCount + 2).getString();
    const bool follows = row.id == ++expected &&
                         query.getColumn(1).getString() == approval_kind_name(row.kind) &&
                         chained == chain_on(before, row, text_if_any(query.getColumn(kApprovalColumnCount)),
                                             text_if_any(query.getColumn(kApprovalColumnCount + 1)));
    if (!follows && !is_broken)
      damage.push_back("models, row " + std::to_string(row.id) +
                       ": it was changed or put in, or a row before it was taken out");
    is_broken = is_broken || !follows;
    before = chained;
  }
  if (!is_broken && expected != last_id(database))
    damage.push_back("models, row " + std::to_string(expected) + ": rows behind it were taken out");
  return damage;
}

}  // namespace cell
