#include "service/archive/archive_schema.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <pqxx/pqxx>
#include <stdexcept>

#include "service/archive/archive_options.hpp"
#include "service/archive/internal/archive_guards.hpp"
#include "service/archive/internal/archive_version.hpp"

namespace cell {
namespace {

/// A cell writes rows of its own name only, and nobody but the owner changes one. Times and bodies are texts
/// as the cell wrote them: the digests are of them.
constexpr const char* kEventsAndDocuments = R"sql(
CREATE TABLE event(
  cell text NOT NULL,
  seq bigint NOT NULL CHECK (seq > 0),
  instance bigint NOT NULL,
  kind text NOT NULL,
  at text NOT NULL,
  run bigint,
  previous text NOT NULL,
  body text NOT NULL,
  sha256 text NOT NULL,
  archived_at timestamptz NOT NULL DEFAULT now(),
  PRIMARY KEY (cell, seq)
);
CREATE INDEX event_of_kind ON event(cell, kind, seq DESC);
CREATE TABLE document(
  sha256 text PRIMARY KEY CHECK (sha256 = encode(sha256(convert_to(body, 'UTF8')), 'hex')),
  body text NOT NULL
);
CREATE TABLE touch(
  cell text NOT NULL,
  seq bigint NOT NULL,
  run bigint NOT NULL,
  number integer NOT NULL,
  plane integer NOT NULL,
  role text NOT NULL,
  joints_microdeg bigint[] NOT NULL CHECK (array_length(joints_microdeg, 1) = 6),
  captured_at text NOT NULL,
  PRIMARY KEY (cell, seq, number)
);
DO $$ BEGIN
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'touchcal_writer') THEN CREATE ROLE touchcal_writer NOLOGIN; END IF;
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'touchcal_quality') THEN CREATE ROLE touchcal_quality NOLOGIN; END IF;
END $$;
GRANT SELECT ON touchcal_schema TO touchcal_writer, touchcal_quality;
GRANT INSERT ON event, document, touch TO touchcal_writer;
GRANT SELECT ON event TO touchcal_writer;
GRANT SELECT ON event, document, touch TO touchcal_quality;
ALTER TABLE event ENABLE ROW LEVEL SECURITY;
ALTER TABLE touch ENABLE ROW LEVEL SECURITY;
CREATE POLICY own_events ON event FOR INSERT TO touchcal_writer WITH CHECK (cell = current_user);
CREATE POLICY seen_events ON event FOR SELECT TO touchcal_writer USING (cell = current_user);
CREATE POLICY own_touches ON touch FOR INSERT TO touchcal_writer WITH CHECK (cell = current_user);
CREATE POLICY all_events ON event FOR SELECT TO touchcal_quality USING (true);
CREATE POLICY all_touches ON touch FOR SELECT TO touchcal_quality USING (true);
)sql";

/// For what asks all cells at once: what trends count, beside the facts. To read the bodies of a year takes
/// ten times as long. Older daemons do not mind, so that this has no version of its own.
constexpr const char* kForReaders = R"sql(
CREATE INDEX IF NOT EXISTS event_by_time ON event(kind, at);
SET LOCAL lock_timeout = '10s';
ALTER TABLE event
  ADD COLUMN IF NOT EXISTS counted text GENERATED ALWAYS AS (CASE
    WHEN kind IN ('approved', 'check', 'proof', 'fault') THEN kind
    WHEN kind = 'run_ended' AND body::json ->> 'outcome' = 'complete'
      AND coalesce(body::json ->> 'kind', 'calibration') = 'calibration' THEN 'calibration' END) STORED,
  ADD COLUMN IF NOT EXISTS told_arm text GENERATED ALWAYS AS (left(body::json ->> 'arm', 100)) STORED,
  ADD COLUMN IF NOT EXISTS told_verdict text GENERATED ALWAYS AS (left(body::json ->> 'verdict', 100)) STORED,
  ADD COLUMN IF NOT EXISTS told_figure double precision GENERATED ALWAYS AS ((CASE kind
    WHEN 'approved' THEN body::json ->> 'tip_box_max_mm' WHEN 'check' THEN body::json ->> 'growth_ppm' END)::double precision) STORED;
CREATE INDEX IF NOT EXISTS event_counted ON event(at) INCLUDE (cell, counted, told_arm, told_verdict, told_figure)
  WHERE counted IS NOT NULL;
)sql";

/// What all readers ask, touchcal and the dashboards: who may read one cell sees that one in them too. They
/// are made anew each time, as a newer version may have other columns.
constexpr const char* kViews = R"sql(
DROP VIEW IF EXISTS fleet, fleet_cell;

