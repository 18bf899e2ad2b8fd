#include "service/store/answer_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <nlohmann/json.hpp>

namespace cell {

KeyLookUp AnswerStore::take(const KeyedRequest& request, const std::string& oldest) {
  if (in_progress_.contains(request.key)) return KeyInProgress{};
  SQLite::Statement forget(*database_, "DELETE FROM answers WHERE at < ?");
  forget.bind(1, oldest);
  forget.exec();
  SQLite::Statement query(
      *database_, "SELECT request, body_digest, status, headers_json, body FROM answers WHERE key = ?");
  query.bind(1, request.key);
  if (!query.executeStep()) {
    in_progress_.insert(request.key);
    return KeyIsNew{};
  }
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
  SQLite::Statement insert(*database_,
                           "INSERT OR REPLACE INTO answers(key, request, body_digest, status, headers_json, "
                           "body, at) VALUES(?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, request.key);
  insert.bind(2, request.request);
  insert.bind(3, request.body_digest);
  insert.bind(4, answer.status);
  insert.bind(5,
              nlohmann::json(answer.headers).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  insert.bind(6, answer.body.data(), static_cast<int>(answer.body.size()));
  insert.bind(7, now);
  insert.exec();
}

}  // namespace cell
