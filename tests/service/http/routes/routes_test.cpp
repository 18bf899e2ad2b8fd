#include "service/http/routes/routes.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>

#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST_F(RoutesTest, StatusHasAStrongTagThatNamesTheInstanceAndItsSequence) {
  const HttpResponse response = get("/api/v1/status");
  EXPECT_EQ(response.status, 200u);
  EXPECT_EQ(response.content_type, "application/json");
  EXPECT_THAT(
      response.headers,
      ElementsAre(Pair("ETag", "\"instance-" + std::to_string(status().at("sequence").get<int>()) + "\"")));
}

TEST_F(RoutesTest, AKnownStatusIsNotSentAgainUntilItChanges) {
  const std::string tag = get("/api/v1/status").headers.at(0).second;
  HttpRequest request = made("GET", "/api/v1/status");
  request.from_loopback = true;
  for (const std::string& known :
       {tag, "W/" + tag, "\"other\", " + tag, tag + ",W/\"other\"", std::string("*")}) {
    request.if_none_match = known;
    const HttpResponse response = send(request);
    EXPECT_EQ(response.status, 304u) << known;
    EXPECT_EQ(response.body, "") << known;
    EXPECT_THAT(response.headers, Contains(Pair("ETag", tag))) << known;
  }
  for (const std::string& other : {std::string("\"other\""), std::string(), tag.substr(1, tag.size() - 2)}) {
    request.if_none_match = other;
    EXPECT_EQ(send(request).status, 200u) << other;
  }
  EXPECT_EQ(post("/api/v1/cell/reset").status, 202u);
  request.if_none_match = tag;
  EXPECT_EQ(send(request).status, 200u);
}

TEST_F(RoutesTest, RunsComeInPagesThatLeadThroughAll) {
  std::vector<std::string> wanted;
  for (int i = 0; i < 5; ++i) wanted.insert(wanted.begin(), std::to_string(stored_run()));
  std::vector<std::string> seen;
  std::string target = "/api/v1/runs?limit=2";
  for (int pages = 1; !target.empty(); ++pages) {
    ASSERT_LE(pages, 3);
    const json page = json::parse(get(target).body);
    for (const json& run : page.at("runs")) seen.push_back(run.at("id"));
    const json next = page.at("next_before");
    target = next.is_null() ? "" : "/api/v1/runs?limit=2&before=" + next.get<std::string>();
  }
  EXPECT_EQ(seen, wanted);
}

TEST_F(RoutesTest, AQueryThatMakesNoSenseIsToldApartFromAnEmptyPage) {
  for (const char* query : {"limit=0", "limit=-1", "limit=201", "limit=x", "limit=", "limit", "limit=1e1",
                            "limit=99999999999999999999", "before=x", "before=", "before=1.5", "before=-1",
                            "unknown=1", "limit=1&limit=1", "&&", "LIMIT=1"}) {
    const json document = problem(get(std::string("/api/v1/runs?") + query));
    EXPECT_EQ(document.at("status"), 400) << query;
    EXPECT_TRUE(document.contains("parameter")) << query;
  }
  for (const char* query : {"limit=1", "limit=200", "before=1", "before=0", ""})
    EXPECT_EQ(get(std::string("/api/v1/runs?") + query).status, 200u) << query;
}

TEST_F(RoutesTest, ARunItsTouchesAndItsResultAreReadFromTheStore) {
  const std::int64_t run = stored_run();
  cell_.store().append_touch(run, {.number = 1, .plane = 2, .joints = {1, 2, 3, 4, 5, 6}});
  EXPECT_EQ(json::parse(get(path_of(run)).body).at("touches_done"), 1);
  EXPECT_EQ(json::parse(get(path_of(run) + "/touches").body).at("touches").size(), 1u);
  EXPECT_EQ(problem(get(path_of(run) + "/result")).at("status"), 409);
  cell_.store().finish_run(
      run, {.outcome = RunOutcome::kComplete, .result_json = R"({"schema":"touchcal/result/1"})"});
  const HttpRequest request{.method = "GET", .path = path_of(run) + "/result", .from_loopback = true};
  EXPECT_EQ(cell_.run(route(request, cell_.operation(), kTokens)).body, R"({"schema":"touchcal/result/1"})")
      << "as it was stored";
}