-- The names, and the type of arm that each said last. A look-up for each: a DISTINCT would read the whole table.
CREATE VIEW fleet_cell WITH (security_invoker = true) AS
WITH RECURSIVE names AS (
  (SELECT cell FROM event ORDER BY cell LIMIT 1)
  UNION ALL SELECT (SELECT cell FROM event WHERE cell > names.cell ORDER BY cell LIMIT 1) FROM names WHERE cell IS NOT NULL
)
SELECT cell, (SELECT arm FROM
    (VALUES ('run_ended'), ('approved'), ('rolled_back'), ('check'), ('proof')) AS kinds(kind),
    LATERAL (SELECT seq, told_arm AS arm FROM event WHERE event.cell = names.cell AND event.kind = kinds.kind
      AND told_arm IS NOT NULL ORDER BY seq DESC LIMIT 1) AS said
  ORDER BY seq DESC LIMIT 1) AS arm
FROM names WHERE cell IS NOT NULL;

-- What each cell told last, its texts as it wrote them.
CREATE VIEW fleet WITH (security_invoker = true) AS
SELECT cells.cell, cells.arm, newest.at AS last_event_at, newest.archived_at AS heard_at,
  CASE WHEN started.seq IS NULL THEN NULL WHEN started.seq > coalesce(any_ended.seq, 0) THEN 'running' ELSE 'idle' END AS state,
  ended.run AS last_run, ended.body ->> 'recipe' AS recipe, ended.body ->> 'outcome' AS outcome, ended.body ->> 'verdict' AS verdict,
  ended.at AS ended_at,
  model.body ->> 'current' AS model, model.body ->> 'arm_serial' AS arm_serial, model.at AS approved_at,
  model.body ->> 'valid_until' AS valid_until, model.body ->> 'tip_box_max_mm' AS tip_box_max_mm,
  applied.body ->> 'hash' AS applied_model, applied.at AS applied_at, applied.body ->> 'to' AS applied_to,
  proof.at AS last_proof_at, proof.body ->> 'verdict' AS last_proof_verdict,
  checked.at AS last_check_at, checked.body ->> 'verdict' AS last_check_verdict, checked.body ->> 'cause' AS last_check_cause,
  checked.body ->> 'growth_ppm' AS last_check_growth_ppm,
  due.since AS check_due_since, due.every_days AS check_every_days,
  expiring.body ->> 'artefact' AS expiring, expiring.body ->> 'valid_until' AS expires,
  fault.body ->> 'code' AS last_fault, fault.at AS last_fault_at
FROM fleet_cell AS cells
JOIN LATERAL (SELECT at, archived_at FROM event WHERE cell = cells.cell ORDER BY seq DESC LIMIT 1) AS newest ON true
LEFT JOIN LATERAL (SELECT seq, at, run, body::json AS body FROM event WHERE cell = cells.cell AND kind = 'run_ended'
  AND coalesce(body::json ->> 'kind', 'calibration') = 'calibration' AND body::json ->> 'outcome' <> 'withdrawn'
  ORDER BY seq DESC LIMIT 1) AS ended ON true
LEFT JOIN LATERAL (SELECT at, body::json AS body FROM event WHERE cell = cells.cell AND kind = 'proof' ORDER BY seq DESC LIMIT 1) AS proof ON true
LEFT JOIN LATERAL (SELECT seq, at, body::json AS body FROM event WHERE cell = cells.cell AND kind = 'check' ORDER BY seq DESC LIMIT 1) AS checked ON true
LEFT JOIN LATERAL (SELECT seq, kind, at, run, body::json AS body FROM (
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'approved' ORDER BY seq DESC LIMIT 1)
    UNION ALL
    (SELECT * FROM event WHERE cell = cells.cell AND kind = 'rolled_back' ORDER BY seq DESC LIMIT 1)) AS both_kinds
  ORDER BY seq DESC LIMIT 1) AS model ON true
LEFT JOIN LATERAL (SELECT at, body::json AS body FROM event WHERE cell = cells.cell AND kind = 'applied' ORDER BY seq DESC LIMIT 1) AS applied ON true
LEFT JOIN LATERAL (SELECT at, body::json AS body FROM event WHERE cell = cells.cell AND kind = 'fault' ORDER BY seq DESC LIMIT 1) AS fault ON true
LEFT JOIN LATERAL (SELECT seq FROM event WHERE cell = cells.cell AND kind = 'run_started' ORDER BY seq DESC LIMIT 1) AS started ON true
LEFT JOIN LATERAL (SELECT seq FROM event WHERE cell = cells.cell AND kind = 'run_ended' ORDER BY seq DESC LIMIT 1) AS any_ended ON true
-- Of those that were not renewed since, the first that ends.
LEFT JOIN LATERAL (SELECT body FROM (SELECT DISTINCT ON (body::json ->> 'artefact') kind, body::json AS body FROM event
    WHERE cell = cells.cell AND kind IN ('certificate_expiring', 'certificate_renewed') ORDER BY body::json ->> 'artefact', seq DESC) AS last_told
  WHERE kind = 'certificate_expiring' ORDER BY body ->> 'valid_until' LIMIT 1) AS expiring ON true
