// The dashboards for Grafana: what they ask the archive is asked a real one. What they ask Prometheus:
// tests/package/check_dashboards.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "service/archive/fleet_reader.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::filesystem::path kGrafana =
    std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "service/package/plant/grafana";
constexpr const char* kArchive = "touchcal-archive";

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<json> dashboards() {
  std::vector<json> all;
  for (const auto& entry : std::filesystem::directory_iterator(kGrafana / "dashboards"))
    if (entry.path().extension() == ".json") all.push_back(json::parse(bytes_of(entry.path())));
  EXPECT_EQ(all.size(), 3U);
  return all;
}

/// As Grafana fills a query in: the time that is shown, the cell that is chosen.
std::string filled_in(std::string query, const std::string& cell) {
  for (const auto& [variable, text] : {std::pair{R"(\$__timeFrom\(\))", "'2025-12-01T00:00:00Z'"},
                                       {R"(\$__timeTo\(\))", "'2026-12-01T00:00:00Z'"}})
    query = std::regex_replace(query, std::regex(variable), text);
  return std::regex_replace(query, std::regex(R"(\$cell\b)"), "'" + cell + "'");
}

/// Of the first panel of that title and kind.
std::string query_of(const std::string& dashboard, const std::string& title,
                     const std::string& kind = "stat") {
  for (const json& one : dashboards()) {
    if (one.at("uid") != dashboard) continue;
    for (const json& panel : one.at("panels"))
      if (panel.at("title") == title && panel.at("type") == kind)
        return panel.at("targets").at(0).at("rawSql");
  }
  ADD_FAILURE() << dashboard << " has no " << title;
  return "SELECT 0";
}

class Dashboards : public ArchiveTest {
 protected:
  Dashboards() {
    sql("DO $$ BEGIN IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'grafana') THEN CREATE ROLE grafana "
        "LOGIN IN ROLE touchcal_quality; END IF; END $$");
    run_of(store_);
    ModelStore(store_.database())
        .approve({.run_id = 1,
                  .at = "2026-01-02T00:00:00.000Z",
                  .hash = "one",
                  .valid_until = "2027-01-02T00:00:00.000Z",
                  .document = R"({"arm":"tx90","tip_uncertainty":{"expanded":{"box_max_mm":0.25}}})",
                  .arm_json = "{}"});
    ModelStore(store_.database())
        .note_applied({.run_id = 1, .hash = "one", .to = "pick.dtx", .at = "2026-01-02T00:30:00.000Z"});
    const std::int64_t check = store_.begin_run(
        {.kind = RunKind::kCheck, .of_run = 1, .recipe = "edf-25", .started_at = "2026-01-02T01:00:00.000Z"});
    store_.finish_run(check,
                      {.outcome = RunOutcome::kComplete,
                       .verdict = Verdict::kRejected,
                       .ended_at = "2026-01-02T01:10:00.000Z",
                       .result_json = R"({"cause":"joint","joint":3,"growth_ppm":12.5,"rms_mm":0.02})"});
    FaultLog(store_.database()).append({}, "2026-01-04T00:00:00.000Z", "link_lost", "the network is cut");
    connect()->deliver(facts(), {});
  }
  /// As the user that the data source names.
  pqxx::result ask(const std::string& query) {
    pqxx::connection connection(server().url("grafana"));
    pqxx::read_transaction read(connection);
    return read.exec(filled_in(query, "edf"));
  }
};

TEST_F(Dashboards, EveryQueryOfTheArchiveIsAnsweredWithRows) {
  int asked = 0;
  for (const json& dashboard : dashboards()) {
    for (const json& panel : dashboard.at("panels")) {
      for (const json& target : panel.at("targets")) {
        if (target.at("datasource").at("uid") != kArchive) continue;
        ++asked;
        const std::string where =
            dashboard.at("uid").get<std::string>() + ", " + panel.at("title").get<std::string>();
        pqxx::result rows;
        ASSERT_NO_THROW(rows = ask(target.at("rawSql"))) << where;
        EXPECT_FALSE(rows.empty()) << where;
        if (target.at("format") != "time_series") continue;
        constexpr pqxx::oid kTimestampWithZone = 1184;
        EXPECT_STREQ(rows.column_name(0), "time") << where;
        EXPECT_EQ(rows.column_type(0), kTimestampWithZone) << where;
      }
    }
    for (const json& variable : dashboard.at("templating").at("list")) {
      if (variable.at("datasource").at("uid") != kArchive) continue;
      EXPECT_FALSE(ask(variable.at("query")).empty());
    }
  }
  EXPECT_GT(asked, 10);
}

