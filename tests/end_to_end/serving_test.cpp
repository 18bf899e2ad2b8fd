// The daemon's threads: requests are answered on one while a run goes on upon another.
#include <gmock/gmock.h>

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/use_future.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "service/http/routes/api.hpp"
#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

/// The Api of a cell on a thread of its own; the test's thread is that of the operation.
class ServedCell {
 public:
  explicit ServedCell(LoopbackCell& loop) : ServedCell(loop, loop.io(), {}) {}
  /// `store` and `reader`: the threads of the disk.
  ServedCell(LoopbackCell& loop, asio::io_context& store, asio::any_io_executor reader)
      : loop_(loop),
        api_(http_.get_executor(),
             {.operation = loop.io().get_executor(), .store = store.get_executor(), .reader = reader},
             loop.operation(), {"operate", "view"}) {}
  ~ServedCell() {
    http_.stop();
    thread_.join();
    loop_.io().poll();  // what is still to be written
  }
  ServedCell(const ServedCell&) = delete;
  ServedCell& operator=(const ServedCell&) = delete;

  /// From any thread but those two.
  cell::HttpResponse send(const std::string& method, const std::string& path, const std::string& body = "",
                          cell::Query query = {}) {
    return send({.method = method,
                 .path = path,
                 .query = std::move(query),
                 .authorization = "Bearer operate",
                 .content_type = "application/json",
                 .body = body,
                 .remote = "127.0.0.1"});
  }
  cell::HttpResponse send(const cell::HttpRequest& request) {
    return asio::co_spawn(http_, api_.answer(request), asio::use_future).get();
  }
  json get(const std::string& path, cell::Query query = {}) {
    return json::parse(send("GET", path, "", std::move(query)).body);
  }
  /// Reads an event stream until a run has ended, one way or other, or waits for a person.
  std::string events() { return asio::co_spawn(http_, read_events(), asio::use_future).get(); }

 private:
  asio::awaitable<std::string> read_events() {
    const cell::HttpRequest request{.method = "GET", .path = "/api/v1/events", .from_loopback = true};
    const std::unique_ptr<cell::EventSource> stream = api_.events(request);
    std::string text;
    const auto tells = [&text](const char* state) { return text.find(state) != std::string::npos; };
    while (!tells("\"COMPLETE\"") && !tells("\"ABORTED\"") && !tells("\"HELD\"")) {
      text += stream->due();
      co_await stream->wait();
    }
    co_return text;
  }

  LoopbackCell& loop_;
  asio::io_context http_{1};
  asio::executor_work_guard<asio::io_context::executor_type> work_{http_.get_executor()};
  cell::Api api_;
  std::thread thread_{[this] { http_.run(); }};
};

void run_with_clients(LoopbackCell& loop, const std::vector<std::function<void()>>& clients) {
  std::atomic<std::size_t> ended = 0;
  std::vector<std::thread> threads;
  for (const auto& client : clients) {
    threads.emplace_back([&] {
      client();
      ++ended;
    });
  }
  loop.run_until([&](const cell::Status&) { return ended == clients.size(); });
  for (std::thread& thread : threads) thread.join();
}

TEST(Serving, ARunIsStartedWatchedAndReadFromOtherThreads) {
  LoopbackCell loop;
  loop.serve();
  loop.launch();
  loop.run_until(cell::State::kIdle);
  ServedCell served(loop);
  std::atomic<bool> is_over = false;
  std::string run;
  std::vector<std::uint64_t> polled;
  std::vector<unsigned> refused;
  std::string events;

  const auto starts_and_polls = [&] {
    const cell::HttpResponse started =
        served.send("POST", "/api/v1/runs", json{{"recipe", kShortRecipe}}.dump());
    EXPECT_EQ(started.status, 201U) << started.body;
    run = json::parse(started.body).value("id", "");
    for (std::string state; state != "COMPLETE" && state != "ABORTED" && state != "HELD";) {
      const std::string after = std::to_string(polled.empty() ? 0 : polled.back());
      const json status = served.get("/api/v1/status", {{"wait_s", "1"}, {"after", after}});
      polled.push_back(status.at("sequence"));
      state = status.at("state");
    }
    is_over = true;
  };
  const auto reads = [&] {
    while (!is_over) {
      for (const char* path : {"/api/v1/status", "/api/v1/cell", "/api/v1/cell/joints", "/metrics", "/readyz",
                               "/api/v1/runs", "/api/v1/runs/1/touches", "/api/v1/runs/1/result",
                               "/api/v1/runs/1/plan", "/api/v1/runs/1/report"}) {
        const unsigned status = served.send("GET", path).status;
        EXPECT_THAT(status, ::testing::AnyOf(200U, 404U, 409U, 503U)) << path;
      }
    }
  };
  const auto commands = [&] {
    while (!is_over) {
      refused.push_back(served.send("POST", "/api/v1/cell/clear").status);
      EXPECT_NE(served.send("POST", "/api/v1/cell/acknowledge").status, 500U);
    }
  };
  run_with_clients(loop, {starts_and_polls, reads, commands, [&] { events = served.events(); }});

  EXPECT_EQ(loop.status().state, cell::State::kComplete) << loop.fault_name();
  EXPECT_TRUE(std::ranges::is_sorted(polled));
  EXPECT_THAT(refused, ::testing::Each(409U));
  // Each change is told once, in order, from the first that was seen.
  std::vector<std::uint64_t> told;
  for (std::size_t at = 0; (at = events.find("\"sequence\":", at)) != std::string::npos; at += 11)
    told.push_back(std::stoull(events.substr(at + 11)));
  ASSERT_GT(told.size(), static_cast<std::size_t>(kShortTouchCount));
  for (std::size_t i = 1; i < told.size(); ++i) EXPECT_EQ(told[i], told[i - 1] + 1);

  json result;
  run_with_clients(loop, {[&] { result = served.get("/api/v1/runs/" + run + "/result"); }});
  EXPECT_EQ(result, json::parse(loop.store().result_json(std::stoll(run)).value()));
}

