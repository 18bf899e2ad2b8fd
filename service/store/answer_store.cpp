#include "service/store/answer_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

#include "service/store/damaged_store.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/row_checksum.hpp"
#include "service/store/internal/row_count.hpp"
#include "service/store/internal/row_text.hpp"

namespace cell {

KeyLookUp AnswerStore::take(const KeyedRequest& request, const std::string& oldest) {
  if (in_progress_.contains(request.key)) return KeyInProgress{};
  forget_before(oldest);
  SQLite::Statement query(*database_, "SELECT request, body_digest, status, headers_json, body, " +
                                          row::answer_rows().is_whole() + " FROM answers WHERE key = ?");
  query.bind(1, request.key);
  if (!query.executeStep()) {
    in_progress_.insert(request.key);
    return KeyIsNew{};
  }
  if (query.getColumn(5).getInt() != 1)
    throw DamagedStore(database_->getFilename(), "table answers, number " + request.key, row::kOtherChecksum);
  if (query.getColumn(0).getString() != request.request ||
      query.getColumn(1).getString() != request.body_digest) {
    return KeyReused{};
  }
  StoredAnswer answer{.status = query.getColumn(2).getUInt(), .body = query.getColumn(4).getString()};
  nlohmann::json::parse(query.getColumn(3).getString()).get_to(answer.headers);
  return answer;
}

void AnswerStore::keep(const KeyedRequest& request, const StoredAnswer& answer, const std::string& now) {
  in_progress_.erase(request.key);
  row::WriteTransaction transaction(*database_);
  SQLite::Statement replaced(*database_, "DELETE FROM answers WHERE key = ?");
  replaced.bind(1, request.key);
  const int gone = replaced.exec();
  SQLite::Statement insert(*database_,
                           "INSERT INTO answers(key, request, body_digest, status, headers_json, body, at, "
                           "checksum)" +
                               row::answer_rows().values(7));
  insert.bind(1, request.key);
  insert.bind(2, request.request);
  insert.bind(3, request.body_digest);
  insert.bind(4, answer.status);
  insert.bind(5,
              nlohmann::json(answer.headers).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  insert.bind(6, answer.body.data(), static_cast<int>(answer.body.size()));
  insert.bind(7, now);
  insert.exec();
  row::change_row_count(*database_, row::CountedTable::kAnswers, 1 - gone);
  transaction.commit();
}

/// Whole ones: what was damaged stays to be found. Where none is so old, nothing is written.
void AnswerStore::forget_before(const std::string& oldest) {
  const std::string condition = " FROM answers WHERE at < ? AND " + row::answer_rows().is_whole();
  SQLite::Statement any(*database_, "SELECT 1" + condition + " LIMIT 1");
  any.bind(1, oldest);
  const bool is_any = any.executeStep();
  any.reset();
  if (!is_any) return;
  row::WriteTransaction transaction(*database_);
  SQLite::Statement forget(*database_, "DELETE" + condition);
  forget.bind(1, oldest);
  row::change_row_count(*database_, row::CountedTable::kAnswers, -forget.exec());
  transaction.commit();
}

}  // namespace cell