LEFT JOIN LATERAL (SELECT run, body::jsonb AS body FROM event WHERE cell = cells.cell AND kind = 'approved'
  AND body::json ->> 'hash' = model.body ->> 'current' ORDER BY seq DESC LIMIT 1) AS approval ON true
-- As the cell counts it: checks are of the model that is approved, and without one of the last calibration that was accepted.
LEFT JOIN LATERAL (
  SELECT checked.at AS since, checked.body ->> 'every_days' AS every_days
  WHERE CASE WHEN approval.run IS NOT NULL THEN checked.body ->> 'of_run' = approval.run::text
    ELSE checked.seq > coalesce(ended.seq, 0) OR ended.body ->> 'verdict' <> 'accepted' END
  UNION ALL
  -- The first one. Approvals of older daemons do not say how often; a check of the model before may.
  SELECT CASE WHEN ended.run = approval.run THEN ended.at ELSE model.at END,
    CASE WHEN approval.body ? 'every_days' THEN approval.body ->> 'every_days' ELSE checked.body ->> 'every_days' END
  WHERE model.kind = 'approved' AND approval.run IS NOT NULL AND coalesce(checked.seq, 0) < model.seq
    AND checked.body ->> 'of_run' IS DISTINCT FROM approval.run::text) AS due ON true;

GRANT SELECT ON fleet_cell, fleet TO touchcal_writer, touchcal_quality;
)sql";

constexpr std::array kArchiveMigrations{kEventsAndDocuments};

}  // namespace

int newest_archive_schema() { return static_cast<int>(kArchiveMigrations.size()); }

int archive_version(pqxx::transaction_base& transaction) {
  if (!transaction.exec1("SELECT to_regclass('touchcal_schema') IS NOT NULL")[0].as<bool>()) return 0;
  return transaction.exec1("SELECT coalesce(max(version), 0) FROM touchcal_schema")[0].as<int>();
}

void refuse_newer_archive(int version) {
  if (version > newest_archive_schema())
    throw ArchiveRefused(fmt::format(
        "the archive was prepared by a newer touchcal (schema {}, this one knows {}); install that version",
        version, newest_archive_schema()));
}

std::string prepare_archive(const std::string& url) try {
  pqxx::connection connection(with_archive_bounds(url));
  pqxx::work transaction(connection);
  const auto encoding = transaction.exec1("SHOW server_encoding")[0].as<std::string>();
  if (encoding != "UTF8")
    throw ArchiveRefused(
        fmt::format("the archive: this database has the encoding {}, and facts are UTF-8; make another: "
                    "CREATE DATABASE touchcal "
                    "ENCODING 'UTF8' LOCALE 'C.UTF-8' TEMPLATE template0",
                    encoding));
  transaction.exec0(
      "CREATE TABLE IF NOT EXISTS touchcal_schema(version integer PRIMARY KEY, at timestamptz NOT NULL "
      "DEFAULT "
      "now())");
  transaction.exec0("LOCK TABLE touchcal_schema IN EXCLUSIVE MODE");
  const int before = archive_version(transaction);
  refuse_newer_archive(before);
  for (int next = before; next < newest_archive_schema(); ++next) {
    transaction.exec0(kArchiveMigrations.at(static_cast<std::size_t>(next)));
    transaction.exec_params0("INSERT INTO touchcal_schema(version) VALUES($1)", next + 1);
  }
  transaction.exec0(kForReaders);
  transaction.exec0(kArchiveGuards);
  transaction.exec0(kViews);
  transaction.commit();
  return before == newest_archive_schema()
             ? fmt::format("the archive has schema {} already", before)
             : fmt::format("the archive has schema {} now", newest_archive_schema());
} catch (const pqxx::insufficient_privilege& error) {
  throw ArchiveRefused(fmt::format("the archive could not be prepared: {}", error.what()));
} catch (const pqxx::failure& error) {
  throw std::runtime_error(fmt::format("the archive could not be prepared: {}", error.what()));
}

}  // namespace cell
