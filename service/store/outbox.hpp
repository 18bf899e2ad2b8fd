#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// What others than this cell must hear of.
enum class FactKind {
  kRunStarted,
  kRunEnded,        // also one that was withdrawn before anybody was told of it
  kTouchSetClosed,  // the touches of a run that ended, its result and its arm, by their digests; again when
                    // a late touch changes them
  kApproved,        // a model became the cell's
  kRolledBack,      // it was taken back
  kFault,
  kCertificateExpiring,
  kProof,  // a proof came to its end, and what it found; likewise
  kCheck,
  kApplied,             // what the cell's model corrects is in use at the robot
  kCertificateRenewed,  // one that was told to end soon does not: it was replaced, or the clock stood ahead
};
inline constexpr std::size_t kFactKindCount = 11;

std::string_view fact_kind_name(FactKind kind);  // "run_started"

/// A row of the outbox, written in the same transaction as what it tells of. Rows are never changed.
struct Fact {
  std::int64_t seq = 0;       // from 1, without a gap; never used again
  std::int64_t instance = 0;  // count of the daemon's starts: which of them wrote it
  std::string kind;           // fact_kind_name()
  std::string at;             // RFC 3339, by the cell's clock
  std::optional<std::int64_t> run_id;
  std::string previous;  // sha256 of the fact before; empty for the first
  std::string body;      // a JSON object: fact_body.cpp has its keys
  std::string sha256;    // fact_digest()

  bool operator==(const Fact&) const = default;
};

/// SHA-256 of `previous`, seq, instance, kind, at, run (a number or nothing) and body, each as its length in
/// bytes, a colon and its text: whoever has a fact can check it, and that the one before is the one it was.
std::string fact_digest(const Fact& fact);

/// The artefact whose certificate ends soon, or has ended.
struct ExpiringCertificate {
  std::string artefact;     // "block"
  std::string valid_until;  // as its file says it

  bool operator==(const ExpiringCertificate&) const = default;
};

/// How far a sink has come.
struct SinkCursor {
  std::string sink;
  std::int64_t seq = 0;  // confirmed up to here

  bool operator==(const SinkCursor&) const = default;
};

/// The facts after a number.
struct Backlog {
  std::int64_t count = 0;
  std::optional<std::string> oldest_at;

  bool operator==(const Backlog&) const = default;
};

/// What is written of the outbox besides the facts, on the store's thread. A call is all or nothing and
/// throws what the database throws.
class Outbox {
 public:
  explicit Outbox(SharedDatabase database) : database_(std::move(database)) {}

  /// One more start of the daemon, which the facts from now on carry; returns its count.
  std::int64_t begin_instance();
  /// The sink has confirmed all up to `seq`. Less than it has confirmed already changes nothing. Durable with
  /// the next touch: what a crash takes back is sent again.
  void confirm(const std::string& sink, std::int64_t seq);
  /// Tells of each once: nothing where this certificate was told of before. One that does not expire any more
  /// is told of again when it does: it was replaced, or a clock that stood ahead has told of it too early.
  void tell_expiring(const std::vector<ExpiringCertificate>& expiring, const std::string& at);

 private:
  SharedDatabase database_;
};

/// Reads the outbox over a connection of its own, so that another thread may have it.
class OutboxReader {
 public:
  /// A file that open_database() has opened. Throws std::runtime_error that names it.
  explicit OutboxReader(const std::filesystem::path& file);

  /// The oldest `limit` facts after `seq`, which a power failure does not take back any more: a number that
  /// was told must not come again with another fact. Throws DamagedStore for a fact that is not as it was
  /// written, and where one between two others is gone. Those before the first may have been deleted.
  [[nodiscard]] std::vector<Fact> next(std::int64_t after, int limit) const;
  /// 0 for a sink that never confirmed anything.
  [[nodiscard]] std::int64_t cursor(const std::string& sink) const;
  /// The count of the daemon's starts.
  [[nodiscard]] std::int64_t instance() const;
  [[nodiscard]] Backlog backlog(std::int64_t after) const;
  /// Of the same connection, for what goes with a fact.
  [[nodiscard]] const SharedDatabase& database() const { return database_; }

 private:
  SharedDatabase database_;
};

/// Without a sink so many of the last facts stay, in case one is configured later.
inline constexpr std::int64_t kFactsKeptWithoutSink = 100'000;

inline constexpr std::int64_t kFactsDeletedAtOnce = 5000;

/// The number up to which all `sinks` have confirmed; the largest there is where there is no sink.
std::int64_t confirmed_by_all(SQLite::Database& database, const std::vector<std::string>& sinks);

/// From when on facts are kept, as one clock says it; times as in format_utc().
struct FactsKept {
  std::string oldest;
  std::string now;
  int days_that_agree = 0;  // as in delete_runs_before()
};

/// Deletes the facts that all `sinks` have confirmed and that are older than what is kept (nothing: however
/// old, none); returns how many. No clock is believed alone: where facts were written on fewer than
/// `days_that_agree` days from `oldest` to `now`, none is deleted for its age. Those from behind `now` were
/// written with a clock that stood ahead, and keep nothing. Where there is no sink, also those before the
/// last `kept` go. At most `most` at once: who writes a touch waits meanwhile.
std::int64_t delete_facts(const SharedDatabase& database, const std::vector<std::string>& sinks,
                          const std::optional<FactsKept>& since, std::int64_t kept = kFactsKeptWithoutSink,
                          std::int64_t most = kFactsDeletedAtOnce);

/// Facts that do not follow from the one before, or are gone, a line each. Of a file of kOutboxSchema or
/// later.
std::vector<std::string> find_outbox_damage(SQLite::Database& database);

}  // namespace cell
