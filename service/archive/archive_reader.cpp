#include "service/archive/archive_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>
#include <pqxx/pqxx>

#include "service/archive/internal/archive_reading.hpp"
#include "service/documents/archived_runs.hpp"
#include "service/store/outbox.hpp"

namespace cell {
namespace {

Fact archived_fact(const pqxx::row& row) {
  Fact fact{.seq = row["seq"].as<std::int64_t>(),
            .instance = row["instance"].as<std::int64_t>(),
            .kind = row["kind"].as<std::string>(),
            .at = row["at"].as<std::string>(),
            .run_id = std::nullopt,
            .previous = row["previous"].as<std::string>(),
            .body = row["body"].as<std::string>(),
            .sha256 = row["sha256"].as<std::string>()};
  if (!row["run"].is_null()) fact.run_id = row["run"].as<std::int64_t>();
  return fact;
}

/// The events of a cell, so many at a time: ten years of them need no more memory than that.
constexpr int kEventsAtOnce = 10'000;

void look_at_cell(pqxx::transaction_base& transaction, const std::string& cell, ArchiveDocument& look) {
  std::optional<Fact> before;
  for (bool is_over = false; !is_over;) {
    const pqxx::result rows = transaction.exec_params(
        "SELECT seq, instance, kind, at, run, previous, body, sha256 FROM event WHERE cell = $1 AND seq > $2 "
        "ORDER BY seq LIMIT $3",
        cell, before ? before->seq : 0, kEventsAtOnce);
    is_over = rows.empty();
    for (const pqxx::row& row : rows) {
      Fact fact = archived_fact(row);
      ++look.events;
      if (fact.sha256 != fact_digest(fact))
        look.damage.push_back(fmt::format("cell {}, event {}: it was changed", cell, fact.seq));
      if (before && fact.seq != before->seq + 1)
        look.damage.push_back(
            fmt::format("cell {}: events {} to {} are missing", cell, before->seq + 1, fact.seq - 1));
      else if (before && fact.previous != before->sha256)
        look.damage.push_back(
            fmt::format("cell {}, event {}: the event before is another one", cell, fact.seq));
      before = std::move(fact);
    }
  }
}

constexpr const char* kMissingDocuments = R"sql(
SELECT cell, seq, name FROM event, LATERAL (VALUES ('result_sha256'), ('arm_sha256')) AS names(name)
WHERE kind = 'touch_set_closed' AND body::json ->> name IS NOT NULL
  AND body::json ->> name NOT IN (SELECT sha256 FROM document)
  -- A later set of the same run took its place before it was archived.
  AND NOT EXISTS (SELECT FROM event AS later WHERE later.cell = event.cell AND later.run = event.run
                  AND later.kind = 'touch_set_closed' AND later.seq > event.seq)
ORDER BY cell, seq, name)sql";

ArchivedFact told_fact(const pqxx::row& row) {
  return {.seq = row["seq"].as<std::int64_t>(),
          .kind = row["kind"].as<std::string>(),
          .at = row["at"].as<std::string>(),
          .run_id = text_or_none(row["run"]),
          .body = {row["body"].as<std::string>()}};
}

/// Of the runs that a cell began before another, the newest, and from which fact on they are told.
constexpr const char* kNewestRuns = R"sql(
SELECT run, seq FROM event WHERE cell = $1 AND kind = 'run_started' AND run < $2 ORDER BY seq DESC LIMIT $3)sql";
constexpr const char* kFactsOfRuns = R"sql(
SELECT seq, kind, at, run, body FROM event WHERE cell = $1 AND seq >= $2 AND run = ANY($3::bigint[]) ORDER BY seq)sql";

}  // namespace

ArchiveDocument look_at_archive(const std::string& url) {
  return reading(url, {}, [](pqxx::transaction_base& transaction) {
    ArchiveDocument look;
    for (const pqxx::row& row : transaction.exec("SELECT DISTINCT cell FROM event ORDER BY cell")) {
      ++look.cells;
      look_at_cell(transaction, row[0].as<std::string>(), look);
    }
    for (const pqxx::row& row : transaction.exec(kMissingDocuments))
      look.damage.push_back(fmt::format("cell {}, event {}: the document of its {} is not there",
                                        row[0].as<std::string>(), row[1].as<std::string>(),
                                        row[2].as<std::string>()));
    return look;
  });
}

HistoryDocument history_of(const std::string& url, const std::string& cell, int limit,
                           std::optional<std::int64_t> before) {
  return reading(url, {}, [&](pqxx::transaction_base& transaction) {
    // One more than is shown tells whether there are older ones.
    const pqxx::result rows = transaction.exec_params(
        "SELECT seq, kind, at, run, body FROM event WHERE cell = $1 AND seq < $2 ORDER BY seq DESC LIMIT $3",
        cell, before.value_or(std::numeric_limits<std::int64_t>::max()), limit + 1);
    HistoryDocument history{.cell = cell};
    for (const pqxx::row& row : rows) {
      if (std::ssize(history.facts) == limit) {
        history.next_before = history.facts.back().seq;
        break;
      }
      history.facts.push_back(told_fact(row));
    }
    return history;
  });
}

RunsDocument runs_of_cell(const std::string& url, const std::string& cell, int limit,
                          std::optional<std::int64_t> before,
                          const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, patience, [&](pqxx::transaction_base& transaction) {
    // One more than is shown tells whether there are older ones.
    const pqxx::result began = transaction.exec_params(
        kNewestRuns, cell, before.value_or(std::numeric_limits<std::int64_t>::max()), limit + 1);
    std::string runs;
    std::optional<std::string> oldest;
    std::int64_t from = 0;
    const auto shown = std::min(static_cast<pqxx::result::size_type>(limit), began.size());
    for (pqxx::result::size_type i = 0; i < shown; ++i) {
      oldest = began[i]["run"].as<std::string>();
      from = began[i]["seq"].as<std::int64_t>();
      runs += (runs.empty() ? "{" : ",") + *oldest;
    }
    if (!oldest) return RunsDocument();
    std::vector<ArchivedFact> facts;
    for (const pqxx::row& row : transaction.exec_params(kFactsOfRuns, cell, from, runs + "}"))
      facts.push_back(told_fact(row));
    RunsDocument document = archived_runs(facts);
    if (began.size() > shown) document.next_before = oldest;
    return document;
  });
}

}  // namespace cell
