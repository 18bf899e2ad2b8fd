#include "service/archive/fleet_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <pqxx/pqxx>

#include "config/utc_text.hpp"
#include "service/archive/internal/archive_reading.hpp"
#include "service/base/utc_time.hpp"

namespace cell {
namespace {

/// A look-up for each name there is: a DISTINCT would read the whole table.
constexpr const char* kFleetQuery = R"sql(
WITH RECURSIVE names AS (
  (SELECT cell FROM event ORDER BY cell LIMIT 1)
  UNION ALL SELECT (SELECT cell FROM event WHERE cell > names.cell ORDER BY cell LIMIT 1) FROM names WHERE cell IS NOT NULL
), cells AS (SELECT cell FROM names WHERE cell IS NOT NULL)
SELECT cells.cell, newest.at AS last_event_at, to_char(newest.archived_at AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"') AS heard_at,
  CASE WHEN started.seq IS NULL THEN NULL WHEN started.seq > coalesce(any_ended.seq, 0) THEN 'running' ELSE 'idle' END AS state,
  (SELECT arm FROM (VALUES (checked.seq, checked.body::json ->> 'arm'), (model.seq, model.body::json ->> 'arm'),
    (ended.seq, ended.body::json ->> 'arm')) AS said(seq, arm) WHERE arm IS NOT NULL ORDER BY seq DESC LIMIT 1) AS arm,
  model.body::json ->> 'arm_serial' AS arm_serial, ended.run AS last_run, ended.body::json ->> 'recipe' AS recipe,
  ended.body::json ->> 'outcome' AS outcome, ended.body::json ->> 'verdict' AS verdict, ended.at AS ended_at,
  model.body::json ->> 'current' AS model, model.at AS approved_at, model.body::json ->> 'valid_until' AS valid_until,
  model.body::json ->> 'tip_box_max_mm' AS tip_box_max_mm,
  applied.body::json ->> 'hash' AS applied_model, applied.at AS applied_at, applied.body::json ->> 'to' AS applied_to,
  proof.at AS last_proof_at, proof.body::json ->> 'verdict' AS last_proof_verdict,
  checked.at AS last_check_at, checked.body::json ->> 'verdict' AS last_check_verdict, checked.body::json ->> 'cause' AS last_check_cause,
  -- A later calibration has checks of its own.
  CASE WHEN checked.seq > coalesce(ended.seq, 0) OR ended.body::json ->> 'verdict' <> 'accepted'
    THEN checked.body::json ->> 'every_days' END AS check_every_days,
  expiring.body::json ->> 'artefact' AS expiring, expiring.body::json ->> 'valid_until' AS expires, 
  to_char(now() AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"') AS now,
  fault.body::json ->> 'code' AS last_fault, fault.at AS last_fault_at
FROM cells
JOIN LATERAL (SELECT at, archived_at FROM event WHERE cell = cells.cell ORDER BY seq DESC LIMIT 1) AS newest ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'run_ended'
  AND coalesce(body::json ->> 'kind', 'calibration') = 'calibration' AND body::json ->> 'outcome' <> 'withdrawn' ORDER BY seq DESC LIMIT 1) AS ended ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'proof' ORDER BY seq DESC LIMIT 1) AS proof ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'check' ORDER BY seq DESC LIMIT 1) AS checked ON true
LEFT JOIN LATERAL (SELECT * FROM (
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'approved' ORDER BY seq DESC LIMIT 1)
    UNION ALL
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'rolled_back' ORDER BY seq DESC LIMIT 1)) AS both_kinds
  ORDER BY seq DESC LIMIT 1) AS model ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'applied' ORDER BY seq DESC LIMIT 1) AS applied ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'fault' ORDER BY seq DESC LIMIT 1) AS fault ON true
LEFT JOIN LATERAL (SELECT seq FROM event WHERE cell = cells.cell AND kind = 'run_started' ORDER BY seq DESC LIMIT 1) AS started ON true
LEFT JOIN LATERAL (SELECT seq FROM event WHERE cell = cells.cell AND kind = 'run_ended' ORDER BY seq DESC LIMIT 1) AS any_ended ON true
LEFT JOIN LATERAL (SELECT * FROM event WHERE cell = cells.cell AND kind = 'certificate_expiring' ORDER BY seq DESC LIMIT 1) AS expiring ON true
ORDER BY cells.cell LIMIT 10000)sql";

