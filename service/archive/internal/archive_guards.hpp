#pragma once

namespace cell {

/// What a cell may write, beside its own name: an archive of fifty cells is read as a whole, and none of them
/// may break that for the others. No times or numbers that a query would stop at, nothing without end, in no
/// writing that depends on the settings of who writes or reads; when a row arrived only the archive says.
/// What a daemon writes is as it should be, so that this has no version of its own. Rows that are there are
/// not looked at.
inline constexpr const char* kArchiveGuards = R"sql(
ALTER TABLE event DROP CONSTRAINT IF EXISTS can_be_read;
ALTER TABLE event ADD CONSTRAINT can_be_read CHECK (
  octet_length(body) <= 1048576 AND octet_length(at) <= 40 AND octet_length(kind) <= 40 AND isfinite(archived_at)
  AND at ~ '^\d{4}-\d\d-\d\d(T\d\d:\d\d:\d\d(\.\d{1,6})?Z)?$' AND at::timestamptz IS NOT NULL
  AND jsonb_typeof(body::jsonb) = 'object'
  AND coalesce(body::jsonb ->> 'valid_until', '2000-01-01') ~ '^\d{4}-\d\d-\d\d(T\d\d:\d\d:\d\d(\.\d{1,6})?Z)?$'
  AND coalesce((body::jsonb ->> 'valid_until')::timestamptz, 'epoch') IS NOT NULL
  AND coalesce((body::jsonb ->> 'tip_box_max_mm')::double precision, 0) IS NOT NULL
  AND coalesce((body::jsonb ->> 'rms_mm')::double precision, 0) IS NOT NULL
  AND coalesce((body::jsonb ->> 'growth_ppm')::double precision, 0) IS NOT NULL) NOT VALID;
ALTER TABLE document DROP CONSTRAINT IF EXISTS has_an_end;
ALTER TABLE document ADD CONSTRAINT has_an_end CHECK (octet_length(body) <= 16777216) NOT VALID;
ALTER TABLE touch DROP CONSTRAINT IF EXISTS can_be_read;
ALTER TABLE touch ADD CONSTRAINT can_be_read CHECK (
  octet_length(role) <= 40 AND captured_at ~ '^(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,6})?Z)?$'
  AND coalesce(nullif(captured_at, '')::timestamptz, 'epoch') IS NOT NULL) NOT VALID;
REVOKE INSERT ON event FROM touchcal_writer;
GRANT INSERT(cell, seq, instance, kind, at, run, previous, body, sha256) ON event TO touchcal_writer;
-- Under its own name: who puts on the role of all writers is none of them.
ALTER POLICY own_events ON event WITH CHECK (cell = current_user AND current_user = session_user);
ALTER POLICY own_touches ON touch WITH CHECK (cell = current_user AND current_user = session_user);
DO $$ BEGIN
  EXECUTE format('REVOKE TEMPORARY ON DATABASE %I FROM PUBLIC', current_database());
END $$;
)sql";

}  // namespace cell