TEST_F(RoutesTest, DamageOfTheDatabaseIsAProblemThatNamesIt) {
  const std::int64_t run = cell_.store().begin_run({.recipe = "edf-25",
                                                    .started_at = "start",
                                                    .config_digest = cell_.operation().config_digest(),
                                                    .conditions_json = "{}"});
  cell_.store().append_touch(run, {.number = 1, .plane = 2, .joints = {1, 2, 3, 4, 5, 6}});
  cell_.store().database()->exec("UPDATE touches SET plane = 3");
  for (const std::string part : {"/touches", "/result", "/report?format=json"}) {
    const json refused = problem(get(path_of(run) + part));
    EXPECT_EQ(refused.at("status"), 503) << part;
    EXPECT_EQ(refused.at("type"), "urn:touchcal:problem:damaged");
    EXPECT_THAT(refused.at("detail").get<std::string>(),
                ::testing::AllOf(HasSubstr("table touches"), HasSubstr("number 1"), HasSubstr("backup")));
  }
  cell_.store().database()->exec("UPDATE runs SET trace_json = '{'");
  EXPECT_EQ(problem(get(path_of(run))).at("status"), 503);
}

TEST_F(RoutesTest, ADamagedRunHidesNoOtherOfItsPage) {
  std::vector<std::string> ids;
  for (int i = 0; i < 4; ++i) ids.push_back(std::to_string(stored_run()));
  cell_.store().database()->exec("UPDATE runs SET recipe = 'other' WHERE id IN (" + ids[1] + ", " + ids[2] +
                                 ")");
  const auto page = [this](const std::string& query) {
    return json::parse(get("/api/v1/runs" + query).body);
  };
  const json whole = page("");
  ASSERT_EQ(whole.at("runs").size(), 2u);
  EXPECT_EQ(whole.at("runs")[0].at("id"), ids[3]);
  EXPECT_EQ(whole.at("runs")[1].at("id"), ids[0]);
  ASSERT_EQ(whole.at("damaged").size(), 2u);
  EXPECT_EQ(whole.at("damaged")[0].at("id"), ids[2]);
  EXPECT_THAT(whole.at("damaged")[0].at("detail").get<std::string>(),
              ::testing::AllOf(HasSubstr("table runs"), HasSubstr("run " + ids[2]), HasSubstr("backup")));
  EXPECT_TRUE(whole.at("next_before").is_null());

  const json first = page("?limit=2");
  EXPECT_EQ(first.at("runs").size(), 1u);
  EXPECT_EQ(first.at("damaged").size(), 1u);
  EXPECT_EQ(first.at("next_before"), ids[2]) << "also where the last of the page is damaged";
  const json second = page("?limit=2&before=" + ids[2]);
  EXPECT_EQ(second.at("damaged")[0].at("id"), ids[1]);
  EXPECT_EQ(second.at("runs")[0].at("id"), ids[0]);
  EXPECT_TRUE(second.at("next_before").is_null());
}

TEST_F(RoutesTest, AReportComesInThreeForms) {
  const std::string report = path_of(stored_run()) + "/report";
  EXPECT_THAT(get(report).content_type, HasSubstr("text/html"));
  EXPECT_THAT(get(report).headers, Contains(Pair("Content-Disposition", HasSubstr("attachment"))));
  EXPECT_THAT(get(report + "?format=csv").body, ::testing::StartsWith("touch,plane,role,"));
  EXPECT_EQ(json::parse(get(report + "?format=json").body).at("schema"), "touchcal/report/1");
  EXPECT_EQ(problem(get(report + "?format=docx")).at("status"), 400);
  EXPECT_EQ(problem(get("/api/v1/runs/99/report")).at("status"), 404);
}

