#include "service/archive/archive_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>
#include <map>
#include <pqxx/pqxx>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "service/archive/internal/archive_reading.hpp"
#include "service/documents/archived_runs.hpp"
#include "service/documents/document_error.hpp"
#include "service/store/outbox.hpp"

namespace cell {
namespace {

Fact archived_fact(const pqxx::row& row) {
  Fact fact{.seq = row["seq"].as<std::int64_t>(),
            .instance = row["instance"].as<std::int64_t>(),
            .kind = row["kind"].as<std::string>(),
            .at = row["at"].as<std::string>(),
            .run_id = std::nullopt,
            .previous = row["previous"].as<std::string>(),
            .body = row["body"].as<std::string>(),
            .sha256 = row["sha256"].as<std::string>()};
  if (!row["run"].is_null()) fact.run_id = row["run"].as<std::int64_t>();
  return fact;
}

/// The events of a cell, so many at a time: ten years of them need no more memory than that.
constexpr int kEventsAtOnce = 10'000;

/// The fact that closed the newest set of touches of a run. Those before it were archived with what the run
/// was then.
using NewestSets = std::map<std::int64_t, Fact>;

void compare_with_the_one_before(const Fact& fact, const std::optional<Fact>& before, ArchiveDocument& look) {
  const std::string& cell = look.chains.back().cell;
  if (fact.sha256 != fact_digest(fact))
    look.damage.push_back(fmt::format("cell {}, event {}: it was changed", cell, fact.seq));
  if (before && fact.seq != before->seq + 1)
    look.damage.push_back(
        fmt::format("cell {}: events {} to {} are missing", cell, before->seq + 1, fact.seq - 1));
  else if (before ? fact.previous != before->sha256 : (fact.seq == 1) != fact.previous.empty())
    look.damage.push_back(fmt::format("cell {}, event {}: the event before is another one", cell, fact.seq));
}

/// Of the cell that the last of `look.chains` is for.
NewestSets look_at_events(pqxx::transaction_base& transaction, ArchiveDocument& look) {
  NewestSets sets;
  std::optional<Fact> before;
  for (bool is_over = false; !is_over;) {
    const pqxx::result rows = transaction.exec_params(
        "SELECT seq, instance, kind, at, run, previous, body, sha256 FROM event WHERE cell = $1 AND seq > $2 "
        "ORDER BY seq LIMIT $3",
        look.chains.back().cell, before ? before->seq : 0, kEventsAtOnce);
    is_over = rows.empty();
    for (const pqxx::row& row : rows) {
      Fact fact = archived_fact(row);
      ++look.events;
      compare_with_the_one_before(fact, before, look);
      if (!before) look.chains.back().first = fact.seq;
      if (fact.kind == fact_kind_name(FactKind::kTouchSetClosed) && fact.run_id) sets[*fact.run_id] = fact;
      before = std::move(fact);
    }
  }
  if (before) {
    look.chains.back().last = before->seq;
    look.chains.back().last_sha256 = before->sha256;
  }
  return sets;
}

/// What was found earlier is there still, with what is behind it now.
void compare_with_earlier(pqxx::transaction_base& transaction, const ArchiveDocument& earlier,
                          ArchiveDocument& look) {
  for (const ArchivedChain& was : earlier.chains) {
    const auto is = std::ranges::find(look.chains, was.cell, &ArchivedChain::cell);
    if (is == look.chains.end()) {
      look.damage.push_back(
          fmt::format("cell {}: all its events are missing, {} to {}", was.cell, was.first, was.last));
      continue;
    }
    if (is->first > was.first)
      look.damage.push_back(
          fmt::format("cell {}: events {} to {} are missing", was.cell, was.first, is->first - 1));
    if (is->last < was.last) {
      look.damage.push_back(
          fmt::format("cell {}: events {} to {} are missing", was.cell, is->last + 1, was.last));
      continue;
    }
    const pqxx::result row =
        transaction.exec_params("SELECT sha256 FROM event WHERE cell = $1 AND seq = $2", was.cell, was.last);
    if (!row.empty() && row[0][0].as<std::string>() != was.last_sha256)
      look.damage.push_back(
          fmt::format("cell {}, event {}: it is another one than earlier", was.cell, was.last));
  }
}

/// A document that the newest set of a run names.
struct NamedDocument {
  std::int64_t seq = 0;
  std::string_view key;
  std::string sha256;
};

/// As an array of texts of PostgreSQL, of what needs no quotes.
std::string array_of_digests(std::span<const NamedDocument> documents) {
  std::string array;
  for (const NamedDocument& document : documents) array += (array.empty() ? "{" : ",") + document.sha256;
  return array.empty() ? "{}" : array + "}";
}

bool is_digest(const std::string& text) {
  constexpr std::size_t kDigits = 64;
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

struct CountedTouches {
  std::int64_t count = 0;
  std::string sha256;  // as a fact's touch_rows_sha256
};

/// The touches of the cell by the number of the fact that closed their set.
std::map<std::int64_t, CountedTouches> count_touches(pqxx::transaction_base& transaction,
                                                     const std::string& cell) {
  std::map<std::int64_t, CountedTouches> counted;
  for (const pqxx::row& row :
       transaction.exec_params("SELECT seq, count(*), encode(sha256(convert_to(string_agg(number || ' ' || "
                               "plane || ' ' || role || "
                               "' ' || array_to_string(joints_microdeg, ' ') || ' ' || captured_at || "
                               "chr(10), '' ORDER BY number), "
                               "'UTF8')), 'hex') FROM touch WHERE cell = $1 GROUP BY seq",
                               cell))
    counted[row[0].as<std::int64_t>()] = {row[1].as<std::int64_t>(), row[2].as<std::string>()};
  return counted;
}

/// What the newest sets of a cell name. A body that cannot be read was changed, which is said already.
class SetsOfCell {
 public:
  SetsOfCell(std::string cell, const NewestSets& sets) : cell_(std::move(cell)) {
    for (const auto& [run, fact] : sets) {
      try {
        sets_.emplace(fact.seq, closed_touch_set_from(fact.body));
      } catch (const DocumentError&) {
        continue;
      }
    }
  }

  void look_for_documents(pqxx::transaction_base& transaction, ArchiveDocument& look) const {
    std::vector<NamedDocument> named;
    for (const auto& [seq, set] : sets_) {
      const auto name = [&](std::string_view key, const std::optional<std::string>& sha256) {
        if (sha256 && is_digest(*sha256)) named.push_back({seq, key, *sha256});
      };
      name("result_sha256", set.result_sha256);
      name("arm_sha256", set.arm_sha256);
      name("plan_sha256", set.plan_sha256);
    }
    for (const pqxx::row& row : transaction.exec_params(
             "SELECT place FROM unnest($1::text[]) WITH ORDINALITY AS named(sha256, place) WHERE NOT EXISTS "
             "(SELECT FROM document WHERE document.sha256 = named.sha256) ORDER BY place",
             array_of_digests(named))) {
      const NamedDocument& missing = named.at(row[0].as<std::size_t>() - 1);
      look.damage.push_back(fmt::format("cell {}, event {}: the document of its {} is not there", cell_,
                                        missing.seq, missing.key));
    }
  }

  void look_for_touches(pqxx::transaction_base& transaction, ArchiveDocument& look) const {
    const auto counted = count_touches(transaction, cell_);
    for (const auto& [seq, set] : sets_) {
      if (!set.touches) continue;
      const auto found = counted.find(seq);
      const CountedTouches there = found == counted.end() ? CountedTouches{} : found->second;
      if (there.count != *set.touches)
        look.damage.push_back(fmt::format("cell {}, event {}: {} touches are there, of {}", cell_, seq,
                                          there.count, *set.touches));
      else if (there.count > 0 && set.touch_rows_sha256 && there.sha256 != *set.touch_rows_sha256)
        look.damage.push_back(fmt::format("cell {}, event {}: its touches were changed", cell_, seq));
    }
  }

 private:
  std::string cell_;
  std::map<std::int64_t, ClosedTouchSet> sets_;  // by the number of the fact
};

ArchivedFact told_fact(const pqxx::row& row) {
  return {.seq = row["seq"].as<std::int64_t>(),
          .kind = row["kind"].as<std::string>(),
          .at = row["at"].as<std::string>(),
          .run_id = text_or_none(row["run"]),
          .body = {row["body"].as<std::string>()}};
}

/// Of the runs that a cell began before another, the newest, and from which fact on they are told.
constexpr const char* kNewestRuns = R"sql(
SELECT run, seq FROM event WHERE cell = $1 AND kind = 'run_started' AND run < $2 ORDER BY seq DESC LIMIT $3)sql";
constexpr const char* kFactsOfRuns = R"sql(
SELECT seq, kind, at, run, body FROM event WHERE cell = $1 AND seq >= $2 AND run = ANY($3::bigint[]) ORDER BY seq)sql";

}  // namespace

