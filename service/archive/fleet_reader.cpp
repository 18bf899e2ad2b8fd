#include "service/archive/fleet_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <pqxx/pqxx>

#include "config/utc_text.hpp"
#include "service/archive/internal/archive_reading.hpp"
#include "service/base/utc_time.hpp"

namespace cell {
namespace {

/// A look-up for each name there is: a DISTINCT would read the whole table.
constexpr const char* kFleet = R"sql(
WITH RECURSIVE names AS (
  (SELECT cell FROM event ORDER BY cell LIMIT 1)
  UNION ALL SELECT (SELECT cell FROM event WHERE cell > names.cell ORDER BY cell LIMIT 1) FROM names WHERE cell IS NOT NULL
), cells AS (SELECT cell FROM names WHERE cell IS NOT NULL)
SELECT cells.cell, newest.at AS last_event_at, state.kind AS state,
  coalesce(checked.body::json ->> 'arm', model.body::json ->> 'arm', ended.body::json ->> 'arm') AS arm,
  model.body::json ->> 'arm_serial' AS arm_serial, ended.run AS last_run, ended.body::json ->> 'recipe' AS recipe,
  ended.body::json ->> 'outcome' AS outcome, ended.body::json ->> 'verdict' AS verdict, ended.at AS ended_at,
  model.body::json ->> 'current' AS model, model.at AS approved_at, model.body::json ->> 'valid_until' AS valid_until,
  model.body::json ->> 'tip_box_max_mm' AS tip_box_max_mm,
  applied.body::json ->> 'hash' AS applied_model, applied.at AS applied_at, applied.body::json ->> 'to' AS applied_to,
  proof.at AS last_proof_at, proof.body::json ->> 'verdict' AS last_proof_verdict,
  checked.at AS last_check_at, checked.body::json ->> 'verdict' AS last_check_verdict, checked.body::json ->> 'cause' AS last_check_cause,
  checked.body::json ->> 'every_days' AS check_every_days,
  fault.body::json ->> 'code' AS last_fault, fault.at AS last_fault_at
FROM cells
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
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'applied' ORDER BY seq DESC LIMIT 1) AS applied ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'fault' ORDER BY seq DESC LIMIT 1) AS fault ON true
LEFT JOIN LATERAL (SELECT CASE kind WHEN 'run_started' THEN 'running' WHEN 'fault' THEN 'fault' ELSE 'idle' END AS kind
  FROM (
    (SELECT seq, kind FROM event WHERE cell = cells.cell AND kind = 'run_started' ORDER BY seq DESC LIMIT 1)
    UNION ALL
    (SELECT seq, kind FROM event WHERE cell = cells.cell AND kind = 'run_ended' ORDER BY seq DESC LIMIT 1)
    UNION ALL
    (SELECT seq, kind FROM event WHERE cell = cells.cell AND kind = 'fault' ORDER BY seq DESC LIMIT 1)) AS kinds
  ORDER BY seq DESC LIMIT 1) AS state ON true
ORDER BY cells.cell)sql";

/// Facts of a fault say no arm, and those of older daemons none at all: then it is the cell's last.
constexpr const char* kTrends = R"sql(
WITH told AS (
  SELECT cell, seq, kind, left(at, 7) AS month, body::json AS body FROM event
  WHERE kind IN ('run_ended', 'approved', 'check', 'proof', 'fault')
    AND at >= to_char((now() AT TIME ZONE 'UTC') - make_interval(months => $1 - 1), 'YYYY-MM')
), arms AS (
  SELECT DISTINCT ON (cell) cell, body ->> 'arm' AS arm FROM told WHERE body ->> 'arm' IS NOT NULL ORDER BY cell, seq DESC
), facts AS (
  SELECT told.*, coalesce(body ->> 'arm', arms.arm) AS arm FROM told LEFT JOIN arms USING (cell)
)
SELECT arm, month, count(DISTINCT cell) AS cells,
  count(*) FILTER (WHERE calibration) AS calibrations,
  count(*) FILTER (WHERE calibration AND body ->> 'verdict' = 'rejected') AS rejected,
  count(*) FILTER (WHERE kind = 'approved') AS approved,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY CASE json_typeof(body -> 'tip_box_max_mm') WHEN 'number'
    THEN (body ->> 'tip_box_max_mm')::double precision END) FILTER (WHERE kind = 'approved') AS tip_box_max_mm,
  count(*) FILTER (WHERE kind = 'check') AS checks,
  count(*) FILTER (WHERE kind = 'check' AND body ->> 'verdict' = 'rejected') AS alarms,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY CASE json_typeof(body -> 'growth_ppm') WHEN 'number'
    THEN (body ->> 'growth_ppm')::double precision END) FILTER (WHERE kind = 'check') AS growth_ppm,
  count(*) FILTER (WHERE kind = 'proof') AS proofs,
  count(*) FILTER (WHERE kind = 'proof' AND body ->> 'verdict' = 'rejected') AS failed_proofs,
  count(*) FILTER (WHERE kind = 'fault') AS faults
