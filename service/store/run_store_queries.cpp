// What a RunStore reads.
#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/internal/row_text.hpp"
#include "service/store/run_store.hpp"

namespace cell {
namespace {

constexpr const char* kRunColumns =
    "SELECT id, recipe, touches_total, started_at, ended_at, outcome, verdict, fault_code, fault_message, "
    "(SELECT count(*) FROM touches WHERE run_id = runs.id), plan_id, operator_name, block_temperature_c, "
    "config_digest, trace_json, std_block_temperature_k, block_temperature_at, block_temperature_source, "
    "stiffness FROM runs ";

std::optional<std::string> text_or_nothing(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getString());
}

std::optional<double> number_or_nothing(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional(column.getDouble());
}

std::optional<StoredTemperature> read_temperature(SQLite::Statement& query) {
  const auto celsius = number_or_nothing(query.getColumn(12));
  if (!celsius) return std::nullopt;
  return StoredTemperature{.celsius = *celsius,
                           .std_k = number_or_nothing(query.getColumn(15)),
                           .measured_at = text_or_nothing(query.getColumn(16)),
                           .source = text_or_nothing(query.getColumn(17))};
}

StoredRun read_run(SQLite::Statement& query) {
  return {.id = query.getColumn(0).getInt64(),
          .recipe = query.getColumn(1).getString(),
          .touches_total = query.getColumn(2).getInt(),
          .touches_done = query.getColumn(9).getInt(),
          .started_at = query.getColumn(3).getString(),
          .ended_at = text_or_nothing(query.getColumn(4)),
          .outcome = row::outcome_named(query.getColumn(5).getString()),
          .verdict = row::verdict_named(query.getColumn(6).getString()),
          .fault_code = text_or_nothing(query.getColumn(7)),
          .fault_message = text_or_nothing(query.getColumn(8)),
          .plan_id = text_or_nothing(query.getColumn(10)),
          .operator_name = text_or_nothing(query.getColumn(11)),
          .block_temperature = read_temperature(query),
          .stiffness = text_or_nothing(query.getColumn(18)),
          .config_digest = text_or_nothing(query.getColumn(13)),
          .conditions_json = text_or_nothing(query.getColumn(14))};
}

std::optional<StoredRun> first_run(SQLite::Statement& query) {
  if (!query.executeStep()) return std::nullopt;
  return read_run(query);
}

cs8::JointsMicrodeg read_joints(SQLite::Statement& query, int first) {
  cs8::JointsMicrodeg joints{};
  for (std::size_t i = 0; i < joints.size(); ++i)
    joints[i] = query.getColumn(first + static_cast<int>(i)).getInt();
  return joints;
}

StoredTouch read_touch(SQLite::Statement& query) {
  return {.number = query.getColumn(0).getInt(),
          .plane = query.getColumn(1).getInt(),
          .role = static_cast<calib::TouchRole>(query.getColumn(2).getInt()),
          .joints = read_joints(query, 3),
          .source = static_cast<cs8::CaptureSource>(query.getColumn(9).getInt()),
          .overtravel_dmm = query.getColumn(10).getInt(),
          .captured_at = query.getColumn(11).getString(),
          .session = query.getColumn(12).getUInt(),
          .sequence = query.getColumn(13).getUInt(),
          .aimed_with = query.getColumn(14).getInt()};
}

}  // namespace

std::vector<StoredRun> RunStore::runs(int limit, std::optional<std::int64_t> before_id) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE id < ? ORDER BY id DESC LIMIT ?");
  query.bind(1, before_id.value_or(INT64_MAX));
  query.bind(2, limit);
  std::vector<StoredRun> found;
  while (query.executeStep()) found.push_back(read_run(query));
  return found;
}

std::optional<StoredRun> RunStore::run(std::int64_t id) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE id = ?");
  query.bind(1, id);
  return first_run(query);
}