TEST(Serving, AStopOfAnotherThreadStopsTheRunWhileReportsAreMade) {
  LoopbackCell loop;
  loop.serve();
  loop.launch();
  loop.run_until(cell::State::kIdle);
  const std::int64_t run = loop.start();
  loop.run_until_touches(3);
  ServedCell served(loop);
  const auto makes_reports = [&] {
    for (int i = 0; i < 3; ++i) served.send("GET", "/api/v1/runs/" + std::to_string(run) + "/report");
  };
  unsigned status = 0;
  run_with_clients(loop, {makes_reports, makes_reports,
                          [&] { status = served.send("POST", "/api/v1/cell/stop").status; }});
  EXPECT_EQ(status, 202U);
  loop.run_until(cell::State::kStopped);
}

/// A run at this speed is not over before it is paused.
constexpr double kPausableSpeed = 20.0;

/// A pause and then an abort of the run, each with a key, as far as they are taken.
std::vector<unsigned> pause_and_abort(LoopbackCell& loop, ServedCell& served, std::int64_t run) {
  std::vector<unsigned> answered;
  const auto halt = [&](const char* word, cell::State reached) {
    run_with_clients(loop, {[&] {
                       answered.push_back(served
                                              .send({.method = "POST",
                                                     .path = "/api/v1/runs/" + std::to_string(run) + word,
                                                     .authorization = "Bearer operate",
                                                     .idempotency_key = word,
                                                     .remote = "127.0.0.1"})
                                              .status);
                     }});
    if (answered.back() == 202U) loop.run_until(reached);
  };
  halt("/pause", cell::State::kHeld);
  halt("/abort", cell::State::kAborted);
  return answered;
}

/// Of the file and its log: nothing in them is a database any more.
void overwrite(const std::filesystem::path& store_file) {
  for (const std::string part : {"", "-wal"}) {
    const std::filesystem::path file = store_file.string() + part;
    const std::string junk(std::filesystem::file_size(file), 'x');
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << junk;
  }
}

TEST(Serving, AnAbortAndAPauseAreTakenWhereTheDatabaseCannotBeRead) {
  LoopbackCell loop;
  loop.serve({}, kPausableSpeed);
  loop.launch();
  loop.run_until(cell::State::kIdle);
  const std::int64_t run = loop.start();
  ServedCell served(loop);
  loop.run_until_touches(3);
  overwrite(loop.store_file());
  unsigned read = 0;
  run_with_clients(
      loop, {[&] { read = served.send("GET", "/api/v1/runs/" + std::to_string(run) + "/touches").status; }});
  EXPECT_THAT(read, ::testing::AnyOf(500U, 503U)) << "it cannot be read";
  EXPECT_THAT(pause_and_abort(loop, served, run), ::testing::ElementsAre(202U, 202U));
}

TEST(Serving, AnAbortAndAPauseAreTakenWhileTheDiskDoesNotAnswer) {
  asio::io_context disk(1);  // nobody runs it
  LoopbackCell loop;
  loop.serve({}, kPausableSpeed);
  loop.launch();
  loop.run_until(cell::State::kIdle);
  const std::int64_t run = loop.start();
  {
    ServedCell served(loop, disk, disk.get_executor());
    loop.run_until_touches(3);
    EXPECT_THAT(pause_and_abort(loop, served, run), ::testing::ElementsAre(202U, 202U));
    disk.poll();  // what was to be written
  }
  EXPECT_EQ(loop.store().run(run)->outcome, cell::RunOutcome::kAborted);
}

}  // namespace
}  // namespace touchcal::testing