FROM (SELECT *, kind = 'run_ended' AND coalesce(body ->> 'kind', 'calibration') = 'calibration'
        AND body ->> 'outcome' = 'complete' AS calibration FROM facts) AS facts
GROUP BY arm, month ORDER BY month DESC, arm)sql";

/// The server breaks off what takes longer.
void bound(pqxx::transaction_base& transaction, const std::optional<std::chrono::milliseconds>& patience) {
  if (patience) transaction.exec0(fmt::format("SET LOCAL statement_timeout = {}", patience->count()));
}

/// A cell may write what it likes into its own facts: what is no time or no number of days is nothing.
std::optional<std::string> days_after(const std::optional<std::string>& at, std::optional<double> days) {
  constexpr double kDaysMax = 36'500;
  const auto time = at ? time_from_utc(*at) : std::nullopt;
  if (!time || !days || !(*days >= 0 && *days <= kDaysMax)) return std::nullopt;
  return format_utc(*time + std::chrono::days(static_cast<int>(*days)));
}

}  // namespace

FleetDocument fleet_of(const std::string& url, const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, [&](pqxx::transaction_base& transaction) {
    bound(transaction, patience);
    FleetDocument fleet;
    for (const pqxx::row& row : transaction.exec(kFleet)) {
      fleet.cells.push_back({.cell = row["cell"].as<std::string>(),
                             .last_event_at = row["last_event_at"].as<std::string>(),
                             .state = text_or_none(row["state"]),
                             .arm = text_or_none(row["arm"]),
                             .arm_serial = text_or_none(row["arm_serial"]),
                             .last_run_id = text_or_none(row["last_run"]),
                             .recipe = text_or_none(row["recipe"]),
                             .outcome = text_or_none(row["outcome"]),
                             .verdict = text_or_none(row["verdict"]),
                             .ended_at = text_or_none(row["ended_at"]),
                             .model = text_or_none(row["model"]),
                             .approved_at = text_or_none(row["approved_at"]),
                             .valid_until = text_or_none(row["valid_until"]),
                             .tip_box_max_mm = number_or_none(row["tip_box_max_mm"]),
                             .applied_model = text_or_none(row["applied_model"]),
                             .applied_at = text_or_none(row["applied_at"]),
                             .applied_to = text_or_none(row["applied_to"]),
                             .last_proof_at = text_or_none(row["last_proof_at"]),
                             .last_proof_verdict = text_or_none(row["last_proof_verdict"]),
                             .last_check_at = text_or_none(row["last_check_at"]),
                             .last_check_verdict = text_or_none(row["last_check_verdict"]),
                             .last_check_cause = text_or_none(row["last_check_cause"]),
                             .check_due_at = days_after(text_or_none(row["last_check_at"]),
                                                        number_or_none(row["check_every_days"])),
                             .last_fault_code = text_or_none(row["last_fault"]),
                             .last_fault_at = text_or_none(row["last_fault_at"])});
    }
    return fleet;
  });
}

FleetTrendsDocument trends_of(const std::string& url, int months,
                              const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, [&](pqxx::transaction_base& transaction) {
    bound(transaction, patience);
    FleetTrendsDocument document;
    for (const pqxx::row& row : transaction.exec_params(kTrends, months)) {
      const auto count = [&row](const char* column) { return row[column].as<std::int64_t>(); };
      document.trends.push_back({.arm = text_or_none(row["arm"]),
                                 .month = row["month"].as<std::string>(),
                                 .cells = count("cells"),
                                 .calibrations = count("calibrations"),
                                 .rejected = count("rejected"),
                                 .approved = count("approved"),
                                 .tip_box_max_mm = number_or_none(row["tip_box_max_mm"]),
                                 .checks = count("checks"),
                                 .alarms = count("alarms"),
                                 .growth_ppm = number_or_none(row["growth_ppm"]),
                                 .proofs = count("proofs"),
                                 .failed_proofs = count("failed_proofs"),
                                 .faults = count("faults")});
    }
    return document;
  });
}

}  // namespace cell