TEST_F(RoutesTest, WhatIsNotThereIs404) {
  for (const char* target :
       {"/api", "/api/v1", "/api/v1/", "/api/v1/nothing", "/api/v2/status", "/Healthz", "/api/v1/runs/1",
        "/api/v1/runs/1/touches", "/api/v1/runs/1/result", "/api/v1/runs/x", "/api/v1/runs//touches",
        "/api/v1/runs/-1", "/api/v1/runs/99999999999999999999", "/api/v1/status/more",
        "/api/v1/runs/1/nothing", "/api/v1/%73tatus"}) {
    EXPECT_EQ(problem(get(target)).at("status"), 404) << target;
  }
  for (const char* command : {"pause", "resume", "abort"})
    EXPECT_EQ(problem(post(std::string("/api/v1/runs/1/") + command)).at("status"), 404) << command;
}

TEST_F(RoutesTest, AnotherMethodIs405AndSaysWhichAreTaken) {
  const auto allow = [&](const std::string& method, const std::string& target) {
    const HttpResponse response = send(made(method, target));
    EXPECT_EQ(problem(response).at("status"), 405) << method << target;
    for (const auto& [name, value] : response.headers) {
      if (name == "Allow") return value;
    }
    return std::string();
  };
  EXPECT_EQ(allow("POST", "/api/v1/status"), "GET");
  EXPECT_EQ(allow("DELETE", "/api/v1/runs/1"), "GET");
  EXPECT_EQ(allow("PUT", "/api/v1/runs"), "GET, POST");
  EXPECT_EQ(allow("GET", "/api/v1/cell/stop"), "POST");
  EXPECT_EQ(allow("get", "/api/v1/status"), "GET");
  EXPECT_EQ(allow("POST", "/healthz"), "GET");
}

TEST_F(RoutesTest, HealthNeedsNoToken) { EXPECT_EQ(send(made("GET", "/healthz")).status, 200u); }

TEST_F(RoutesTest, EveryRouteThatChangesSomethingNeedsTheOperateToken) {
  int seen = 0;
  for (const Route& name : routes()) {
    const bool names_people = name.path == "/api/v1/audit" || name.path == "/api/v1/users";
    const bool needs_it = name.access != Access::kOpen && name.access != Access::kView;
    const bool is_of_people = name.dispatch == DispatchMode::kPeople && name.access == Access::kOpen;
    EXPECT_EQ(needs_it, (name.method != "GET" || names_people) && !is_of_people) << name.path;
    if (name.method == "GET" || is_of_people) continue;  // people_desk_test says who may do those
    ++seen;
    const std::string path = with_run(name);
    HttpRequest request = made(std::string(name.method), path);
    request.from_loopback = true;
    const std::uint64_t before = cell_.operation().status().sequence;
    for (const std::string& sent :
         {std::string(), std::string("Bearer "), "Bearer " + std::string(64, 'c'), "Basic " + kTokens.operate,
          kTokens.operate, "Bearer " + kTokens.operate.substr(1), "Bearer " + kTokens.operate + "a"}) {
      request.authorization = sent.empty() ? std::nullopt : std::optional(sent);
      const HttpResponse response = send(request);
      EXPECT_EQ(problem(response).at("status"), 401) << path << " '" << sent << "'";
      EXPECT_THAT(response.headers, Contains(Pair("WWW-Authenticate", HasSubstr("Bearer")))) << path;
    }
    request.authorization = "Bearer " + kTokens.view;
    EXPECT_EQ(problem(send(request)).at("status"), 403) << path;
    EXPECT_EQ(cell_.operation().status().sequence, before) << path << " acted although it was refused";
    request.authorization = "Bearer " + kTokens.operate;
    EXPECT_THAT(send(request).status, ::testing::AllOf(::testing::Ne(401u), ::testing::Ne(403u))) << path;
  }
  EXPECT_GT(seen, 0);
}

