// What an archive of many cells costs, on a PostgreSQL of its own that syncs what it commits:
//   archive_benchmark [CELLS [YEARS]]      500 cells and 10 years of the fleet
// Fifty cells deliver a run of 150 touches at once; what fifty cells take in ten years is told from what a
// calibration and a check took. The fleet is read over many cells and years, and up to fifty of them with
// their touches are verified.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <pqxx/pqxx>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/archive_sink.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/archive/postgres.hpp"

namespace cell {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCellsAtOnce = 50;
constexpr int kTouchesOfRun = 150;
constexpr int kTouchesOfCheck = 12;
constexpr double kAtOnceMax_s = 30.0;
constexpr double kFleetMax_s = 1.0;
constexpr double kVerificationMax_s = 300.0;
constexpr int kChecksOfWeek = 5;  // beside a calibration
constexpr int kWeeksOfYear = 52;

double seconds_of(const std::function<void()>& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// As many figures as a document of so many bytes has: they do not compress as words do.
std::string figures(std::mt19937_64& chance, std::size_t bytes) {
  std::uniform_real_distribution<double> figure(-1.0, 1.0);
  std::string text = R"({"arm":"tx90","rms_mm":0.012,"growth_ppm":4.5,"figures":[)";
  while (text.size() + 2 < bytes) text += fmt::format("{:.15g},", figure(chance));
  text.back() = ']';
  return text + "}";
}

/// One run of a cell that ended.
void add_run(RunStore& store, RunKind kind, int touches, std::size_t result_bytes, std::mt19937_64& chance) {
  const std::int64_t run = store.begin_run(
      {.kind = kind,
       .of_run = kind == RunKind::kCalibration ? std::nullopt : std::optional<std::int64_t>(1),
       .recipe = "edf-37",
       .touches_total = touches,
       .started_at = "2026-01-01T00:00:00.000Z"});
  const std::string plan = figures(chance, static_cast<std::size_t>(touches) * 300);
  store.set_plan(run, touches, "plan", plan);
  std::uniform_int_distribution<std::int32_t> joint(-170'000'000, 170'000'000);
  for (int number = 1; number <= touches; ++number)
    store.append_touch(run, {.number = number,
                             .plane = 1 + number % 4,
                             .joints = {joint(chance), joint(chance), joint(chance), joint(chance),
                                        joint(chance), joint(chance)},
                             .captured_at = "2026-01-01T00:00:01.000Z"});
  store.finish_run(run, {.outcome = RunOutcome::kComplete,
                         .verdict = Verdict::kAccepted,
                         .ended_at = "2026-01-01T00:20:00.000Z",
                         .result_json = figures(chance, result_bytes),
                         .arm_json = figures(chance, 4'000)});
}

/// A cell whose facts wait.
struct WaitingCell {
  WaitingCell(std::string cell_name, RunKind kind, int touches, std::size_t result_bytes)
      : name(std::move(cell_name)) {
    std::mt19937_64 chance(std::hash<std::string>{}(name));
    add_run(store, kind, touches, result_bytes, chance);
  }
  void deliver(const Postgres& server) {
    const auto facts = OutboxReader(file).next(0, 1000);
    (void)connect_archive(server.url(name), name, file)->deliver(facts, {});
  }
  std::string name;
  Folder folder;
  std::filesystem::path file = folder.path() / "touchcal.sqlite";
  RunStore store{file};
};

double megabytes(const std::string& owner) {
  pqxx::connection connection(owner);
  pqxx::work work(connection);
  work.exec0("CHECKPOINT");
  return work.exec1(
                 "SELECT sum(pg_total_relation_size(oid)) FROM pg_class WHERE relname IN ('event', 'touch', "
                 "'document')")[0]
             .as<double>() /
         1e6;
}

long rows_of(const std::string& owner, const std::string& table) {
  pqxx::connection connection(owner);
  pqxx::work work(connection);
  return work.exec1("SELECT count(*) FROM " + table)[0].as<long>();
}

/// What was delivered is there, once.
void demand_rows(const std::string& owner, const std::string& table, long wanted) {
  const long found = rows_of(owner, table);
  if (found != wanted)
    throw std::runtime_error(fmt::format("{} rows of {} in the archive, and not {}", found, table, wanted));
}

std::vector<std::unique_ptr<WaitingCell>> waiting_cells(const Postgres& server, const std::string& prefix,
                                                        RunKind kind, int touches, std::size_t result_bytes) {
  std::vector<std::unique_ptr<WaitingCell>> cells;
  for (int i = 0; i < kCellsAtOnce; ++i) {
    cells.push_back(std::make_unique<WaitingCell>(prefix + std::to_string(i), kind, touches, result_bytes));
    server.sql("CREATE ROLE \"" + cells.back()->name + "\" LOGIN IN ROLE touchcal_writer");
  }
  return cells;
}

/// All of them, each on a thread and over a connection of its own.
double deliver_at_once(const Postgres& server, std::vector<std::unique_ptr<WaitingCell>>& cells) {
  return seconds_of([&] {
    std::vector<std::jthread> threads;
    threads.reserve(cells.size());
    for (const auto& cell : cells) threads.emplace_back([&server, &cell] { cell->deliver(server); });
  });
}

/// Facts as a cell tells them in those years: a calibration and five checks a week, a proof a quarter, an
/// approval and a word that it is in use a year, a fault a month.
void fill(const Postgres& server, int cells, int years) {
  const std::string weeks = std::to_string(years * kWeeksOfYear);
  server.sql("TRUNCATE event, touch, document");
  server.sql(fmt::format(
      R"sql(INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256)
SELECT 'cell-' || cell, row_number() OVER (PARTITION BY cell ORDER BY week, told.place), 1, told.kind,
  to_char(now() AT TIME ZONE 'UTC' - make_interval(weeks => {} - week), 'YYYY-MM-DD"T"HH24:MI:SS.MS"Z"'),
  week, md5(week::text) || md5(cell::text), told.body, md5(cell::text) || md5(week::text)
FROM generate_series(1, {}) AS cell, generate_series(1, {}) AS week, LATERAL (
  SELECT place, kind, body FROM (VALUES
    (0, 'run_started', '{{"recipe":"edf-37","operator":"M. Curie","config_digest":"' || md5(cell::text) || '"}}'),
    (1, 'touch_set_closed', '{{"touches":150,"touches_sha256":"' || md5(week::text) || '","result_sha256":null,"arm_sha256":null}}'),
    (2, 'run_ended', '{{"recipe":"edf-37","outcome":"complete","verdict":"accepted","fault_code":null,"fault_message":null,"touches_done":150,"touches_total":150,"kind":"calibration","arm":"tx90"}}')
    ) AS calibration(place, kind, body)
  UNION ALL SELECT 10 + 4 * number + place, kind, body FROM generate_series(1, {}) AS number, (VALUES
    (0, 'run_started', '{{"recipe":"edf-37","operator":"M. Curie","config_digest":"x"}}'),
    (1, 'touch_set_closed', '{{"touches":12,"touches_sha256":"x","result_sha256":null,"arm_sha256":null}}'),
    (2, 'run_ended', '{{"recipe":"edf-37","outcome":"complete","verdict":"accepted","fault_code":null,"fault_message":null,"touches_done":12,"touches_total":12,"kind":"check","arm":"tx90"}}'),
    (3, 'check', '{{"of_run":1,"arm":"tx90","verdict":"accepted","rms_mm":0.01,"cause":null,"joint":null,"growth_ppm":4.5}}')
    ) AS checked(place, kind, body)
  UNION ALL SELECT 100, 'proof', '{{"of_run":1,"arm":"tx90","verdict":"accepted","rms_mm":0.02}}' WHERE week % 13 = 0
  UNION ALL SELECT 101, 'approved', '{{"hash":"' || md5(week::text) || '","operator":null,"valid_until":null,"tip_box_max_mm":0.08,"arm":"tx90","arm_serial":"N","current":"' || md5(week::text) || '"}}' WHERE week % 52 = 1
  UNION ALL SELECT 102, 'applied', '{{"hash":"' || md5(week::text) || '","operator":null,"to":"cell"}}' WHERE week % 52 = 1
  UNION ALL SELECT 103, 'fault', '{{"code":"link_lost","message":"the link is lost"}}' WHERE week % 4 = 0
) AS told)sql",
      weeks, cells, weeks, kChecksOfWeek));
  server.sql("ANALYZE event");
}

/// Gives what fill() has written true digests, and each set of touches its touches, a result and an arm.
void chain(const Postgres& server) {
  server.sql(R"sql(DO $$
DECLARE fact record; said text; before text := ''; chained text := ''; named text;
BEGIN
  FOR fact IN SELECT * FROM event ORDER BY cell, seq LOOP
    IF fact.cell <> chained THEN before := ''; chained := fact.cell; END IF;
    said := fact.body;
    IF fact.kind = 'touch_set_closed' THEN
      FOREACH named IN ARRAY ARRAY['result', 'arm'] LOOP
        said := replace(said, '"' || named || '_sha256":null', '"' || named || '_sha256":"' ||
          encode(sha256(convert_to(concat_ws(' ', named, fact.cell, fact.seq), 'UTF8')), 'hex') || '"');
        INSERT INTO document(sha256, body) SELECT encode(sha256(convert_to(body, 'UTF8')), 'hex'), body
        FROM (VALUES (concat_ws(' ', named, fact.cell, fact.seq))) AS told(body);
      END LOOP;
      INSERT INTO touch SELECT fact.cell, fact.seq, fact.seq, number, 1, 'fit',
        ARRAY[number, 1000000, 2000000, 3000000, 4000000, 5000000], fact.at
      FROM generate_series(1, (said::json ->> 'touches')::integer) AS number;
    END IF;
    UPDATE event SET run = fact.seq, body = said, previous = before, sha256 = (
      SELECT encode(sha256(convert_to(string_agg(octet_length(field) || ':' || field, '' ORDER BY place), 'UTF8')), 'hex')
      FROM unnest(ARRAY[before, fact.seq::text, fact.instance::text, fact.kind, fact.at, fact.seq::text, said])
        WITH ORDINALITY AS fields(field, place))
    WHERE cell = fact.cell AND seq = fact.seq RETURNING sha256 INTO before;
  END LOOP;
END $$)sql");
  server.sql("ANALYZE event, document, touch");
}

void tell(const std::string& what, double seconds, double limit) {
  const bool met = seconds <= limit;
  std::printf("%s: %.2f s  (at most %.0f: %s)\n", what.c_str(), seconds, limit, met ? "met" : "MISSED");
  std::fflush(stdout);
}

bool measure_verification(const Postgres& server, int cells, int years) {
  fill(server, cells, years);
  chain(server);
  ArchiveDocument look;
  tell(fmt::format("verification of {} cells and {} years, with their touches", cells, years),
       seconds_of([&] { look = look_at_archive(server.url()); }), kVerificationMax_s);
  if (look.cells == cells && look.damage.empty()) return true;
  std::printf("it finds %ld cells, and %zu times damage\n", static_cast<long>(look.cells),
              look.damage.size());
  return false;
}

/// Whether what was read is what was written; the times are printed, and are for a quiet machine.
bool measure(int cells, int years) {
  // Of results as touchcald stores them.
  constexpr std::size_t kResultBytes = 60'000, kCheckResultBytes = 6'000;
  const Postgres server({"fsync=on", "max_connections=120"});
  const std::string owner = server.url();
  prepare_archive(owner);
  auto runs = waiting_cells(server, "run-", RunKind::kCalibration, kTouchesOfRun, kResultBytes);
  tell(fmt::format("{} cells deliver a run of {} touches at once", kCellsAtOnce, kTouchesOfRun),
       deliver_at_once(server, runs), kAtOnceMax_s);
  demand_rows(owner, "event", 3 * kCellsAtOnce);
  demand_rows(owner, "touch", kTouchesOfRun * kCellsAtOnce);
  demand_rows(owner, "document", 3 * kCellsAtOnce);
  const double run_mb = megabytes(owner) / kCellsAtOnce;
  server.sql("TRUNCATE event, touch, document");
  auto checks = waiting_cells(server, "check-", RunKind::kCheck, kTouchesOfCheck, kCheckResultBytes);
  std::printf("... and a check of %d touches: %.2f s\n", kTouchesOfCheck, deliver_at_once(server, checks));
  const double check_mb = megabytes(owner) / kCellsAtOnce;
  std::printf(
      "a calibration takes %.0f kB of the archive, a check %.0f kB; %d cells with a calibration and %d "
      "checks a "
      "week for ten years %.1f GB\n",
      run_mb * 1e3, check_mb * 1e3, kCellsAtOnce, kChecksOfWeek,
      (run_mb + kChecksOfWeek * check_mb) * kCellsAtOnce * kWeeksOfYear * 10 / 1e3);
  const double filled_s = seconds_of([&] { fill(server, cells, years); });
  std::printf("%d cells and %d years are %ld facts, %.0f MB (written in %.0f s)\n", cells, years,
              rows_of(owner, "event"), megabytes(owner), filled_s);
  FleetDocument fleet;
  FleetTrendsDocument trends;
  tell(fmt::format("fleet over {} cells and {} years", cells, years),
       seconds_of([&] { fleet = fleet_of(owner); }), kFleetMax_s);
  tell("trends over 12 months of them", seconds_of([&] { trends = trends_of(owner, 12); }), 5.0);
  if (std::ssize(fleet.cells) != cells || trends.trends.size() < 12) {
    std::printf("the archive shows %zu cells, %zu trends\n", fleet.cells.size(), trends.trends.size());
    return false;
  }
  return measure_verification(server, std::min(cells, kCellsAtOnce), years);
}

}  // namespace
}  // namespace cell

int main(int argc, char** argv) try {
  return cell::measure(argc > 1 ? std::stoi(argv[1]) : 500, argc > 2 ? std::stoi(argv[2]) : 10) ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "archive_benchmark: %s\n", error.what());
  return 2;
}
