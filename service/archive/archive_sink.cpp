#include "service/archive/archive_sink.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <pqxx/pqxx>
#include <utility>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/internal/archive_version.hpp"
#include "service/archive/internal/patience.hpp"
#include "service/base/digest.hpp"
#include "service/documents/words.hpp"
#include "service/store/run_store.hpp"

namespace cell {
namespace {

using CellClock = std::function<std::chrono::system_clock::time_point()>;

/// The text of a server ends with its own line break.
std::string first_line_of(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Its words go on where the library throws: of whatever kind, the connection is not used any more.
template <class Work>
auto told(const Work& work) {
  try {
    return work();
  } catch (const pqxx::failure& error) {
    throw SinkTrouble(fmt::format("the archive: {}", first_line_of(error.what())));
  }
}

class ArchiveSink final : public Sink {
 public:
  ArchiveSink(const std::string& url, std::string cell, const std::filesystem::path& store,
              std::chrono::milliseconds patience, const std::stop_token& ending, CellClock clock)
      : cell_(std::move(cell)),
        store_(RunStore::reader(store)),
        patience_(patience),
        clock_(std::move(clock)),
        connection_(with_archive_bounds(url) + "&application_name=touchcald") {
    connection_.prepare("kept", "SELECT coalesce(max(seq), 0) FROM event WHERE cell = $1");
    within_patience(ending, [&] {
      pqxx::work transaction(connection_);
      demand_schema(transaction);
      kept_ = kept(transaction);
    });
    connection_.prepare("event",
                        "INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256) "
                        "VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT DO NOTHING");
    connection_.prepare("known", "SELECT sha256 FROM event WHERE cell = $1 AND seq = $2");
    connection_.prepare("document",
                        "INSERT INTO document(sha256, body) VALUES($1, $2) ON CONFLICT DO NOTHING");
    connection_.prepare(
        "touch",
        "INSERT INTO touch(cell, seq, run, number, plane, role, joints_microdeg, captured_at) "
        "VALUES($1, $2, $3, $4, $5, $6, $7, $8) ON CONFLICT DO NOTHING");
  }

  std::int64_t deliver(std::span<const Fact> facts, std::stop_token ending) override {
    within_patience(ending, [&] {
      pqxx::work transaction(connection_);
      demand_what_was_kept(transaction);
      for (const Fact& fact : facts) {
        archive(transaction, fact);
        if (fact.kind == fact_kind_name(FactKind::kTouchSetClosed) && fact.run_id)
          archive_run(transaction, fact.seq, *fact.run_id);
      }
      compare_clocks(transaction);
      transaction.commit();
    });
    kept_ = std::max(kept_, facts.back().seq);
    return facts.back().seq;
  }

  /// A connection that broke off shows with the next fact; until then nothing is lost.
  void rest(std::chrono::milliseconds time, std::stop_token ending) override {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    ended.wait_for(lock, std::move(ending), time, [] { return false; });
  }

  [[nodiscard]] std::optional<std::int64_t> last_kept() const override { return kept_; }
  [[nodiscard]] std::optional<std::string> remark() const override { return remark_; }

 private:
  template <class Work>
  void within_patience(const std::stop_token& ending, const Work& work) {
    const Patience patience(connection_, patience_, ending);
    try {
      work();
    } catch (const pqxx::failure&) {
      if (!patience.is_over()) throw;
      throw SinkTrouble(fmt::format("the archive has not answered in {:.3g} s; its tables may be locked",
                                    std::chrono::duration<double>(patience_).count()));
    }
  }

  void demand_schema(pqxx::work& transaction) {
    const int version = archive_version(transaction);
    refuse_newer_archive(version);
    if (version < newest_archive_schema())
      throw SinkTrouble(
          "the archive is not prepared for this version; its owner runs touchcal archive prepare --archive "
          "URL");
    compare_clocks(transaction);
  }

  /// The archive is the one in the plant that has a clock of its own.
  void compare_clocks(pqxx::work& transaction) {
    if (!clock_) return;
    using Seconds = std::chrono::duration<double>;
    const Seconds theirs(transaction.exec1("SELECT extract(epoch FROM clock_timestamp())")[0].as<double>());
    const Seconds ahead = clock_().time_since_epoch() - theirs;
    remark_.reset();
    if (std::abs(ahead.count()) <= Seconds(kClocksApartMax).count()) return;
    constexpr double kSecondsAnHour = 3600;
    remark_ = fmt::format(
        "this machine's clock is {:.1f} h {} that of the archive; set the wrong one right: facts carry the "
        "time of this machine",
        std::abs(ahead.count()) / kSecondsAnHour, ahead.count() > 0 ? "ahead of" : "behind");
  }

  std::int64_t kept(pqxx::work& transaction) {
    return transaction.exec_prepared1("kept", cell_)[0].as<std::int64_t>();
  }

  /// Another connection begins from what is there.
  void demand_what_was_kept(pqxx::work& transaction) {
    if (const std::int64_t now = kept(transaction); now < kept_)
      throw SinkTrouble(
          fmt::format("the archive has lost what it had kept behind event {} of cell {}", now, cell_));
  }

  void archive(pqxx::work& transaction, const Fact& fact) {
    const std::string run = fact.run_id ? std::to_string(*fact.run_id) : std::string();
    const auto written = transaction.exec_prepared0("event", cell_, fact.seq, fact.instance, fact.kind,
                                                    fact.at, fact.run_id ? run.c_str() : nullptr,
                                                    fact.previous, fact.body, fact.sha256);
    if (written.affected_rows() > 0) return;
    const auto known = transaction.exec_prepared1("known", cell_, fact.seq)[0].as<std::string>();
    if (known != fact.sha256)
      throw SinkTrouble(fmt::format(
          "the archive has another event {} of cell {}: two cells have this name, or the cell's database was "
          "restored from a backup; give the cell a new name, or its own name its own database",
          fact.seq, cell_));
  }

  /// As the run is now: a change since is another fact, with these again.
  void archive_run(pqxx::work& transaction, std::int64_t seq, std::int64_t run) {
    if (!store_->run(run)) return;
    for (const auto& text : {store_->result_json(run), store_->arm_json(run), store_->plan_json(run)})
      if (text) transaction.exec_prepared0("document", sha256_hex(*text), *text);
    for (const StoredTouch& touch : store_->touches(run)) {
      std::string joints;
      for (const auto joint : touch.joints) joints += (joints.empty() ? "{" : ",") + std::to_string(joint);
      transaction.exec_prepared0("touch", cell_, seq, run, touch.number, touch.plane,
                                 std::string(word_of(touch.role)), joints + "}", touch.captured_at);
    }
  }

  std::string cell_;
  std::unique_ptr<const RunStore> store_;
  std::chrono::milliseconds patience_;
  std::int64_t kept_ = 0;  // the last event of the cell that is there
  CellClock clock_;
  std::optional<std::string> remark_;
  pqxx::connection connection_;
};

/// The same, whose troubles are told.
class ToldArchive final : public Sink {
 public:
  ToldArchive(const std::string& url, const std::string& cell, const std::filesystem::path& store,
              std::chrono::milliseconds patience, const std::stop_token& ending, const CellClock& clock)
      : sink_(
            told([&] { return std::make_unique<ArchiveSink>(url, cell, store, patience, ending, clock); })) {}
  std::int64_t deliver(std::span<const Fact> facts, std::stop_token ending) override {
    return told([&] { return sink_->deliver(facts, ending); });
  }
  void rest(std::chrono::milliseconds time, std::stop_token ending) override { sink_->rest(time, ending); }
  [[nodiscard]] std::optional<std::int64_t> last_kept() const override { return sink_->last_kept(); }
  [[nodiscard]] std::optional<std::string> remark() const override { return sink_->remark(); }

 private:
  std::unique_ptr<ArchiveSink> sink_;
};

}  // namespace

std::unique_ptr<Sink> connect_archive(const std::string& url, const std::string& cell,
                                      const std::filesystem::path& store, const std::stop_token& ending,
                                      std::chrono::milliseconds patience, const CellClock& clock) {
  return std::make_unique<ToldArchive>(url, cell, store, patience, ending, clock);
}

}  // namespace cell