TEST_F(RoutesTest, ReadingNeedsATokenFromElsewhereOnly) {
  int seen = 0;
  for (const Route& name : routes()) {
    if (name.access != Access::kView) continue;
    ++seen;
    HttpRequest request = made("GET", with_run(name));
    EXPECT_EQ(problem(send(request)).at("status"), 401) << name.path;
    request.authorization = "Bearer " + std::string(64, 'c');
    EXPECT_EQ(send(request).status, 401u) << name.path;
    for (const std::string& token : {kTokens.view, kTokens.operate}) {
      request.authorization = "Bearer " + token;
      EXPECT_NE(send(request).status, 401u) << name.path;
    }
    request.authorization.reset();
    request.from_loopback = true;
    EXPECT_NE(send(request).status, 401u) << name.path;
  }
  EXPECT_GT(seen, 0);
}

TEST_F(RoutesTest, CommandsTakeNoBodyButAnEmptyObject) {
  EXPECT_EQ(post("/api/v1/cell/acknowledge", "{}").status, 202u);
  EXPECT_EQ(problem(post("/api/v1/cell/acknowledge", R"({"now":true})")).at("status"), 400);
}

TEST_F(RoutesTest, AStopIsTakenWhateverComesWithIt) {
  EXPECT_EQ(post("/api/v1/cell/stop", "{}").status, 202u);
  EXPECT_EQ(post("/api/v1/cell/stop", "junk{").status, 202u);
}

TEST_F(RoutesTest, AStartWithoutAControllerNamesWhatIsMissing) {
  const json document = problem(post("/api/v1/runs", R"({"recipe":"edf-25"})"));
  EXPECT_EQ(document.at("status"), 409);
  ASSERT_EQ(document.at("errors").size(), 1u);
  EXPECT_EQ(document.at("errors")[0].at("code"), "controller_not_connected");
  EXPECT_FALSE(document.at("errors")[0].at("detail").get<std::string>().empty());
  EXPECT_TRUE(cell_.store().runs(1).empty());
}

TEST_F(RoutesTest, ACommandThatTheStateDoesNotAllowNamesTheOnesItDoes) {
  ASSERT_EQ(status().at("state"), "STOPPED");
  const json refused = problem(post("/api/v1/cell/clear"));
  EXPECT_EQ(refused.at("status"), 409);
  EXPECT_EQ(refused.at("exits"), json::array({"reset"}));
  EXPECT_EQ(status().at("state"), "STOPPED");

  EXPECT_EQ(json::parse(post("/api/v1/cell/reset").body).at("state"), "RESETTING");
  EXPECT_EQ(problem(post("/api/v1/cell/clear")).at("exits"), json::array({"stop"}));
  EXPECT_EQ(post("/api/v1/cell/reset").status, 202u) << "a command may be repeated";
  EXPECT_EQ(json::parse(post("/api/v1/cell/stop").body).at("state"), "STOPPED");
  EXPECT_EQ(post("/api/v1/cell/stop").status, 202u);
  EXPECT_EQ(post("/api/v1/cell/acknowledge").status, 202u);
}

TEST_F(RoutesTest, CommandsToARunThatIsOverSayThatItIsNotTheActiveOne) {
  const std::int64_t run = stored_run();
  for (const char* command : {"/pause", "/resume", "/abort"}) {
    const json document = problem(post(path_of(run) + command));
    EXPECT_EQ(document.at("status"), 409) << command;
    EXPECT_THAT(document.at("detail").get<std::string>(), HasSubstr("run " + std::to_string(run)));
    EXPECT_EQ(document.at("exits"), json::array({"reset"})) << command;
  }
}

