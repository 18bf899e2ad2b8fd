#include "service/archive/fleet_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <pqxx/pqxx>

#include "config/utc_text.hpp"
#include "service/archive/internal/archive_reading.hpp"
#include "service/base/utc_time.hpp"

namespace cell {
namespace {

constexpr const char* kFleetQuery = R"sql(
SELECT cell, last_event_at, state, arm, arm_serial, last_run, recipe, outcome, verdict, ended_at, model, approved_at, valid_until,
  tip_box_max_mm, applied_model, applied_at, applied_to, last_proof_at, last_proof_verdict, last_check_at, last_check_verdict,
  last_check_cause, check_due_since, check_every_days, expiring, expires, last_fault, last_fault_at,
  coalesce(to_char(heard_at AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"'), last_event_at) AS heard_at,
  to_char(now() AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"') AS now
FROM fleet ORDER BY cell LIMIT 10000)sql";

/// Facts of a fault say no arm, and those of older daemons none at all: then it is the cell's last. The facts
/// are found before that, by the index that has all that is counted of them.
constexpr const char* kTrendsQuery = R"sql(
WITH facts AS MATERIALIZED (
  SELECT cell, left(at, 7) AS month, counted, told_arm, told_verdict AS verdict, told_figure AS figure FROM event
  WHERE counted IS NOT NULL
    AND at >= to_char((now() AT TIME ZONE 'UTC') - make_interval(months => $1 - 1), 'YYYY-MM')
    AND at < to_char((now() AT TIME ZONE 'UTC') + make_interval(months => 1), 'YYYY-MM')
)
SELECT coalesce(told_arm, fleet_cell.arm) AS arm, month, count(DISTINCT cell) AS cells,
  count(*) FILTER (WHERE counted = 'calibration') AS calibrations,
  count(*) FILTER (WHERE counted = 'calibration' AND verdict = 'rejected') AS rejected,
  count(*) FILTER (WHERE counted = 'approved') AS approved,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY figure) FILTER (WHERE counted = 'approved') AS tip_box_max_mm,
  count(*) FILTER (WHERE counted = 'check') AS checks,
  count(*) FILTER (WHERE counted = 'check' AND verdict = 'rejected') AS alarms,
  percentile_cont(0.5) WITHIN GROUP (ORDER BY figure) FILTER (WHERE counted = 'check') AS growth_ppm,
  count(*) FILTER (WHERE counted = 'proof') AS proofs,
  count(*) FILTER (WHERE counted = 'proof' AND verdict = 'rejected') AS failed_proofs,
  count(*) FILTER (WHERE counted = 'fault') AS faults
FROM facts LEFT JOIN fleet_cell USING (cell)
GROUP BY 1, 2 ORDER BY 2 DESC, 1 LIMIT 10000)sql";

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
  cell.check_due_at = days_after(text("check_due_since"), number_or_none(row["check_every_days"]));
  cell.check_overdue = has_come(cell.check_due_at, now);
  cell.model_over = has_come(cell.valid_until, now);
  if (cell.certificate_valid_until)  // a date: to its end
    cell.certificate_over = has_come(days_after(*cell.certificate_valid_until + "T00:00:00.000Z", 1.0), now);
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
