#include "service/http/routes/api.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <functional>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "tests/service/http/routes/api_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Calls at each statement of one connection and of those that are opened from here on, on the thread that
/// has it.
class CallAtStatements {
 public:
  CallAtStatements(std::function<void()> call, SQLite::Database& opened) : opened_(opened.getHandle()) {
    call_ = std::move(call);
    watch(opened_, nullptr, nullptr);
    sqlite3_auto_extension(reinterpret_cast<void (*)()>(&watch));
  }
  ~CallAtStatements() {
    sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(&watch));
    sqlite3_trace_v2(opened_, 0, nullptr, nullptr);
  }
  CallAtStatements(const CallAtStatements&) = delete;
  CallAtStatements& operator=(const CallAtStatements&) = delete;

 private:
  static int watch(sqlite3* connection, const char**, const void*) {
    return sqlite3_trace_v2(connection, SQLITE_TRACE_STMT, &tell, nullptr);
  }
  static int tell(unsigned, void*, void*, void*) {
    call_();
    return 0;
  }

  static inline std::function<void()> call_;
  sqlite3* opened_;
};

TEST_F(ApiTest, ARepeatedKeyGetsTheFirstAnswerAndNothingHappensAgain) {
  const HttpResponse first = send(keyed("/api/v1/cell/reset", "one"));
  ASSERT_EQ(first.status, 202u);
  ASSERT_EQ(state(), "RESETTING");
  ASSERT_EQ(send(post("/api/v1/cell/stop")).status, 202u);
  const HttpResponse again = send(keyed("/api/v1/cell/reset", "one"));
  EXPECT_EQ(again.status, first.status);
  EXPECT_EQ(again.body, first.body);
  EXPECT_EQ(state(), "STOPPED") << "the reset was not taken again";
}

TEST_F(ApiTest, AnAnswerThatIsNotAsItWasStoredIsNotTold) {
  ASSERT_EQ(send(keyed("/api/v1/cell/reset", "one")).status, 202u);
  ASSERT_EQ(quiet_.operation().store().database()->exec("UPDATE answers SET body = x'7b7d'"), 1);
  const HttpResponse refused = send(keyed("/api/v1/cell/reset", "one"));
  EXPECT_EQ(refused.status, 503u);
  EXPECT_THAT(refused.body,
              ::testing::AllOf(HasSubstr("urn:touchcal:problem:damaged"), HasSubstr("table answers")));
  EXPECT_THAT(metrics(), HasSubstr("\ntouchcal_internal_errors_total 1\n"));
}

TEST_F(ApiTest, AnswersThatDamageKeepsAreCounted) {
  RunStore& store = quiet_.store();
  const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "start"});
  store.append_touch(run, {.number = 1, .plane = 2, .joints = {1, 2, 3, 4, 5, 6}});
  store.database()->exec("UPDATE touches SET plane = 3");
  const std::string path = "/api/v1/runs/" + std::to_string(run) + "/touches";
  EXPECT_EQ(send({.method = "GET", .path = path, .from_loopback = true}).status, 503U);
  EXPECT_EQ(send({.method = "GET", .path = "/readyz", .from_loopback = true}).status, 503U) << "no damage";
  EXPECT_THAT(metrics(), HasSubstr("\ntouchcal_internal_errors_total 1\n"));
}

TEST_F(ApiTest, AKeyBelongsToOneRequest) {
  ASSERT_EQ(send(keyed("/api/v1/cell/reset", "one")).status, 202u);
  EXPECT_EQ(send(keyed("/api/v1/cell/acknowledge", "one")).status, 422u) << "another path";
  EXPECT_EQ(send(keyed("/api/v1/cell/reset", "one", "{}")).status, 422u) << "another body";
  EXPECT_EQ(send(keyed("/api/v1/cell/stop", "one")).status, 202u) << "a stop is taken whatever comes with it";
}

TEST_F(ApiTest, AKeyWhoseRequestWasRefusedMayComeAgain) {
  ASSERT_EQ(send(keyed("/api/v1/cell/clear", "one")).status, 409u);
  EXPECT_EQ(send(keyed("/api/v1/cell/reset", "one")).status, 202u);
}

TEST_F(ApiTest, AKeyInProgressIsToldSo) {
  const HttpRequest request = keyed("/api/v1/identify", "one", "{}");
  std::vector<unsigned> statuses;
  for (int i = 0; i < 2; ++i) {
    boost::asio::co_spawn(
        quiet_.context(), api_.answer(request),
        [&](const std::exception_ptr&, HttpResponse answer) { statuses.push_back(answer.status); });
  }
  quiet_.context().run();
  EXPECT_THAT(statuses, ::testing::UnorderedElementsAre(400u, 409u));
}