ArchiveDocument look_at_archive(const std::string& url, const ArchiveLook& how) {
  return reading(url, {}, [&](pqxx::transaction_base& transaction) {
    ArchiveDocument look;
    for (const pqxx::row& row : transaction.exec("SELECT DISTINCT cell FROM event ORDER BY cell")) {
      ++look.cells;
      look.chains.push_back({.cell = row[0].as<std::string>()});
      const SetsOfCell sets(look.chains.back().cell, look_at_events(transaction, look));
      sets.look_for_documents(transaction, look);
      if (how.touches) sets.look_for_touches(transaction, look);
    }
    for (const pqxx::row& row : transaction.exec("SELECT sha256 FROM document WHERE sha256 <> "
                                                 "encode(sha256(convert_to(body, 'UTF8')), 'hex') ORDER "
                                                 "BY sha256"))
      look.damage.push_back(fmt::format("document {}: it was changed", row[0].as<std::string>()));
    if (how.earlier) compare_with_earlier(transaction, *how.earlier, look);
    return look;
  });
}

HistoryDocument history_of(const std::string& url, const std::string& cell, int limit,
                           std::optional<std::int64_t> before) {
  return reading(url, {}, [&](pqxx::transaction_base& transaction) {
    // One more than is shown tells whether there are older ones.
    const pqxx::result rows = transaction.exec_params(
        "SELECT seq, kind, at, run, body FROM event WHERE cell = $1 AND seq < $2 ORDER BY seq DESC LIMIT $3",
        cell, before.value_or(std::numeric_limits<std::int64_t>::max()), limit + 1);
    HistoryDocument history{.cell = cell};
    for (const pqxx::row& row : rows) {
      if (std::ssize(history.facts) == limit) {
        history.next_before = history.facts.back().seq;
        break;
      }
      history.facts.push_back(told_fact(row));
    }
    return history;
  });
}