TEST_F(Dashboards, ACellHasAModelWhileItsApprovalCounts) {
  const std::string query = query_of("touchcal-fleet", "Without an approved model");
  const auto without = [&] { return ask(query)[0][0].as<int>(); };
  EXPECT_EQ(without(), 0);
  sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('never', 1, 1, "
      "'run_started', "
      "'2026-01-01T00:00:00.000Z', '', '{}', '')");
  EXPECT_EQ(without(), 1);
  const auto last_word = [&](const std::string& body) {
    sql("UPDATE event SET body = '" + body + "' WHERE cell = 'edf' AND kind = 'approved'");
    return without() - 1;
  };
  EXPECT_EQ(last_word(R"({"current":"one","valid_until":null})"), 0) << "without an end";
  EXPECT_EQ(last_word(R"({"current":"one","valid_until":"2020-01-01T00:00:00.000Z"})"), 1) << "it is over";
  EXPECT_EQ(last_word(R"({"current":null,"valid_until":null})"), 1) << "rolled back to none";
}

TEST_F(Dashboards, CountsWhatTheTimeShownHolds) {
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Cells"))[0][0].as<int>(), 1);
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Runs"))[0][0].as<int>(), 2);
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Faults"))[0][0].as<int>(), 1);
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Silent for 14 days"))[0][0].as<int>(), 0);
  sql("UPDATE event SET at = '2024-01-01T00:00:00.000Z', archived_at = '2024-01-01'");
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Runs"))[0][0].as<int>(), 0);
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Silent for 14 days"))[0][0].as<int>(), 1);
}

TEST_F(Dashboards, TheTableOfTheCellsSaysWhatTheFleetSays) {
  const pqxx::row row = ask(query_of("touchcal-fleet", "Cells", "table"))[0];
  const auto known = fleet_of(owner_).cells.at(0);
  EXPECT_EQ(row["cell"].as<std::string>(), known.cell);
  EXPECT_EQ(row["arm"].as<std::string>(), known.arm);
  EXPECT_EQ(row["model"].as<std::string>(), known.model);
  EXPECT_EQ(row["in use"].as<std::string>(), known.applied_model);
  EXPECT_EQ(row["tip, mm"].as<double>(), known.tip_box_max_mm);
  EXPECT_EQ(row["check"].as<std::string>(), known.last_check_verdict);
  EXPECT_EQ(row["cause"].as<std::string>(), known.last_check_cause);
  EXPECT_EQ(row["growth, ppm"].as<double>(), 12.5);
  EXPECT_EQ(row["last fault"].as<std::string>(), known.last_fault_code);
  // The check is of a result that names no arm; a run that ends with another arm says the newest.
  sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('edf', 1000, 1, "
      "'run_ended', '2026-01-05T00:00:00.000Z', '', '{\"arm\":\"tx2-90\",\"outcome\":\"complete\"}', '')");
  EXPECT_EQ(ask(query_of("touchcal-fleet", "Cells", "table"))[0]["arm"].as<std::string>(), "tx2-90");
  EXPECT_EQ(fleet_of(owner_).cells.at(0).arm, "tx2-90");
}

TEST(DashboardFiles, NameDataSourcesThatAreProvisioned) {
  const std::string provisioned = bytes_of(kGrafana / "datasources/touchcal.yml");
  for (const json& dashboard : dashboards()) {
    for (const json& panel : dashboard.at("panels")) {
      EXPECT_THAT(provisioned,
                  HasSubstr("uid: " + panel.at("datasource").at("uid").get<std::string>() + "\n"));
      EXPECT_THAT(provisioned,
                  HasSubstr("type: " + panel.at("datasource").at("type").get<std::string>() + "\n"));
      EXPECT_NE(panel.at("description"), "");
    }
  }
}

TEST(DashboardFiles, HavePanelsSideBySide) {
  for (const json& dashboard : dashboards()) {
    std::set<int> ids;
    std::set<std::pair<int, int>> covered;
    for (const json& panel : dashboard.at("panels")) {
      EXPECT_TRUE(ids.insert(panel.at("id").get<int>()).second);
      const json& at = panel.at("gridPos");
      for (int x = at.at("x"); x < at.at("x").get<int>() + at.at("w").get<int>(); ++x) {
        for (int y = at.at("y"); y < at.at("y").get<int>() + at.at("h").get<int>(); ++y) {
          EXPECT_LT(x, 24);
          EXPECT_TRUE(covered.insert({x, y}).second) << dashboard.at("uid") << panel.at("title");
        }
      }
    }
  }
}

}  // namespace
}  // namespace cell
