#include "service/archive/archive_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>
#include <pqxx/pqxx>
#include <stdexcept>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/internal/archive_version.hpp"
#include "service/store/outbox.hpp"

namespace cell {
namespace {

/// Runs `read` in a transaction that only reads, on an archive of this version.
template <class Read>
auto reading(const std::string& url, const Read& read) try {
  pqxx::connection connection(with_archive_bounds(url));
  pqxx::read_transaction transaction(connection);
  const int version = archive_version(transaction);
  refuse_newer_archive(version);
  if (version < newest_archive_schema())
    throw std::runtime_error(
        "the archive is not prepared; its owner runs touchcal archive prepare --archive URL");
  return read(transaction);
} catch (const pqxx::failure& error) {
  throw std::runtime_error(fmt::format("the archive cannot be read: {}", error.what()));
}

std::optional<std::string> text_or_none(const pqxx::field& field) {
  return field.is_null() ? std::nullopt : std::optional(field.as<std::string>());
}

std::optional<double> number_or_none(const pqxx::field& field) {
  return field.is_null() ? std::nullopt : std::optional(field.as<double>());
}

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

constexpr const char* kFleet = R"sql(
SELECT cells.cell, newest.at AS last_event_at, ended.run AS last_run, ended.body::json ->> 'recipe' AS recipe,
  ended.body::json ->> 'outcome' AS outcome, ended.body::json ->> 'verdict' AS verdict, ended.at AS ended_at,
  model.body::json ->> 'current' AS model, model.at AS approved_at, model.body::json ->> 'valid_until' AS valid_until,
  model.body::json ->> 'tip_box_max_mm' AS tip_box_max_mm,
  proof.at AS last_proof_at, proof.body::json ->> 'verdict' AS last_proof_verdict,
  checked.at AS last_check_at, checked.body::json ->> 'verdict' AS last_check_verdict, checked.body::json ->> 'cause' AS last_check_cause,
  fault.body::json ->> 'code' AS last_fault, fault.at AS last_fault_at
FROM (WITH RECURSIVE names AS (
        (SELECT cell FROM event ORDER BY cell LIMIT 1)
        UNION ALL SELECT (SELECT cell FROM event WHERE cell > names.cell ORDER BY cell LIMIT 1) FROM names WHERE cell IS NOT NULL)
      SELECT cell FROM names WHERE cell IS NOT NULL) AS cells
JOIN LATERAL (SELECT at FROM event WHERE cell = cells.cell ORDER BY seq DESC LIMIT 1) AS newest ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'run_ended'
  AND coalesce(body::json ->> 'kind', 'calibration') = 'calibration' ORDER BY seq DESC LIMIT 1) AS ended ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'proof' ORDER BY seq DESC LIMIT 1) AS proof ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'check' ORDER BY seq DESC LIMIT 1) AS checked ON true
LEFT JOIN LATERAL (SELECT * FROM (
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'approved' ORDER BY seq DESC LIMIT 1)
    UNION ALL
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'rolled_back' ORDER BY seq DESC LIMIT 1)) AS both_kinds
  ORDER BY seq DESC LIMIT 1) AS model ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'fault' ORDER BY seq DESC LIMIT 1) AS fault ON true
ORDER BY cells.cell)sql";

}  // namespace

ArchiveDocument look_at_archive(const std::string& url) {
  return reading(url, [](pqxx::transaction_base& transaction) {
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

FleetDocument fleet_of(const std::string& url) {
  return reading(url, [](pqxx::transaction_base& transaction) {
    FleetDocument fleet;
    for (const pqxx::row& row : transaction.exec(kFleet)) {
      fleet.cells.push_back({.cell = row["cell"].as<std::string>(),
                             .last_event_at = row["last_event_at"].as<std::string>(),
                             .last_run_id = text_or_none(row["last_run"]),
                             .recipe = text_or_none(row["recipe"]),
                             .outcome = text_or_none(row["outcome"]),
                             .verdict = text_or_none(row["verdict"]),
                             .ended_at = text_or_none(row["ended_at"]),
                             .model = text_or_none(row["model"]),
                             .approved_at = text_or_none(row["approved_at"]),
                             .valid_until = text_or_none(row["valid_until"]),
                             .tip_box_max_mm = number_or_none(row["tip_box_max_mm"]),
                             .last_proof_at = text_or_none(row["last_proof_at"]),
                             .last_proof_verdict = text_or_none(row["last_proof_verdict"]),
                             .last_check_at = text_or_none(row["last_check_at"]),
                             .last_check_verdict = text_or_none(row["last_check_verdict"]),
                             .last_check_cause = text_or_none(row["last_check_cause"]),
                             .last_fault_code = text_or_none(row["last_fault"]),
                             .last_fault_at = text_or_none(row["last_fault_at"])});
    }
    return fleet;
  });
}

HistoryDocument history_of(const std::string& url, const std::string& cell, int limit,
                           std::optional<std::int64_t> before) {
  return reading(url, [&](pqxx::transaction_base& transaction) {
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
      history.facts.push_back({.seq = row["seq"].as<std::int64_t>(),
                               .kind = row["kind"].as<std::string>(),
                               .at = row["at"].as<std::string>(),
                               .run_id = text_or_none(row["run"]),
                               .body = {row["body"].as<std::string>()}});
    }
    return history;
  });
}

}  // namespace cell