RunsDocument runs_of_cell(const std::string& url, const std::string& cell, int limit,
                          std::optional<std::int64_t> before,
                          const std::optional<std::chrono::milliseconds>& patience) {
  return reading(url, patience, [&](pqxx::transaction_base& transaction) {
    // One more than is shown tells whether there are older ones.
    const pqxx::result began = transaction.exec_params(
        kNewestRuns, cell, before.value_or(std::numeric_limits<std::int64_t>::max()), limit + 1);
    std::string runs;
    std::optional<std::string> oldest;
    std::int64_t from = 0;
    const auto shown = std::min(static_cast<pqxx::result::size_type>(limit), began.size());
    for (pqxx::result::size_type i = 0; i < shown; ++i) {
      oldest = began[i]["run"].as<std::string>();
      from = began[i]["seq"].as<std::int64_t>();
      runs += (runs.empty() ? "{" : ",") + *oldest;
    }
    if (!oldest) return RunsDocument();
    std::vector<ArchivedFact> facts;
    for (const pqxx::row& row : transaction.exec_params(kFactsOfRuns, cell, from, runs + "}"))
      facts.push_back(told_fact(row));
    RunsDocument document = archived_runs(facts);
    if (began.size() > shown) document.next_before = oldest;
    return document;
  });
}

}  // namespace cell
