#include "service/store/internal/touch_change.hpp"

#include "service/store/damaged_store.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_text.hpp"

namespace cell::row {
namespace {

/// A damaged touch stays where it is: its copy would get a checksum that says it is whole.
void demand_whole_touch(SQLite::Database& database, std::int64_t run_id, int number) {
  SQLite::Statement query(
      database, "SELECT " + touch_rows().is_whole() + " FROM touches WHERE run_id = ? AND number = ?");
  query.bind(1, run_id);
  query.bind(2, number);
  if (!query.executeStep() || query.getColumn(0).getInt() == 1) return;
  throw DamagedStore(database.getFilename(), place_of("touches", run_id, number), kOtherChecksum);
}

}  // namespace

void bind_joints(SQLite::Statement& statement, int& index, const cs8::JointsMicrodeg* joints) {
  for (std::size_t i = 0; i < cs8::JointsMicrodeg().size(); ++i) {
    if (joints) {
      statement.bind(++index, (*joints)[i]);
    } else {
      statement.bind(++index);
    }
  }
}

bool is_there(SQLite::Database& database, std::int64_t run_id, const StoredTouch& touch) {
  SQLite::Statement query(database,
                          "SELECT 1 FROM touches WHERE run_id = ? AND number = ? AND session = ? AND "
                          "sequence = ? AND captured_at = ? AND noise_um IS ? AND again_j1_microdeg IS NULL "
                          "AND (" +
                              kJointColumns + ") = (?, ?, ?, ?, ?, ?)");
  int index = 0;
  query.bind(++index, run_id);
  query.bind(++index, touch.number);
  query.bind(++index, touch.session);
  query.bind(++index, touch.sequence);
  query.bind(++index, touch.captured_at);
  bind_or_null(query, ++index, touch.noise_um);
  bind_joints(query, index, &touch.joints);
  return query.executeStep();
}

bool is_there(SQLite::Database& database, std::int64_t run_id, const ReferenceTouch& touch) {
  SQLite::Statement query(
      database,
      "SELECT 1 FROM reference_touches WHERE run_id = ? AND number = ? AND captured_at = ? "
      "AND (" +
          kJointColumns + ") = (?, ?, ?, ?, ?, ?)");
  int index = 0;
  query.bind(++index, run_id);
  query.bind(++index, touch.number);
  query.bind(++index, touch.captured_at);
  bind_joints(query, index, &touch.joints);
  return query.executeStep();
}

bool has_answer(SQLite::Database& database, std::int64_t run_id, const StoredTouch& touch) {
  if (touch.sequence == 0) return false;
  SQLite::Statement query(
      database, "SELECT 1 FROM touches WHERE run_id = ? AND number = ? AND session = ? AND sequence = ?");
  query.bind(1, run_id);
  query.bind(2, touch.number);
  query.bind(3, touch.session);
  query.bind(4, touch.sequence);
  return query.executeStep();
}

void supersede(SQLite::Database& database, std::int64_t run_id, int number, const std::string& reason) {
  demand_whole_touch(database, run_id, number);
  SQLite::Statement keep(database, "INSERT INTO superseded_touches(run_id, " + kTouchColumns +
                                       ", reason) SELECT run_id, " + kTouchColumns +
                                       ", ? FROM touches WHERE run_id = ? AND number = ?");
  keep.bind(1, reason);
  keep.bind(2, run_id);
  keep.bind(3, number);
  if (keep.exec() != 1) throw SQLite::Exception("there is no such touch to supersede");
  seal(database, superseded_rows(), "id", database.getLastInsertRowid());
  SQLite::Statement remove(database, "DELETE FROM touches WHERE run_id = ? AND number = ?");
  remove.bind(1, run_id);
  remove.bind(2, number);
  remove.exec();
}

void confirm(SQLite::Database& database, std::int64_t run_id, int number, const cs8::JointsMicrodeg& again) {
  demand_whole_touch(database, run_id, number);
  SQLite::Statement update(database, "UPDATE touches SET (" + kAgainJointColumns +
                                         ") = (?, ?, ?, ?, ?, ?) WHERE run_id = ? AND number = ?");
  int index = 0;
  bind_joints(update, index, &again);
  update.bind(++index, run_id);
  update.bind(++index, number);
  if (update.exec() != 1) throw SQLite::Exception("there is no such touch to confirm");
  SQLite::Statement sealed(database, "UPDATE touches SET checksum = " + touch_rows().computed() +
                                         " WHERE run_id = ? AND number = ?");
  sealed.bind(1, run_id);
  sealed.bind(2, number);
  sealed.exec();
}

}  // namespace cell::row
