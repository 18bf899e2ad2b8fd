#include "service/archive/archive_schema.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <pqxx/pqxx>
#include <stdexcept>

#include "service/archive/archive_options.hpp"
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

/// For what asks all cells at once: an index, and that no cell can write what a query of all of them would
/// break on (texts that are no times or numbers where there should be some, bodies that are no objects or
/// have no end). What a daemon writes is as it should be, so that this has no version of its own.
constexpr const char* kForReaders = R"sql(
CREATE INDEX IF NOT EXISTS event_by_time ON event(kind, at);
SET LOCAL lock_timeout = '10s';
ALTER TABLE event DROP CONSTRAINT IF EXISTS can_be_read;
ALTER TABLE event ADD CONSTRAINT can_be_read CHECK (
  octet_length(body) <= 1048576 AND octet_length(at) <= 40 AND octet_length(kind) <= 40
  AND at::timestamptz IS NOT NULL AND jsonb_typeof(body::jsonb) = 'object'
  AND coalesce((body::jsonb ->> 'valid_until')::timestamptz, 'epoch') IS NOT NULL
  AND coalesce((body::jsonb ->> 'tip_box_max_mm')::double precision, 0) IS NOT NULL
  AND coalesce((body::jsonb ->> 'growth_ppm')::double precision, 0) IS NOT NULL) NOT VALID;
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
    throw std::runtime_error(fmt::format(
        "the archive was prepared by a newer touchcal (schema {}, this one knows {}); install that version",
        version, newest_archive_schema()));
}

std::string prepare_archive(const std::string& url) try {
  pqxx::connection connection(with_archive_bounds(url));
  pqxx::work transaction(connection);
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
  transaction.commit();
  return before == newest_archive_schema()
             ? fmt::format("the archive has schema {} already", before)
             : fmt::format("the archive has schema {} now", newest_archive_schema());
} catch (const pqxx::failure& error) {
  throw std::runtime_error(fmt::format("the archive could not be prepared: {}", error.what()));
}

}  // namespace cell
