// What a RunStore reads.
#include <SQLiteCpp/SQLiteCpp.h>
#include <spdlog/spdlog.h>

#include "service/store/damaged_store.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_damage.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/run_page.hpp"
#include "service/store/run_store.hpp"

namespace cell {

using row::demand_none_damaged, row::demand_rows, row::demand_whole, row::json_text, row::rethrow;

namespace {

/// From 21 on: the row is whole; the rows that belong to it are there; where it is from; that this is whole.
const std::string& run_columns() {
  static const std::string columns =
      "SELECT id, recipe, touches_total, started_at, ended_at, outcome, verdict, fault_code, fault_message, "
      "(SELECT count(*) FROM touches WHERE run_id = runs.id), plan_id, operator_name, block_temperature_c, "
      "config_digest, trace_json, std_block_temperature_k, block_temperature_at, block_temperature_source, "
      "stiffness, kind, of_run, " +
      row::run_rows().is_whole() + ", " + row::has_its_rows() +
      ", cell, origin_run, exported_at, imported_at, sha256, " + row::import_rows().is_whole() +
      " FROM runs LEFT JOIN imported_runs ON imported_runs.run_id = runs.id ";
  return columns;
}

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

std::optional<RunOrigin> read_origin(const SQLite::Database& database, SQLite::Statement& query,
                                     std::int64_t run_id) {
  if (query.getColumn(23).isNull()) return std::nullopt;
  demand_whole(database, query, 28, "imported_runs", run_id);
  return RunOrigin{query.getColumn(23).getString(), query.getColumn(24).getInt64(),
                   query.getColumn(25).getString(), query.getColumn(26).getString(),
                   query.getColumn(27).getString()};
}

StoredRun read_run(const SQLite::Database& database, SQLite::Statement& query) {
  const std::int64_t id = query.getColumn(0).getInt64();
  demand_whole(database, query, 21, "runs", id);
  if (query.getColumn(22).getInt() != 1) demand_rows(database, id);
  std::optional<std::string> conditions;
  if (!query.getColumn(14).isNull())
    conditions = json_text(database, query, 14, "runs", id, "its conditions");
  return {
      .id = id,
      .kind = row::kind_named(query.getColumn(19).getString()),
      .of_run = query.getColumn(20).isNull() ? std::nullopt : std::optional(query.getColumn(20).getInt64()),
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
      .conditions_json = std::move(conditions),
      .origin = read_origin(database, query, id)};
}

std::optional<StoredRun> first_run(const SQLite::Database& database, SQLite::Statement& query) {
  if (!query.executeStep()) return std::nullopt;
  return read_run(database, query);
}

/// True for the number of a run that was stored once.
bool was_given(const SQLite::Database& database, std::int64_t id) {
  SQLite::Statement given(database, "SELECT 1 FROM sqlite_sequence WHERE name = 'runs' AND seq >= ?");
  given.bind(1, id);
  return id > 0 && given.executeStep();
}

cs8::JointsMicrodeg read_joints(SQLite::Statement& query, int first) {
  cs8::JointsMicrodeg joints{};
  for (std::size_t i = 0; i < joints.size(); ++i)
    joints[i] = query.getColumn(first + static_cast<int>(i)).getInt();
  return joints;
}

std::optional<FirstContact> read_first_contact(SQLite::Statement& query) {
  if (query.getColumn(16).isNull()) return std::nullopt;
  return FirstContact{static_cast<cs8::CaptureSource>(query.getColumn(16).getInt()), read_joints(query, 17)};
}

std::optional<cs8::JointsMicrodeg> read_repetition(SQLite::Statement& query) {
  if (query.getColumn(23).isNull()) return std::nullopt;
  return read_joints(query, 23);
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
          .aimed_with = query.getColumn(14).getInt(),
          .noise_um = number_or_nothing(query.getColumn(15)),
          .first = read_first_contact(query),
          .again = read_repetition(query)};
}

}  // namespace

std::vector<StoredRun> RunStore::runs(int limit, std::optional<std::int64_t> before_id) const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE id < ? ORDER BY id DESC LIMIT ?");
  query.bind(1, before_id.value_or(INT64_MAX));
  query.bind(2, limit);
  std::vector<StoredRun> found;
  while (query.executeStep()) found.push_back(read_run(*database_, query));
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

