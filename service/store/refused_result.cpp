#include "service/store/refused_result.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "service/store/damaged_store.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_insert.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/internal/run_change.hpp"
#include "service/store/internal/touch_change.hpp"
#include "service/store/run_store.hpp"

namespace cell {
namespace {

/// The controller tells an answer again that it was not thanked for: one that was refused, or a touch that
/// counts.
bool is_kept(SQLite::Database& database, std::int64_t run_id, const RefusedResult& refused) {
  if (refused.sequence == 0) return false;
  const std::string same = " WHERE run_id = ?1 AND session = ?2 AND sequence = ?3";
  SQLite::Statement query(database, "SELECT 1 FROM refused_results" + same +
                                        " UNION ALL SELECT 1 FROM touches" + same +
                                        " UNION ALL SELECT 1 FROM superseded_touches" + same);
  query.bind(1, run_id);
  query.bind(2, refused.session);
  query.bind(3, refused.sequence);
  return query.executeStep();
}

bool has_room(SQLite::Database& database, std::int64_t run_id) {
  SQLite::Statement query(database,
                          "SELECT (SELECT count(*) FROM refused_results WHERE run_id = runs.id) < ? FROM "
                          "runs WHERE id = ?");
  query.bind(1, kRefusedKept);
  query.bind(2, run_id);
  return query.executeStep() && query.getColumn(0).getInt() == 1;
}

}  // namespace

bool keep_refused(RunStore& store, std::int64_t run_id, const RefusedResult& refused) {
  SQLite::Database& database = *store.database();
  row::WriteTransaction transaction(database);
  if (is_kept(database, run_id, refused)) return true;
  if (!has_room(database, run_id)) return false;
  row::insert_refused(database, run_id, refused);
  row::note_rows(database, run_id);
  transaction.commit();
  return true;
}

std::optional<std::int64_t> run_of_answer(const RunStore& store, std::uint32_t session,
                                          std::uint32_t sequence) {
  SQLite::Statement query(*store.database(),
                          "SELECT coalesce((SELECT max(run_id) FROM open_commands WHERE session = ? AND "
                          "sequence = ?), (SELECT max(id) FROM runs WHERE " +
                              row::kOfThisDaemon + "))");
  query.bind(1, session);
  query.bind(2, sequence);
  if (!query.executeStep() || query.getColumn(0).isNull()) return std::nullopt;
  return query.getColumn(0).getInt64();
}

std::vector<RefusedResult> refused_results(const RunStore& store, std::int64_t run_id) {
  SQLite::Database& database = *store.database();
  (void)store.run(run_id);  // it has all its rows, or says which it lacks
  SQLite::Statement query(database, "SELECT session, sequence, reason, at, id, " +
                                        row::refused_rows().is_whole() + ", " + row::kJointColumns +
                                        " FROM refused_results WHERE run_id = ? ORDER BY id");
  query.bind(1, run_id);
  std::vector<RefusedResult> found;
  while (query.executeStep()) {
    if (query.getColumn(5).getInt() != 1)
      throw DamagedStore(database.getFilename(),
                         row::place_of("refused_results", run_id, query.getColumn(4).getInt()),
                         row::kOtherChecksum);
    RefusedResult refused{.session = query.getColumn(0).getUInt(),
                          .sequence = query.getColumn(1).getUInt(),
                          .reason = query.getColumn(2).getString(),
                          .at = query.getColumn(3).getString()};
    for (std::size_t i = 0; i < refused.joints.size(); ++i)
      refused.joints[i] = query.getColumn(6 + static_cast<int>(i)).getInt();
    found.push_back(std::move(refused));
  }
  return found;
}

}  // namespace cell