TEST_F(ApiTest, ARightTokenIsAnsweredAtOnceAndMakesNoGuesserFaster) {
  HttpRequest wrong = post("/api/v1/cell/reset");
  wrong.authorization = "Bearer " + std::string(64, 'x');
  int answered = 0;
  const auto ask = [&](const HttpRequest& request) {
    boost::asio::co_spawn(quiet_.context(), api_.answer(request),
                          [&](const std::exception_ptr&, const HttpResponse&) { ++answered; });
    quiet_.context().restart();
    quiet_.context().poll();
  };
  const HttpRequest right = post("/api/v1/cell/stop");
  for (int i = 0; i < WrongTokens::kAtOnce; ++i) {
    ask(wrong);
    ask(right);
    EXPECT_EQ(answered, 2 * (i + 1)) << "at once";
  }
  for (int i = 0; i < 3; ++i) {
    ask(wrong);
    ask(right);
    EXPECT_EQ(answered, 2 * WrongTokens::kAtOnce + i + 1) << "a stop from the same address, and no guess";
  }
  quiet_.context().run();
  EXPECT_EQ(answered, 2 * (WrongTokens::kAtOnce + 3));
}

TEST_F(ApiTest, AStopIsTakenWhileTheDiskThatIsReadHangs) {
  boost::asio::io_context reader(1);  // it runs when the disk answers again
  const auto serving = quiet_.context().get_executor();
  Api api(serving, {.operation = serving, .store = serving, .reader = reader.get_executor()},
          quiet_.operation(), kTokens);
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then"});
  quiet_.store().finish_run(run, {.outcome = RunOutcome::kStopped, .ended_at = "end"});
  const std::string of_run = "/api/v1/runs/" + std::to_string(run);
  std::map<std::string, unsigned> answered;
  const auto ask = [&](const HttpRequest& request) {
    boost::asio::co_spawn(
        quiet_.context(), api.answer(request),
        [&answered, path = request.path](const std::exception_ptr&, const HttpResponse& answer) {
          answered[path] = answer.status;
        });
  };
  HttpRequest events{.method = "GET", .path = of_run + "/events", .from_loopback = true};
  const HttpRequest ready{.method = "GET", .path = "/readyz", .from_loopback = true};
  const std::vector<HttpRequest> reading{ready, post(of_run + "/abort"), post("/api/v1/runs/99/pause"),
                                         events};
  for (const HttpRequest& request : reading) ask(request);
  const std::unique_ptr<EventSource> stream = api.events(events);
  stream->due();
  bool is_over = false;
  boost::asio::co_spawn(quiet_.context(), stream->wait(), [&](const std::exception_ptr&) { is_over = true; });
  quiet_.context().poll();
  EXPECT_THAT(answered, ::testing::IsEmpty());
  EXPECT_FALSE(is_over);
  const HttpRequest stop = post("/api/v1/cell/stop");
  ask(stop);
  quiet_.context().poll();
  EXPECT_EQ(answered["/api/v1/cell/stop"], 202U);

  reader.poll();
  quiet_.context().poll();
  EXPECT_EQ(answered["/readyz"], 503U);
  EXPECT_EQ(answered[of_run + "/abort"], 409U);
  EXPECT_EQ(answered["/api/v1/runs/99/pause"], 404U);
  EXPECT_EQ(answered[of_run + "/events"], 200U);
  EXPECT_TRUE(is_over);
  EXPECT_THAT(stream->due(), HasSubstr("event: run"));
}

TEST_F(ApiTest, AStartThatIsStoredIsAnsweredWhileTheDiskThatIsReadHangs) {
  boost::asio::io_context reader(1);  // it never answers
  const auto serving = quiet_.context().get_executor();
  Api api(serving, {.operation = serving, .store = serving, .reader = reader.get_executor()},
          quiet_.operation(), kTokens);
  const std::int64_t run =
      quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then", .idempotency_key = "one"});
  HttpResponse answer{.status = 0};
  const HttpRequest request = keyed("/api/v1/runs", "one", R"({"recipe":"edf-25"})");
  boost::asio::co_spawn(quiet_.context(), api.answer(request),
                        [&](const std::exception_ptr&, HttpResponse told) { answer = std::move(told); });
  quiet_.context().poll();
  EXPECT_EQ(answer.status, 201U);
  EXPECT_EQ(json::parse(answer.body).at("id"), std::to_string(run));
  EXPECT_EQ(answer.headers.at(0).second, "/api/v1/runs/" + std::to_string(run));
}