RunPage run_page(const RunStore& store, int limit, std::optional<std::int64_t> before_id) {
  const auto& database = store.database();
  try {
    SQLite::Statement query(*database, run_columns() + "WHERE id < ? ORDER BY id DESC LIMIT ?");
    query.bind(1, before_id.value_or(INT64_MAX));
    query.bind(2, limit + 1);
    RunPage page;
    std::int64_t last_id = 0;
    for (int count = 0; query.executeStep(); ++count) {
      if (count == limit) {
        page.next_before = last_id;
        break;
      }
      last_id = query.getColumn(0).getInt64();
      try {
        page.runs.push_back(read_run(*database, query));
      } catch (const DamagedStore& damage) {
        page.damaged.push_back({last_id, damage.what()});
      }
    }
    return page;
  } catch (const SQLite::Exception& error) {
    rethrow(*database, error);
  }
}

std::optional<StoredRun> RunStore::run(std::int64_t id) const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE id = ?");
  query.bind(1, id);
  auto found = first_run(*database_, query);
  if (!found && was_given(*database_, id)) demand_none_damaged(*database_, row::run_rows());
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<StoredRun> RunStore::run_with_key(const std::string& idempotency_key) const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE idempotency_key = ?");
  query.bind(1, idempotency_key);
  return first_run(*database_, query);
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<StoredRun> RunStore::last_accepted() const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE verdict = ? AND kind = ? AND " +
                                          row::kOfThisDaemon + " ORDER BY id DESC LIMIT 1");
  query.bind(1, std::string(verdict_name(Verdict::kAccepted)));
  query.bind(2, std::string(run_kind_name(RunKind::kCalibration)));
  auto found = first_run(*database_, query);
  demand_none_damaged(*database_, row::run_rows(), found ? found->id : 0);
  return found;
} catch (const std::runtime_error& error) {
  spdlog::error("which run was accepted last cannot be told: {}", error.what());
  return std::nullopt;
}

