#include "service/archive/archive_sink.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <pqxx/pqxx>
#include <utility>
#include <vector>

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

/// As an array of PostgreSQL of a field of each touch, whose type the statement says.
template <class Field>
std::string array_of(const std::vector<StoredTouch>& touches, const Field& field) {
  std::string array;
  for (const StoredTouch& touch : touches) {
    array += array.empty() ? "{\"" : ",\"";
    for (const char letter : std::string(field(touch))) {
      if (letter == '"' || letter == '\\') array += '\\';
      array += letter;
    }
    array += '"';
  }
  return array.empty() ? "{}" : array + "}";
}

std::string array_of_joints(const StoredTouch& touch) {
  std::string joints;
  for (const auto joint : touch.joints) joints += (joints.empty() ? "{" : ",") + std::to_string(joint);
  return joints + "}";
}

/// The facts of a run that ended: its transaction.
constexpr std::size_t kFirstPart = 4, kPartMax = 128;
/// An archive that is away shows within this time also where there is no fact.
constexpr std::chrono::seconds kLookEvery{30};

class ArchiveSink final : public Sink {
 public:
  ArchiveSink(const std::string& url, std::string cell, const std::filesystem::path& store,
              std::chrono::milliseconds patience, const std::stop_token& ending, CellClock clock)
      : cell_(std::move(cell)),
        store_(RunStore::reader(store)),
        patience_(patience),
        clock_(std::move(clock)),
        connection_(with_archive_bounds(url) + "&application_name=touchcald") {
    connection_.prepare(
        "kept",
        "SELECT coalesce(max(seq), 0), extract(epoch FROM clock_timestamp()) FROM event WHERE cell = $1");
    in_transaction(ending, [&](Statements& statements) {
      demand_schema(statements);
      kept_ = kept(statements);
    });
    connection_.prepare("event",
                        "INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256) "
                        "VALUES($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT DO NOTHING");
    connection_.prepare("known", "SELECT sha256 FROM event WHERE cell = $1 AND seq = $2");
    connection_.prepare("document",
                        "INSERT INTO document(sha256, body) VALUES($1, $2) ON CONFLICT DO NOTHING");
    connection_.prepare(
        "touches",
        "INSERT INTO touch(cell, seq, run, number, plane, role, joints_microdeg, captured_at) SELECT $1, $2, "
        "$3, number, plane, role, joints::bigint[], captured_at FROM unnest($4::integer[], $5::integer[], "
        "$6::text[], $7::text[], $8::text[]) AS touch(number, plane, role, joints, captured_at) ON CONFLICT "
        "DO NOTHING");
  }

  /// In transactions that grow while the line bears them: one that breaks off now and then lets a few facts
  /// pass, each time.
  std::int64_t deliver(std::span<const Fact> facts, std::stop_token ending) override {
    demand_usable();
    std::size_t done = 0;
    while (done < facts.size()) {
      const auto part = facts.subspan(done, std::min(part_, facts.size() - done));
      try {
        deliver_part(part, ending);
      } catch (const std::exception&) {
        if (done == 0) throw;
        trouble_ = std::current_exception();  // of the next call: this one has confirmed some
        break;
      }
      done += part.size();
      part_ = std::min(2 * part_, kPartMax);
    }
    return facts[done - 1].seq;
  }

  void rest(std::chrono::milliseconds time, std::stop_token ending) override {
    demand_usable();
    if (rested_ >= kLookEvery && !ending.stop_requested()) {
      rested_ = std::chrono::milliseconds(0);
      in_transaction(ending, [&](Statements& statements) {
        demand_schema(statements);
        demand_what_was_kept(statements);
      });
    }
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    ended.wait_for(lock, std::move(ending), time, [] { return false; });
    rested_ += time;
  }

  [[nodiscard]] std::optional<std::int64_t> last_kept() const override { return kept_; }
  [[nodiscard]] std::optional<std::string> remark() const override { return remark_; }

 private:
  /// A transaction whose server has its time for each statement.
  class Statements {
   public:
    Statements(pqxx::connection& connection, Patience& patience)
        : patience_(patience), transaction_(connection) {}
    template <class... Parameters>
    pqxx::result operator()(const char* prepared, const Parameters&... parameters) {
      pqxx::result result = transaction_.exec_prepared(prepared, parameters...);
      patience_.answered();
      return result;
    }
    pqxx::work& transaction() { return transaction_; }

   private:
    Patience& patience_;
    pqxx::work transaction_;
  };