/// Requests to every route of a daemon whose operation and store have a thread besides the one that serves,
/// which is the test's; and which of them has a statement executed by any connection to the database.
class ReadsOfRoutes : public ApiTest {
 protected:
  ReadsOfRoutes() {
    quiet_.store().finish_run(run_, {.outcome = RunOutcome::kComplete, .ended_at = "end"});
    read_here_ = read_elsewhere_ = 0;
  }
  ~ReadsOfRoutes() override {
    served_.end_desks();
    works_.reset();
  }

  HttpResponse answer(const HttpRequest& request) {
    std::optional<HttpResponse> told;
    boost::asio::co_spawn(serving_, served_.answer(request),
                          [&](const std::exception_ptr&, HttpResponse made) { told = std::move(made); });
    serving_.restart();
    while (!told) serving_.run_one();
    return *std::move(told);
  }
  /// Of a GET without the body.
  HttpRequest request_to(const Route& route, const std::string& body) const {
    HttpRequest request =
        post(std::regex_replace(std::string(route.path), std::regex("\\{id\\}"), std::to_string(run_)), body);
    if (route.method == "GET") request.content_type.reset(), request.body.clear();
    request.method = route.method;
    return request;
  }
  static bool tells_stored(const Route& route) {
    return route.method == "GET" &&
           std::regex_match(std::string(route.path), std::regex("/api/v1/(runs|models|audit).*"));
  }

  const std::thread::id here_ = std::this_thread::get_id();
  std::atomic<int> read_here_ = 0, read_elsewhere_ = 0;
  CallAtStatements watch_{[this] { ++(std::this_thread::get_id() == here_ ? read_here_ : read_elsewhere_); },
                          *quiet_.store().database()};
  const std::int64_t run_ = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then"});
  boost::asio::io_context serving_{1};
  Api served_{serving_.get_executor(),
              {.operation = quiet_.context().get_executor(), .store = quiet_.context().get_executor()},
              quiet_.operation(),
              kTokens};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> works_{
      quiet_.context().get_executor()};
  std::jthread operating_{[this] { quiet_.context().run(); }};
};

TEST_F(ReadsOfRoutes, AreNotOnTheThreadThatServes) {
  for (const Route& route : routes()) {
    for (const char* body : {"{}", R"({"recipe":"edf-25"})"}) {
      if (route.dispatch == DispatchMode::kPlanning && body != std::string("{}")) continue;  // it takes long
      const int before = read_elsewhere_;
      EXPECT_NE(answer(request_to(route, body)).status, 500U) << route.path;
      EXPECT_EQ(read_here_, 0) << route.method << ' ' << route.path << ' ' << body;
      EXPECT_TRUE(read_elsewhere_ > before || !tells_stored(route)) << "it was not let in: " << route.path;
    }
  }
}

TEST_F(ReadsOfRoutes, WouldBeSeenHereByEachConnection) {
  (void)served_.services().reads.store().run(run_);
  EXPECT_EQ(read_here_, 1) << "of the thread that serves";
  (void)quiet_.store().run(run_);
  EXPECT_EQ(read_here_, 2) << "of the operation";
}

TEST_F(ApiTest, APauseWithAKeyIsTakenWhereKeysCannotBeLookedUp) {
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then"});
  quiet_.store().database()->exec("DROP TABLE answers");
  const std::string of_run = "/api/v1/runs/" + std::to_string(run);
  EXPECT_EQ(send(keyed(of_run + "/pause", "one")).status, 409u) << "it reached the state machine";
  EXPECT_EQ(send(keyed(of_run + "/resume", "two")).status, 503u);
}

TEST_F(ApiTest, ACommandThatCannotBeWrittenDownIsNotTakenButForAStop) {
  quiet_.store().database()->exec("DROP TABLE audit");
  const HttpResponse refused = send(post("/api/v1/cell/reset"));
  EXPECT_EQ(refused.status, 503u);
  EXPECT_THAT(refused.body, HasSubstr("Stop"));
  EXPECT_EQ(state(), "STOPPED") << "not taken";
  EXPECT_EQ(send(post("/api/v1/cell/stop")).status, 202u);
  // No run is there to be halted: these reach the state machine, a resume does not.
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then"});
  const std::string of_run = "/api/v1/runs/" + std::to_string(run);
  for (const char* halt : {"/abort", "/pause"}) EXPECT_EQ(send(post(of_run + halt)).status, 409u) << halt;
  EXPECT_EQ(send(post(of_run + "/resume")).status, 503u);
}

