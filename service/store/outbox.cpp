#include "service/store/outbox.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <set>
#include <stdexcept>

#include "service/base/digest.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/internal/fact.hpp"
#include "service/store/internal/lock_wait.hpp"
#include "service/store/internal/relaxed_durability.hpp"
#include "service/store/internal/row_text.hpp"
#include "service/store/internal/touch_change.hpp"

namespace cell {
namespace {

constexpr std::array<std::string_view, kFactKindCount> kFactKindNames{
    "run_started", "run_ended", "touch_set_closed",     "approved",
    "rolled_back", "fault",     "certificate_expiring", "proof",
    "check",       "applied",   "certificate_renewed"};

/// The number of the last fact that was ever written; it outlives the fact.
std::int64_t last_fact(SQLite::Database& database) {
  SQLite::Statement query(database,
                          "SELECT coalesce(max(seq), 0) FROM sqlite_sequence WHERE name = 'outbox'");
  query.executeStep();
  return query.getColumn(0).getInt64();
}

std::int64_t instance_in(SQLite::Database& database) {
  return database.execAndGet("SELECT instance FROM outbox_state").getInt64();
}

std::int64_t cursor_in(SQLite::Database& database, const std::string& sink) {
  SQLite::Statement query(database, "SELECT seq FROM delivered WHERE sink = ?");
  query.bind(1, sink);
  return query.executeStep() ? query.getColumn(0).getInt64() : 0;
}

/// The number behind which facts are kept; 0 where the clock is not believed.
std::int64_t last_old_fact(SQLite::Database& database, const FactsKept& since) {
  SQLite::Statement kept(database,
                         "SELECT seq, substr(at, 1, 10) FROM outbox WHERE at >= ? AND at <= ? ORDER BY seq");
  kept.bind(1, since.oldest);
  kept.bind(2, since.now);
  std::optional<std::int64_t> first;
  std::set<std::string> days;
  // As far as it takes: there may be a million of one day.
  while (!first || std::ssize(days) < since.days_that_agree) {
    if (!kept.executeStep()) break;
    if (!first) first = kept.getColumn(0).getInt64();
    days.insert(kept.getColumn(1).getString());
  }
  if (std::ssize(days) < since.days_that_agree) return 0;
  return first ? *first - 1 : last_fact(database);
}

/// Facts may have been written with relaxed durability. What is read was written to the log or, if that has
/// gone into the file since, synced by who put it there.
void sync_log(const std::string& file) {
  const int log = ::open((file + "-wal").c_str(), O_RDONLY | O_CLOEXEC);
  if (log < 0) {
    if (errno == ENOENT) return;  // all is in the file
    throw std::runtime_error(fmt::format("{}-wal: {}", file, std::strerror(errno)));
  }
  const bool synced = ::fdatasync(log) == 0;
  const int error = errno;
  ::close(log);
  if (!synced) throw std::runtime_error(fmt::format("{}-wal: {}", file, std::strerror(error)));
}

}  // namespace

std::string_view fact_kind_name(FactKind kind) { return kFactKindNames.at(static_cast<std::size_t>(kind)); }

std::string fact_digest(const Fact& fact) {
  std::string text;
  for (const std::string& field :
       {fact.previous, std::to_string(fact.seq), std::to_string(fact.instance), fact.kind, fact.at,
        fact.run_id ? std::to_string(*fact.run_id) : std::string(), fact.body})
    text += std::to_string(field.size()) + ":" + field;
  return sha256_hex(text);
}

namespace row {

Fact fact_in(SQLite::Statement& row) {
  const SQLite::Column run = row.getColumn(4);
  return {.seq = row.getColumn(0).getInt64(),
          .instance = row.getColumn(1).getInt64(),
          .kind = row.getColumn(2).getString(),
          .at = row.getColumn(3).getString(),
          .run_id = run.isNull() ? std::nullopt : std::optional(run.getInt64()),
          .previous = row.getColumn(5).getString(),
          .body = row.getColumn(6).getString(),
          .sha256 = row.getColumn(7).getString()};
}

void append_fact(SQLite::Database& database, const NewFact& told) {
  SQLite::Statement state(database, "SELECT instance, newest FROM outbox_state");
  if (!state.executeStep())
    throw DamagedStore(database.getFilename(), "table outbox_state", "its row is not there");
  Fact fact{.seq = last_fact(database) + 1,
            .instance = state.getColumn(0).getInt64(),
            .kind = std::string(fact_kind_name(told.kind)),
            .at = told.at,
            .run_id = told.run_id,
            .previous = state.getColumn(1).getString(),
            .body = told.body,
            .sha256 = {}};
  state.reset();
  fact.sha256 = fact_digest(fact);
  SQLite::Statement insert(
      database, std::string("INSERT INTO outbox(") + kFactColumns + ") VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, fact.seq);
  insert.bind(2, fact.instance);
  insert.bind(3, fact.kind);
  insert.bind(4, fact.at);
  if (fact.run_id) insert.bind(5, *fact.run_id);
  insert.bind(6, fact.previous);
  insert.bind(7, fact.body);
  insert.bind(8, fact.sha256);
  insert.exec();
  SQLite::Statement newest(database, "UPDATE outbox_state SET newest = ?");
  newest.bind(1, fact.sha256);
  newest.exec();
}

}  // namespace row

std::int64_t Outbox::begin_instance() {
  row::WriteTransaction transaction(*database_);
  database_->exec("UPDATE outbox_state SET instance = instance + 1");
  const std::int64_t instance = instance_in(*database_);
  transaction.commit();
  return instance;
}

void Outbox::confirm(const std::string& sink, std::int64_t seq) {
  const RelaxedDurability unsynced(*database_);
  SQLite::Statement write(*database_,
                          "INSERT INTO delivered(sink, seq) VALUES(?1, ?2) ON CONFLICT(sink) DO UPDATE SET "
                          "seq = max(seq, excluded.seq)");
  write.bind(1, sink);
  write.bind(2, seq);
  write.exec();
}

void Outbox::tell_expiring(const std::vector<ExpiringCertificate>& expiring, const std::string& at) {
  row::WriteTransaction transaction(*database_);
  std::vector<ExpiringCertificate> told;
  SQLite::Statement query(*database_, "SELECT artefact, valid_until FROM told_certificates");
  while (query.executeStep())
    told.push_back({query.getColumn(0).getString(), query.getColumn(1).getString()});
  query.reset();
  const auto write = [&](const char* sql, const ExpiringCertificate& certificate) {
    SQLite::Statement change(*database_, sql);
    change.bind(1, certificate.artefact);
    change.bind(2, certificate.valid_until);
    change.exec();
  };
  for (const ExpiringCertificate& one : told) {
    if (std::ranges::find(expiring, one) != expiring.end()) continue;
    write("DELETE FROM told_certificates WHERE artefact = ? AND valid_until = ?", one);
    if (std::ranges::find(expiring, one.artefact, &ExpiringCertificate::artefact) == expiring.end())
      row::append_fact(*database_,
                       {FactKind::kCertificateRenewed, at, std::nullopt, row::certificate_body(one)});
  }
  for (const ExpiringCertificate& one : expiring) {
    if (std::ranges::find(told, one) != told.end()) continue;
    write("INSERT INTO told_certificates(artefact, valid_until) VALUES(?, ?)", one);
    row::append_fact(*database_,
                     {FactKind::kCertificateExpiring, at, std::nullopt, row::certificate_body(one)});
  }
  transaction.commit();
}

OutboxReader::OutboxReader(const std::filesystem::path& file) : database_(open_database_to_read(file)) {}

std::vector<Fact> OutboxReader::next(std::int64_t after, int limit) const {
  SQLite::Statement query(*database_, std::string("SELECT ") + row::kFactColumns +
                                          " FROM outbox WHERE seq > ? ORDER BY seq LIMIT ?");
  query.bind(1, after);
  query.bind(2, limit);
  std::vector<Fact> facts;
  while (query.executeStep()) {
    Fact fact = row::fact_in(query);
    if (fact.sha256 != fact_digest(fact))
      throw DamagedStore(database_->getFilename(), "table outbox, number " + std::to_string(fact.seq),
                         row::kOtherChecksum);
    if (!facts.empty() && (fact.seq != facts.back().seq + 1 || fact.previous != facts.back().sha256))
      throw DamagedStore(database_->getFilename(), "table outbox, number " + std::to_string(fact.seq),
                         "the fact before it is not there, or another one");
    facts.push_back(std::move(fact));
  }
  if (!facts.empty()) sync_log(database_->getFilename());
  return facts;
}

std::int64_t OutboxReader::cursor(const std::string& sink) const { return cursor_in(*database_, sink); }

std::int64_t OutboxReader::instance() const { return instance_in(*database_); }

Backlog OutboxReader::backlog(std::int64_t after) const {
  // There is no gap behind the oldest: a million are not counted one by one.
  SQLite::Statement query(*database_,
                          "SELECT seq, at, (SELECT max(seq) FROM outbox) FROM outbox WHERE seq > ? ORDER BY "
                          "seq LIMIT 1");
  query.bind(1, after);
  if (!query.executeStep()) return {};
  return {.count = query.getColumn(2).getInt64() - query.getColumn(0).getInt64() + 1,
          .oldest_at = query.getColumn(1).getString()};
}

std::int64_t confirmed_by_all(SQLite::Database& database, const std::vector<std::string>& sinks) {
  std::int64_t passed = INT64_MAX;
  for (const std::string& sink : sinks) passed = std::min(passed, cursor_in(database, sink));
  return passed;
}

std::int64_t delete_facts(const SharedDatabase& database, const std::vector<std::string>& sinks,
                          const std::optional<FactsKept>& since, std::int64_t kept, std::int64_t most) {
  row::WriteTransaction transaction(*database);
  const std::int64_t first = database->execAndGet("SELECT coalesce(min(seq), 0) FROM outbox").getInt64();
  const std::int64_t end = std::min(confirmed_by_all(*database, sinks), first + most - 1);
  if (end < first) return 0;
  // The first that is not old enough stays, with all behind it: what is left has no gap.
  std::int64_t last = since ? last_old_fact(*database, *since) : 0;
  if (sinks.empty()) last = std::max(last, last_fact(*database) - kept);
  last = std::min(last, end);
  if (last < first) return 0;
  SQLite::Statement drop(*database, "DELETE FROM outbox WHERE seq <= ?");
  drop.bind(1, last);
  const int deleted = drop.exec();
  transaction.commit();
  return deleted;
}

std::vector<std::string> find_outbox_damage(SQLite::Database& database) {
  SQLite::Statement query(database, std::string("SELECT ") + row::kFactColumns + " FROM outbox ORDER BY seq");
  std::optional<Fact> before;
  while (query.executeStep()) {
    Fact fact = row::fact_in(query);
    const bool follows = !before || (fact.seq == before->seq + 1 && fact.previous == before->sha256);
    if (!follows || fact.sha256 != fact_digest(fact))
      return {"outbox, row " + std::to_string(fact.seq) +
              ": it was changed or put in, or a row before it was taken out"};
    before = std::move(fact);
  }
  SQLite::Statement state(database, "SELECT newest FROM outbox_state");
  if (!state.executeStep()) return {"table outbox_state: its row is not there"};
  if (before && (before->seq != last_fact(database) || before->sha256 != state.getColumn(0).getString()))
    return {"outbox, row " + std::to_string(before->seq) + ": rows behind it were taken out"};
  return {};
}

}  // namespace cell