TEST_F(RoutesTest, ARepeatedStartGetsTheRunThatItsKeyBegan) {
  const std::int64_t run = stored_run("key");
  HttpRequest request = made("POST", "/api/v1/runs");
  request.authorization = "Bearer " + kTokens.operate;
  request.content_type = "application/json";
  request.idempotency_key = "key";
  request.body = R"({"recipe":"edf-25"})";
  const HttpResponse again = send(request);
  EXPECT_EQ(again.status, 201u);
  EXPECT_THAT(again.headers, Contains(Pair("Location", path_of(run))));
  EXPECT_EQ(json::parse(again.body).at("id"), std::to_string(run));
  EXPECT_EQ(cell_.store().runs(10).size(), 1u);

  request.body = R"({"recipe":"edf-23"})";
  EXPECT_EQ(problem(send(request)).at("status"), 422) << "the same key for something else";
  for (const std::size_t length : {std::size_t{0}, std::size_t{256}}) {
    request.idempotency_key = std::string(length, 'k');
    EXPECT_EQ(problem(send(request)).at("status"), 400) << length;
  }
  request.idempotency_key = std::string(255, 'k');
  EXPECT_EQ(problem(send(request)).at("errors")[0].at("code"), "controller_not_connected")
      << "taken, then refused";
}

TEST_F(RoutesTest, ALongPollThatMakesNoSenseIsRefused) {
  for (const char* query : {"wait_s=-1&after=7", "wait_s=x&after=7", "wait_s=20&after=-7", "wait_s=20&after=",
                            "wait_s=3601&after=7", "wait_s=1.5&after=7", "wait=20&after=7"}) {
    EXPECT_EQ(problem(get(std::string("/api/v1/status?") + query)).at("status"), 400) << query;
  }
  for (const char* query : {"wait_s=20", "after=7"})
    EXPECT_EQ(get(std::string("/api/v1/status?") + query).status, 200u) << "answered at once: " << query;
}

TEST_F(RoutesTest, WhatIsConfiguredIsShown) {
  const json recipes = json::parse(get("/api/v1/recipes").body);
  EXPECT_EQ(recipes.at("recipes").size(), cell_.operation().cell().recipes.size());
  EXPECT_EQ(recipes.at("default"), cell_.operation().cell().default_recipe);
  const json shown = json::parse(get("/api/v1/cell").body);
  EXPECT_EQ(shown.at("block").at("faces").size(), cell_.operation().cell().block.faces.size());
  EXPECT_TRUE(shown.at("place").is_null());  // nobody located the block
  EXPECT_EQ(json::parse(get("/api/v1/faults").body).at("faults").size(), fault_table().size());
}

TEST_F(RoutesTest, ACellThatIsNotReadySaysWhatStandsInTheWay) {
  const json unready = problem(get("/readyz"));
  EXPECT_EQ(unready.at("status"), 503);
  EXPECT_EQ(unready.at("errors")[0].at("code"), "controller_not_connected");
  EXPECT_EQ(unready.at("errors")[1].at("code"), "state");
  EXPECT_EQ(unready.at("errors")[1].at("detail"), "the cell is in STOPPED");
}

TEST_F(RoutesTest, ACellWhoseStateDirectoryHasGoneIsNotReady) {
  namespace fs = std::filesystem;
  const fs::path there = cell_.store().file().parent_path();
  const fs::path away = there.string() + "-away";
  fs::rename(there, away);
  const json unready = problem(get("/readyz"));
  fs::rename(away, there);
  EXPECT_EQ(unready.at("status"), 503);
  EXPECT_EQ(unready.at("errors").back().at("code"), "store_not_writable");
  EXPECT_NE(problem(get("/readyz")).at("errors").back().at("code"), "store_not_writable");
}

TEST_F(RoutesTest, FiguresForPrometheusTellStateAndLink) {
  const HttpResponse figures = get("/metrics");
  EXPECT_THAT(figures.content_type, HasSubstr("text/plain"));
  EXPECT_THAT(figures.body, HasSubstr("touchcal_state{state=\"STOPPED\"} 1"));
  EXPECT_THAT(figures.body, HasSubstr("touchcal_controller_connected 0"));
  EXPECT_THAT(figures.body, HasSubstr("touchcal_link_age_seconds Nan"));
  EXPECT_THAT(figures.body, ::testing::Not(HasSubstr("touchcal_outbox_rows{"))) << "no sink is configured";
}

}  // namespace
}  // namespace cell
