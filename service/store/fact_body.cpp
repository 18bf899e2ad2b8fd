// What the facts of the outbox tell. A fact is written with what it tells of, so its keys stand here and not
// in documents/; they are in doc/surfaces.md.
#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

#include "service/base/digest.hpp"
#include "service/base/json_figures.hpp"
#include "service/store/internal/fact.hpp"
#include "service/store/internal/row_text.hpp"

namespace cell::row {
namespace {

/// A column as JSON: a text, a whole number or null.
Json json_of(const SQLite::Column& column) {
  if (column.isNull()) return nullptr;
  return column.isInteger() ? Json(column.getInt64()) : Json(column.getString());
}

/// The digest of a text; null where there is none.
Json digest_of(const SQLite::Column& column) {
  return column.isNull() ? Json(nullptr) : Json(sha256_hex(column.getString()));
}

/// SHA-256 of all that is stored of the touches that count, by number: each column as its length in bytes, a
/// colon and its text, "-" for none.
std::string digest_of_touches(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database,
                          "SELECT " + kTouchColumns + " FROM touches WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::string text;
  while (query.executeStep()) {
    for (int i = 0; i < query.getColumnCount(); ++i) {
      const SQLite::Column column = query.getColumn(i);
      const std::string field = column.isNull() ? std::string() : column.getString();
      text += column.isNull() ? "-" : std::to_string(field.size()) + ":" + field;
    }
  }
  return sha256_hex(text);
}

/// SHA-256 of what an archive keeps of them, a line each by number: number, plane, role, the joints in
/// microdegrees and when it was captured, a space between two.
std::string digest_of_touch_rows(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database,
                          "SELECT number, plane, CASE role WHEN 0 THEN 'fit' WHEN 1 THEN 'held_out' "
                          "ELSE 'proof' END, " +
                              kJointColumns + ", captured_at FROM touches WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::string text;
  while (query.executeStep())
    for (int i = 0; i < query.getColumnCount(); ++i)
      text += query.getColumn(i).getString() + (i + 1 < query.getColumnCount() ? " " : "\n");
  return sha256_hex(text);
}

/// A field of a document that is stored as it is; null where it has none.
Json field_of(const Json& document, const char* key) {
  return document.is_object() && document.contains(key) ? document.at(key) : Json(nullptr);
}

/// A stored document; null where there is none or it cannot be read.
Json document_in(const SQLite::Column& column) {
  return column.isNull() ? Json(nullptr) : Json::parse(column.getString(), nullptr, false);
}

/// What a proof or a check found, of a run that came to its end with this result; of other kinds no fact.
void tell_verification(SQLite::Database& database, std::int64_t run_id, const Json& result) {
  SQLite::Statement query(
      database,
      "SELECT ended_at, kind, of_run, verdict FROM runs WHERE id = ? AND kind IN (?, ?) AND outcome = ?");
  query.bind(1, run_id);
  query.bind(2, std::string(run_kind_name(RunKind::kProof)));
  query.bind(3, std::string(run_kind_name(RunKind::kCheck)));
  query.bind(4, std::string(run_outcome_name(RunOutcome::kComplete)));
  if (!query.executeStep()) return;
  const bool is_proof = query.getColumn(1).getString() == run_kind_name(RunKind::kProof);
  Json body{{"arm", field_of(result, "arm")},
            {"of_run", json_of(query.getColumn(2))},
            {"verdict", json_of(query.getColumn(3))},
            {"rms_mm", field_of(result, "rms_mm")}};
  if (!is_proof)
    for (const char* key : {"cause", "joint", "growth_ppm", "every_days"}) body[key] = field_of(result, key);
  append_fact(database, {is_proof ? FactKind::kProof : FactKind::kCheck, query.getColumn(0).getString(),
                         run_id, text_of(body)});
}

/// When the last touch was captured or the run ended, whichever came later: texts of one form and zone.
constexpr const char* kClosedAt =
    "max(ended_at, coalesce((SELECT max(captured_at) FROM touches WHERE run_id = runs.id), ended_at))";

}  // namespace

void tell_run_started(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database,
                          "SELECT started_at, recipe, operator_name, config_digest, kind, of_run, trace_json "
                          "FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return;
  const Json body{{"recipe", json_of(query.getColumn(1))},
                  {"operator", json_of(query.getColumn(2))},
                  {"config_digest", json_of(query.getColumn(3))},
                  {"kind", json_of(query.getColumn(4))},
                  {"of_run", json_of(query.getColumn(5))},
                  {"touching", field_of(document_in(query.getColumn(6)), "touching")}};
  append_fact(database, {FactKind::kRunStarted, query.getColumn(0).getString(), run_id, text_of(body)});
}

void tell_touch_set(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(
      database, std::string("SELECT ") + kClosedAt +
                    ", (SELECT count(*) FROM touches WHERE run_id = runs.id), result_json, (SELECT document "
                    "FROM arms WHERE run_id = runs.id), (SELECT document FROM plans WHERE id = runs.plan_id) "
                    "FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return;
  const Json body{{"touches", json_of(query.getColumn(1))},
                  {"touches_sha256", digest_of_touches(database, run_id)},
                  {"touch_rows_sha256", digest_of_touch_rows(database, run_id)},
                  {"result_sha256", digest_of(query.getColumn(2))},
                  {"arm_sha256", digest_of(query.getColumn(3))},
                  {"plan_sha256", digest_of(query.getColumn(4))}};
  append_fact(database, {FactKind::kTouchSetClosed, query.getColumn(0).getString(), run_id, text_of(body)});
}

void tell_run_ended(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(
      database,
      "SELECT ended_at, recipe, outcome, verdict, fault_code, fault_message, (SELECT count(*) FROM "
      "touches WHERE run_id = runs.id), touches_total, kind, result_json FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return;
  if (query.getColumn(6).getInt() > 0) tell_touch_set(database, run_id);
  const Json result = document_in(query.getColumn(9));
  const Json body{{"recipe", json_of(query.getColumn(1))},
                  {"outcome", json_of(query.getColumn(2))},
                  {"verdict", json_of(query.getColumn(3))},
                  {"fault_code", json_of(query.getColumn(4))},
                  {"fault_message", json_of(query.getColumn(5))},
                  {"touches_done", json_of(query.getColumn(6))},
                  {"touches_total", json_of(query.getColumn(7))},
                  {"kind", json_of(query.getColumn(8))},
                  {"arm", field_of(result, "arm")}};
  append_fact(database, {FactKind::kRunEnded, query.getColumn(0).getString(), run_id, text_of(body)});
  tell_verification(database, run_id, result);
}

void tell_run_withdrawn(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database, "SELECT started_at, recipe, kind FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return;
  const Json body{{"recipe", json_of(query.getColumn(1))},
                  {"outcome", "withdrawn"},
                  {"verdict", std::string(verdict_name(Verdict::kNone))},
                  {"fault_code", nullptr},
                  {"fault_message", nullptr},
                  {"touches_done", 0},
                  {"touches_total", nullptr},
                  {"kind", json_of(query.getColumn(2))},
                  {"arm", nullptr}};
  append_fact(database, {FactKind::kRunEnded, query.getColumn(0).getString(), run_id, text_of(body)});
}

std::string model_body(const ToldModel& model) {
  const Json document = Json::parse(model.document, nullptr, false);
  Json body{
      {"hash", model.hash},
      {"operator", value_or_null(model.operator_name)},
      {"valid_until", value_or_null(model.valid_until)},
      {"tip_box_max_mm", field_of(field_of(field_of(document, "tip_uncertainty"), "expanded"), "box_max_mm")},
      {"arm", field_of(document, "arm")},
      {"arm_serial", field_of(document, "arm_serial")},
      {"current", model.current}};
  const bool is_approval = model.hash == model.current;
  if (is_approval) body["every_days"] = model.check_every ? Json(model.check_every->count()) : Json(nullptr);
  return text_of(body);
}

std::string application_body(const Approval& application) {
  return text_of({{"hash", application.hash},
                  {"operator", value_or_null(application.operator_name)},
                  {"to", value_or_null(application.applied_to)}});
}

std::string fault_body(const std::string& code, const std::string& message) {
  return text_of({{"code", code}, {"message", message}});
}

std::string certificate_body(const ExpiringCertificate& certificate) {
  return text_of({{"artefact", certificate.artefact}, {"valid_until", certificate.valid_until}});
}

}  // namespace cell::row