TEST_F(ApiTest, TheDocumentOfTheStatusIsThatOfItsSequence) {
  const auto shown = [&] {
    return json::parse(send({.method = "GET", .path = "/api/v1/status", .from_loopback = true}).body);
  };
  const json before = shown();
  EXPECT_EQ(before, shown());
  send(post("/api/v1/cell/reset"));
  EXPECT_GT(shown().at("sequence"), before.at("sequence"));
  EXPECT_EQ(shown().at("state"), "RESETTING");
  EXPECT_TRUE(shown().at("data_age_ms").is_null()) << "never heard is not 0";
}

TEST_F(ApiTest, ASinkThatIsBehindIsToldAndIsNoChangeOfTheStatus) {
  const auto sinks = std::make_shared<SinkStates>();
  const auto latest = std::make_shared<LatestText>();
  const auto get = [&](const std::string& path) {
    return send({.method = "GET", .path = path, .from_loopback = true});
  };
  api_.services().feed.tell_sinks(sinks, latest);
  EXPECT_EQ(json::parse(latest->take_new().value()).at("state"), "STOPPED");
  EXPECT_FALSE(latest->take_new());
  const HttpResponse before = get("/api/v1/status");
  EXPECT_TRUE(json::parse(before.body).at("mqtt_behind").is_null()) << "it is not configured";
  sinks->set({.sink = "mqtt", .behind = 3, .oldest_at = "1970-01-01T00:00:00.000Z", .trouble = "no broker"});
  const HttpResponse behind = get("/api/v1/status");
  EXPECT_EQ(json::parse(behind.body).at("mqtt_behind"), 3);
  EXPECT_EQ(json::parse(behind.body).at("mqtt_trouble"), "no broker");
  EXPECT_TRUE(json::parse(behind.body).at("archive_behind").is_null());
  EXPECT_EQ(behind.headers, before.headers) << "the tag";
  const std::string figures = get("/metrics").body;
  for (const char* figure :
       {"touchcal_outbox_rows{sink=\"mqtt\"} 3", "touchcal_sink_connected{sink=\"mqtt\"} 0",
        "touchcal_outbox_oldest_seconds{sink=\"mqtt\"} "})
    EXPECT_THAT(figures, HasSubstr(figure));
  const auto readiness = [&] { return json::parse(get("/readyz").body).at("detail").get<std::string>(); };
  EXPECT_THAT(readiness(), HasSubstr("mqtt: 3 facts behind: no broker"));
  sinks->set({.sink = "mqtt", .behind = 1'000'000, .connected = true});
  EXPECT_THAT(readiness(), HasSubstr("mqtt: 1000000 facts behind, and it takes them"));
  EXPECT_EQ(json::parse(get("/api/v1/status").body).at("mqtt_behind"), 1'000'000);
  EXPECT_THAT(get("/metrics").body, HasSubstr("touchcal_outbox_rows{sink=\"mqtt\"} 1000000"));
  ASSERT_EQ(send(post("/api/v1/cell/reset")).status, 202u);
  get("/api/v1/status");
  EXPECT_EQ(json::parse(latest->take_new().value()).at("state"), "RESETTING");
}

TEST_F(ApiTest, NoDeskIsAtAnythingOnceTheyHaveEnded) {
  const auto here = std::this_thread::get_id();
  std::promise<void> at_work;
  std::atomic<bool> is_told = false, have_ended = false, is_done_before = false;
  const CallAtStatements watch(
      [&] {
        if (std::this_thread::get_id() == here || is_told.exchange(true)) return;
        at_work.set_value();
        for (int i = 0; i < 1000 && !have_ended; ++i) std::this_thread::yield();
        is_done_before = !have_ended;
      },
      *quiet_.store().database());
  Api api(quiet_.context().get_executor(), quiet_.operation(), kTokens);
  HttpRequest request{.method = "GET", .path = "/api/v1/audit"};
  request.authorization = "Bearer " + kTokens.operate;
  bool is_answered = false;
  boost::asio::co_spawn(quiet_.context(), api.answer(request),
                        [&](const std::exception_ptr&, const HttpResponse&) { is_answered = true; });
  quiet_.context().poll();
  at_work.get_future().wait();
  api.end_desks();
  have_ended = true;
  EXPECT_TRUE(is_done_before) << "else it posts to a context that has been given up";
  quiet_.context().restart();
  quiet_.context().poll();
  EXPECT_TRUE(is_answered) << "what was done is heard of where somebody listens";
}

TEST_F(ApiTest, AnswersAreCountedByRouteAndStatus) {
  send({.method = "GET", .path = "/api/v1/runs/7", .from_loopback = true});
  send({.method = "GET", .path = "/api/v1/runs/8", .from_loopback = true});
  EXPECT_THAT(metrics(), HasSubstr("touchcal_http_requests_total{method=\"GET\",route=\"/api/v1/runs/{id}\","
                                   "status=\"404\"} 2"));
}

}  // namespace
}  // namespace cell