std::optional<StoredRun> RunStore::run_with_key(const std::string& idempotency_key) const {
  SQLite::Statement query(*database_, std::string(kRunColumns) + "WHERE idempotency_key = ?");
  query.bind(1, idempotency_key);
  return first_run(query);
}

std::optional<StoredRun> RunStore::last_accepted() const {
  SQLite::Statement query(*database_,
                          std::string(kRunColumns) + "WHERE verdict = ? ORDER BY id DESC LIMIT 1");
  query.bind(1, std::string(verdict_name(Verdict::kAccepted)));
  return first_run(query);
}

std::optional<StoredRun> RunStore::running() const {
  SQLite::Statement query(*database_,
                          std::string(kRunColumns) + "WHERE outcome = ? ORDER BY id DESC LIMIT 1");
  query.bind(1, std::string(run_outcome_name(RunOutcome::kRunning)));
  return first_run(query);
}

std::vector<StoredTouch> RunStore::touches(std::int64_t run_id) const {
  SQLite::Statement query(*database_,
                          "SELECT " + row::kTouchColumns + " FROM touches WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::vector<StoredTouch> found;
  while (query.executeStep()) found.push_back(read_touch(query));
  return found;
}

std::vector<SupersededTouch> RunStore::superseded_touches(std::int64_t run_id) const {
  SQLite::Statement query(*database_, "SELECT " + row::kTouchColumns +
                                          ", reason FROM superseded_touches WHERE run_id = ? ORDER BY id");
  query.bind(1, run_id);
  std::vector<SupersededTouch> found;
  while (query.executeStep()) found.push_back({read_touch(query), query.getColumn(15).getString()});
  return found;
}

std::vector<ReferenceTouch> RunStore::references(std::int64_t run_id) const {
  SQLite::Statement query(*database_, "SELECT number, touches_done, " + row::kJointColumns +
                                          ", drift_mm, captured_at FROM reference_touches "
                                          "WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::vector<ReferenceTouch> found;
  while (query.executeStep()) {
    found.push_back({.number = query.getColumn(0).getInt(),
                     .touches_done = query.getColumn(1).getInt(),
                     .joints = read_joints(query, 2),
                     .drift_mm = number_or_nothing(query.getColumn(8)),
                     .captured_at = query.getColumn(9).getString()});
  }
  return found;
}

std::optional<OpenCommand> RunStore::open_command(std::int64_t run_id) const {
  SQLite::Statement query(
      *database_,
      "SELECT session, sequence, aimed_with, touch_json FROM open_commands AS open WHERE run_id = ? "
      "AND NOT EXISTS(SELECT 1 FROM touches WHERE run_id = open.run_id AND session = open.session AND "
      "sequence = open.sequence) AND NOT EXISTS(SELECT 1 FROM superseded_touches WHERE run_id = open.run_id "
      "AND session = open.session AND sequence = open.sequence)");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  return OpenCommand{.session = query.getColumn(0).getUInt(),
                     .sequence = query.getColumn(1).getUInt(),
                     .aimed_with = query.getColumn(2).getInt(),
                     .touch_json = query.getColumn(3).getString()};
}

std::vector<PlanChange> RunStore::plan_changes(std::int64_t run_id) const {
  SQLite::Statement query(*database_, "SELECT kind, place FROM plan_changes WHERE run_id = ? ORDER BY id");
  query.bind(1, run_id);
  std::vector<PlanChange> found;
  while (query.executeStep())
    found.push_back({row::plan_change_named(query.getColumn(0).getString()), query.getColumn(1).getInt()});
  return found;
}

std::optional<std::string> RunStore::result_json(std::int64_t run_id) const {
  SQLite::Statement query(*database_, "SELECT result_json FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  return text_or_nothing(query.getColumn(0));
}

std::optional<std::string> RunStore::plan_json(std::int64_t run_id) const {
  SQLite::Statement query(
      *database_, "SELECT plans.document FROM runs JOIN plans ON plans.id = runs.plan_id WHERE runs.id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  return text_or_nothing(query.getColumn(0));
}

}  // namespace cell