/// Facts of a fault say no arm, and those of older daemons none at all: then it is the cell's last.
constexpr const char* kTrendsQuery = R"sql(
WITH told AS (
  SELECT cell, seq, kind, left(at, 7) AS month, body::json AS body FROM event
  WHERE kind IN ('run_ended', 'approved', 'check', 'proof', 'fault')
    AND at >= to_char((now() AT TIME ZONE 'UTC') - make_interval(months => $1 - 1), 'YYYY-MM')
    AND at < to_char((now() AT TIME ZONE 'UTC') + make_interval(months => 1), 'YYYY-MM')
), arms AS (
  SELECT cell, (SELECT body::json ->> 'arm' FROM event WHERE event.cell = cells.cell AND kind = 'run_ended'
    AND body::json ->> 'arm' IS NOT NULL ORDER BY seq DESC LIMIT 1) AS arm FROM (SELECT DISTINCT cell FROM told) AS cells
), facts AS (
  SELECT told.*, left(coalesce(body ->> 'arm', arms.arm), 100) AS arm FROM told LEFT JOIN arms USING (cell)
)
SELECT arm, month, count(DISTINCT cell) AS cells,
  count(*) FILTER (WHERE calibration) AS calibrations,
  count(*) FILTER (WHERE calibration AND body ->> 'verdict' = 'rejected') AS rejected,
  count(*) FILTER (WHERE kind = 'approved') AS approved,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY (body ->> 'tip_box_max_mm')::double precision)
    FILTER (WHERE kind = 'approved') AS tip_box_max_mm,
  count(*) FILTER (WHERE kind = 'check') AS checks,
  count(*) FILTER (WHERE kind = 'check' AND body ->> 'verdict' = 'rejected') AS alarms,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY (body ->> 'growth_ppm')::double precision)
    FILTER (WHERE kind = 'check') AS growth_ppm,
  count(*) FILTER (WHERE kind = 'proof') AS proofs,
  count(*) FILTER (WHERE kind = 'proof' AND body ->> 'verdict' = 'rejected') AS failed_proofs,
  count(*) FILTER (WHERE kind = 'fault') AS faults
FROM (SELECT *, kind = 'run_ended' AND coalesce(body ->> 'kind', 'calibration') = 'calibration'
        AND body ->> 'outcome' = 'complete' AS calibration FROM facts) AS facts
GROUP BY arm, month ORDER BY month DESC, arm LIMIT 10000)sql";

/// What is no time of ours, or no number of days, is nothing: a cell may write what it likes.
std::optional<std::string> days_after(const std::optional<std::string>& at, std::optional<double> days) {
  constexpr double kDaysMax = 36'500;
  const auto time = at ? time_from_utc(*at) : std::nullopt;
  if (!time || !days || !(*days >= 0 && *days <= kDaysMax)) return std::nullopt;
  return format_utc(*time + std::chrono::days(static_cast<int>(*days)));
}

FleetCell cell_in(const pqxx::row& row) {
  const auto text = [&row](const char* column) { return text_or_none(row[column]); };
  const auto now = time_from_utc(row["now"].as<std::string>()).value();
  FleetCell cell{.cell = row["cell"].as<std::string>(),
                 .last_event_at = row["last_event_at"].as<std::string>(),
                 .heard_at = row["heard_at"].as<std::string>(),
                 .state = text("state"),
                 .arm = text("arm"),
                 .arm_serial = text("arm_serial"),
                 .last_run_id = text("last_run"),
                 .recipe = text("recipe"),
                 .outcome = text("outcome"),
                 .verdict = text("verdict"),
                 .ended_at = text("ended_at"),
                 .model = text("model"),
                 .approved_at = text("approved_at"),
                 .valid_until = text("valid_until"),
                 .tip_box_max_mm = number_or_none(row["tip_box_max_mm"]),
                 .applied_model = text("applied_model"),
                 .applied_at = text("applied_at"),
                 .applied_to = text("applied_to"),
                 .last_proof_at = text("last_proof_at"),
                 .last_proof_verdict = text("last_proof_verdict"),
                 .last_check_at = text("last_check_at"),
                 .last_check_verdict = text("last_check_verdict"),
                 .last_check_cause = text("last_check_cause"),
                 .certificate_artefact = text("expiring"),
                 .certificate_valid_until = text("expires"),
                 .last_fault_code = text("last_fault"),
                 .last_fault_at = text("last_fault_at")};
  cell.check_due_at = days_after(cell.last_check_at, number_or_none(row["check_every_days"]));
  cell.check_overdue = has_come(cell.check_due_at, now);
  cell.model_over = has_come(cell.valid_until, now);
  return cell;
}

}  // namespace

FleetDocument fleet_of(const std::string& url, const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, patience, [](pqxx::transaction_base& transaction) {
    FleetDocument fleet;
    for (const pqxx::row& row : transaction.exec(kFleetQuery)) fleet.cells.push_back(cell_in(row));
    return fleet;
  });
}

FleetTrendsDocument trends_of(const std::string& url, int months,
                              const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, patience, [&](pqxx::transaction_base& transaction) {
    FleetTrendsDocument document;
    for (const pqxx::row& row : transaction.exec_params(kTrendsQuery, months)) {
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