std::optional<StoredRun> RunStore::last_complete(RunKind kind) const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE outcome = ? AND kind = ? AND " +
                                          row::kOfThisDaemon + " ORDER BY id DESC LIMIT 1");
  query.bind(1, std::string(run_outcome_name(RunOutcome::kComplete)));
  query.bind(2, std::string(run_kind_name(kind)));
  return first_run(*database_, query);
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::vector<StoredRun> RunStore::complete_runs_of(std::int64_t calibration, RunKind kind) const try {
  SQLite::Statement query(
      *database_, run_columns() + "WHERE of_run = ? AND kind = ? AND outcome = ? ORDER BY ended_at, id");
  query.bind(1, calibration);
  query.bind(2, std::string(run_kind_name(kind)));
  query.bind(3, std::string(run_outcome_name(RunOutcome::kComplete)));
  std::vector<StoredRun> found;
  while (query.executeStep()) found.push_back(read_run(*database_, query));
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<StoredRun> RunStore::running() const try {
  SQLite::Statement query(*database_, run_columns() + "WHERE outcome = ? ORDER BY id DESC LIMIT 1");
  query.bind(1, std::string(run_outcome_name(RunOutcome::kRunning)));
  auto found = first_run(*database_, query);
  if (!found) demand_none_damaged(*database_, row::run_rows());
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::vector<StoredTouch> RunStore::touches(std::int64_t run_id) const try {
  demand_rows(*database_, run_id);
  SQLite::Statement query(*database_, "SELECT " + row::kTouchColumns + ", " + row::touch_rows().is_whole() +
                                          " FROM touches WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::vector<StoredTouch> found;
  while (query.executeStep()) {
    demand_whole(*database_, query, row::kTouchColumnCount, "touches", run_id, 0);
    found.push_back(read_touch(query));
  }
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::vector<SupersededTouch> RunStore::superseded_touches(std::int64_t run_id) const try {
  demand_rows(*database_, run_id);
  SQLite::Statement query(*database_, "SELECT " + row::kTouchColumns + ", reason, " +
                                          row::superseded_rows().is_whole() +
                                          " FROM superseded_touches WHERE run_id = ? ORDER BY id");
  query.bind(1, run_id);
  std::vector<SupersededTouch> found;
  while (query.executeStep()) {
    demand_whole(*database_, query, row::kTouchColumnCount + 1, "superseded_touches", run_id, 0);
    found.push_back({read_touch(query), query.getColumn(row::kTouchColumnCount).getString()});
  }
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::vector<ReferenceTouch> RunStore::references(std::int64_t run_id) const try {
  demand_rows(*database_, run_id);
  SQLite::Statement query(*database_, "SELECT number, touches_done, " + row::kJointColumns +
                                          ", drift_mm, captured_at, " + row::reference_rows().is_whole() +
                                          " FROM reference_touches WHERE run_id = ? ORDER BY number");
  query.bind(1, run_id);
  std::vector<ReferenceTouch> found;
  while (query.executeStep()) {
    demand_whole(*database_, query, 10, "reference_touches", run_id, 0);
    found.push_back({.number = query.getColumn(0).getInt(),
                     .touches_done = query.getColumn(1).getInt(),
                     .joints = read_joints(query, 2),
                     .drift_mm = number_or_nothing(query.getColumn(8)),
                     .captured_at = query.getColumn(9).getString()});
  }
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<OpenCommand> RunStore::open_command(std::int64_t run_id) const try {
  // A damaged touch may be the answer.
  (void)touches(run_id);
  (void)superseded_touches(run_id);
  SQLite::Statement query(
      *database_,
      "SELECT session, sequence, aimed_with, touch_json, " + row::open_command_rows().is_whole() +
          " FROM open_commands AS open WHERE run_id = ? "
          "AND NOT EXISTS(SELECT 1 FROM touches WHERE run_id = open.run_id AND session = open.session AND "
          "sequence = open.sequence) AND NOT EXISTS(SELECT 1 FROM superseded_touches WHERE run_id = "
          "open.run_id AND session = open.session AND sequence = open.sequence)");
  query.bind(1, run_id);
  if (!query.executeStep()) {
    demand_none_damaged(*database_, row::open_command_rows());
    return std::nullopt;
  }
  demand_whole(*database_, query, 4, "open_commands", run_id);
  return OpenCommand{
      .session = query.getColumn(0).getUInt(),
      .sequence = query.getColumn(1).getUInt(),
      .aimed_with = query.getColumn(2).getInt(),
      .touch_json = json_text(*database_, query, 3, "open_commands", run_id, "the commanded touch")};
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::vector<PlanChange> RunStore::plan_changes(std::int64_t run_id) const try {
  demand_rows(*database_, run_id);
  SQLite::Statement query(*database_, "SELECT kind, place, " + row::plan_change_rows().is_whole() +
                                          ", id FROM plan_changes WHERE run_id = ? ORDER BY id");
  query.bind(1, run_id);
  std::vector<PlanChange> found;
  while (query.executeStep()) {
    demand_whole(*database_, query, 2, "plan_changes", run_id, 3);
    found.push_back({row::plan_change_named(query.getColumn(0).getString()), query.getColumn(1).getInt()});
  }
  return found;
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<std::string> RunStore::result_json(std::int64_t run_id) const try {
  SQLite::Statement query(*database_,
                          "SELECT result_json, " + row::result_rows().is_whole() + " FROM runs WHERE id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  demand_whole(*database_, query, 1, "runs", run_id);
  if (query.getColumn(0).isNull()) return std::nullopt;
  return json_text(*database_, query, 0, "runs", run_id, "its result");
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<std::string> RunStore::arm_json(std::int64_t run_id) const try {
  demand_rows(*database_, run_id);
  SQLite::Statement query(*database_,
                          "SELECT document, " + row::arm_rows().is_whole() + " FROM arms WHERE run_id = ?");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  demand_whole(*database_, query, 1, "arms", run_id);
  return json_text(*database_, query, 0, "arms", run_id, "the arm");
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

std::optional<std::string> RunStore::plan_json(std::int64_t run_id) const try {
  SQLite::Statement query(*database_, "SELECT plans.document, " + row::plan_rows().is_whole() +
                                          " FROM runs LEFT JOIN plans ON plans.id = runs.plan_id WHERE "
                                          "runs.id = ? AND runs.plan_id IS NOT NULL");
  query.bind(1, run_id);
  if (!query.executeStep()) return std::nullopt;
  if (query.getColumn(0).isNull())
    throw DamagedStore(database_->getFilename(), row::place_of("runs", run_id), "its plan is not there");
  demand_whole(*database_, query, 1, "plans", run_id);
  return json_text(*database_, query, 0, "plans", run_id, "the plan");
} catch (const SQLite::Exception& error) {
  rethrow(*database_, error);
}

}  // namespace cell