  template <class Work>
  void in_transaction(const std::stop_token& ending, const Work& work) {
    Patience patience(connection_, patience_, ending);
    try {
      Statements statements(connection_, patience);
      work(statements);
      patience.answered();
      statements.transaction().commit();
    } catch (const pqxx::failure&) {
      if (!patience.is_over()) throw;
      throw SinkTrouble(fmt::format("the archive has not answered in {:.3g} s; its tables may be locked",
                                    std::chrono::duration<double>(patience_).count()));
    }
  }

  void demand_usable() {
    if (trouble_) std::rethrow_exception(std::exchange(trouble_, nullptr));
  }

  void deliver_part(std::span<const Fact> facts, const std::stop_token& ending) {
    in_transaction(ending, [&](Statements& statements) {
      demand_what_was_kept(statements);
      for (const Fact& fact : facts) {
        archive(statements, fact);
        if (fact.kind == fact_kind_name(FactKind::kTouchSetClosed) && fact.run_id)
          archive_run(statements, fact.seq, *fact.run_id);
      }
    });
    kept_ = std::max(kept_, facts.back().seq);
  }

  void demand_schema(Statements& statements) {
    const int version = archive_version(statements.transaction());
    refuse_newer_archive(version);
    if (version < newest_archive_schema())
      throw SinkTrouble(fmt::format("the archive is not prepared for this version; {}", kPrepareIt));
  }

  /// The archive is the one in the plant that has a clock of its own.
  void compare_clocks(std::chrono::duration<double> theirs) {
    if (!clock_) return;
    using Seconds = std::chrono::duration<double>;
    const Seconds ahead = clock_().time_since_epoch() - theirs;
    remark_.reset();
    if (std::abs(ahead.count()) <= Seconds(kClocksApartMax).count()) return;
    constexpr double kSecondsAnHour = 3600;
    remark_ = fmt::format(
        "this machine's clock is {:.1f} h {} that of the archive; set the wrong one right: facts carry the "
        "time of this machine",
        std::abs(ahead.count()) / kSecondsAnHour, ahead.count() > 0 ? "ahead of" : "behind");
  }

  std::int64_t kept(Statements& statements) {
    const pqxx::result answer = statements("kept", cell_);
    compare_clocks(std::chrono::duration<double>(answer[0][1].as<double>()));
    return answer[0][0].as<std::int64_t>();
  }

  /// Another connection begins from what is there.
  void demand_what_was_kept(Statements& statements) {
    if (const std::int64_t now = kept(statements); now < kept_)
      throw SinkTrouble(
          fmt::format("the archive has lost what it had kept behind event {} of cell {}", now, cell_));
  }

  void archive(Statements& statements, const Fact& fact) {
    const std::string run = fact.run_id ? std::to_string(*fact.run_id) : std::string();
    const pqxx::result written =
        statements("event", cell_, fact.seq, fact.instance, fact.kind, fact.at,
                   fact.run_id ? run.c_str() : nullptr, fact.previous, fact.body, fact.sha256);
    if (written.affected_rows() > 0) return;
    const pqxx::result known = statements("known", cell_, fact.seq);
    if (known.empty() || known[0][0].as<std::string>() != fact.sha256)
      throw SinkTrouble(fmt::format(
          "the archive has another event {} of cell {}: two cells have this name, or the cell's database was "
          "restored from a backup; give the cell a new name, or its own name its own database",
          fact.seq, cell_));
  }

  /// As the run is now: a change since is another fact, with these again.
  void archive_run(Statements& statements, std::int64_t seq, std::int64_t run) {
    if (!store_->run(run)) return;
    for (const auto& text : {store_->result_json(run), store_->arm_json(run), store_->plan_json(run)})
      if (text) statements("document", sha256_hex(*text), *text);
    const std::vector<StoredTouch> touches = store_->touches(run);
    if (touches.empty()) return;
    statements("touches", cell_, seq, run,
               array_of(touches, [](const StoredTouch& touch) { return std::to_string(touch.number); }),
               array_of(touches, [](const StoredTouch& touch) { return std::to_string(touch.plane); }),
               array_of(touches, [](const StoredTouch& touch) { return word_of(touch.role); }),
               array_of(touches, array_of_joints),
               array_of(touches, [](const StoredTouch& touch) { return touch.captured_at; }));
  }

  std::string cell_;
  std::unique_ptr<const RunStore> store_;
  std::chrono::milliseconds patience_;
  std::int64_t kept_ = 0;  // the last event of the cell that is there
  std::size_t part_ = kFirstPart;
  std::exception_ptr trouble_;           // of the call before, which had confirmed some
  std::chrono::milliseconds rested_{0};  // since it was last asked whether it is there
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
  void rest(std::chrono::milliseconds time, std::stop_token ending) override {
    told([&] { sink_->rest(time, ending); });
  }
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
