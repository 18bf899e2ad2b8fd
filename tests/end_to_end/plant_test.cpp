// A daemon that tells a broker and an archive, as processes.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "service/base/exit_code.hpp"
#include "service/store/run_store.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/service/archive/postgres.hpp"
#include "tests/service/mqtt/broker.hpp"
#include "tests/service/mqtt/certificates.hpp"
#include "tests/service/raw_http.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Plant : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> daemon_call(const std::vector<std::string>& more) const {
    std::vector<std::string> call{
        "touchcald",   "--cell",      std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json",
        "--listen",    "127.0.0.1:0", "--controller",
        "127.0.0.1:9", "--state",     state_.string()};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }
  [[nodiscard]] std::vector<std::string> daemon_call(const cell::MqttOptions& mqtt) const {
    return daemon_call({"--mqtt", "mqtts://127.0.0.1:" + std::to_string(mqtt.port), "--mqtt-ca",
                        mqtt.authority.string(), "--mqtt-cert", mqtt.certificate.string(), "--mqtt-key",
                        mqtt.key.string()});
  }
  Finished run(const std::vector<std::string>& call) { return Process(call, folder_ / "call.err").wait(); }
  json status(const std::string& address) {
    return json::parse(
        Process({"touchcal", "status", "--json", "--daemon", "http://" + address, "--state", state_.string()},
                folder_ / "status.err")
            .wait()
            .out);
  }
  /// Asks until the broker has confirmed all.
  json status_when_told(const std::string& address, const std::string& sink = "mqtt") {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    json now = status(address);
    while ((now.at(sink + "_behind") != 0 || !now.at(sink + "_trouble").is_null()) &&
           std::chrono::steady_clock::now() < end)
      now = status(address);
    return now;
  }

  static std::string got(const std::string& address, const std::string& path) {
    const auto port =
        static_cast<boost::asio::ip::port_type>(std::stoi(address.substr(address.rfind(':') + 1)));
    cell::RawClient client({boost::asio::ip::address_v4::loopback(), port});
    client.send("GET " + path + " HTTP/1.1\r\nHost: " + address + "\r\n\r\n");
    return client.receive().body;
  }
  static json served(const std::string& address, const std::string& path) {
    return json::parse(got(address, path), nullptr, false);
  }
  /// What the daemon's page shows.
  static json served_fleet(const std::string& address) { return served(address, "/api/v1/fleet"); }

  Folder folder_;
  std::filesystem::path state_ = folder_.directory("state");
};

/// The number of starts that the `online` messages tell of, negative where they say offline.
std::vector<int> starts_in(const std::vector<cell::Message>& messages) {
  std::vector<int> starts;
  for (const cell::Message& message : messages) {
    if (!message.topic.ends_with("/online")) continue;
    const json online = json::parse(message.text);
    starts.push_back(online.at("instance").get<int>() * (online.at("online") == true ? 1 : -1));
  }
  return starts;
}

std::vector<std::string> kinds_in(const std::vector<cell::Message>& messages) {
  std::vector<std::string> kinds;
  for (const cell::Message& message : messages)
    if (message.topic.starts_with("touchcal/v1/edf/event/"))
      kinds.push_back(json::parse(message.text).at("kind"));
  return kinds;
}

TEST_F(Plant, ADaemonTellsWhatHappenedAndThatItIsThereAgain) {
  {
    cell::RunStore store(state_ / "touchcal.sqlite");
    const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
    store.finish_run(run, {.outcome = cell::RunOutcome::kStopped, .ended_at = "2026-01-01T00:01:00.000Z"});
  }
  cell::Broker broker(cell::certificates());
  cell::Subscriber plant(broker.options_of("plant-reader"));
  std::optional<Process> daemon(std::in_place, daemon_call(broker.options_of("edf")),
                                folder_ / "touchcald.err");
  std::string address = daemon->wait_for_address();
  EXPECT_EQ(status_when_told(address).at("mqtt_behind"), 0);
  EXPECT_TRUE(status(address).at("mqtt_trouble").is_null());
  EXPECT_TRUE(status(address).at("archive_behind").is_null());
  std::vector<std::string> kinds;
  for (std::size_t count = 5; kinds.size() < 2 && count < 30; ++count)
    kinds = kinds_in(plant.wait_for(count));
  EXPECT_THAT(kinds, ::testing::ElementsAre("run_started", "run_ended"));

  daemon->signal(SIGKILL);
  daemon->wait();
  daemon.emplace(daemon_call(broker.options_of("edf")), folder_ / "touchcald.err");
  address = daemon->wait_for_address();
  EXPECT_EQ(status_when_told(address).at("mqtt_behind"), 0);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait().exit_code, 0);
  std::vector<int> starts;
  for (std::size_t count = 6; starts.size() < 4 && count < 30; ++count)
    starts = starts_in(plant.wait_for(count));
  EXPECT_THAT(starts, ::testing::ElementsAre(1, -1, 2, -2));
}

TEST_F(Plant, ACertificateOfAnotherCellIsToldAndTheCellGoesOn) {
  cell::Broker broker(cell::certificates());
  const auto call = daemon_call(broker.options_of("cell-1"));
  auto check = call;
  check.emplace_back("--check");
  const Finished checked = Process(check, folder_ / "check.err").wait();
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("is of 'cell-1', and this cell is 'edf'"));
  Process daemon(call, folder_ / "touchcald.err");
  const std::string address = daemon.wait_for_address();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  json now = status(address);
  while (now.at("mqtt_trouble") == "it is not connected yet" && std::chrono::steady_clock::now() < end)
    now = status(address);
  EXPECT_THAT(now.at("mqtt_trouble").get<std::string>(), HasSubstr("is of 'cell-1'"));
  EXPECT_FALSE(now.at("mqtt_behind").is_null()) << "what happens is kept for the broker";
}

TEST_F(Plant, ABrokerThatConfirmsNothingAndAnArchiveOfANewerSchemaAreNamedAndTheCellGoesOn) {
  cell::RunStore(state_ / "touchcal.sqlite")
      .begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
  cell::Broker broker(cell::certificates(), "user plant-reader\ntopic read touchcal/v1/#\n");
  cell::Postgres postgres;
  ASSERT_EQ(run({"touchcal", "archive", "prepare", "--archive", postgres.url()}).exit_code, 0);
  postgres.sql("CREATE ROLE edf LOGIN IN ROLE touchcal_writer");
  postgres.sql("UPDATE touchcal_schema SET version = 99");
  auto call = daemon_call(broker.options_of("edf"));
  call.insert(call.end(), {"--archive", postgres.url("edf")});
  Process daemon(call, folder_ / "touchcald.err");
  const std::string address = daemon.wait_for_address();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  const auto trouble = [](const json& status, const char* sink) {
    const json& said = status.at(std::string(sink) + "_trouble");
    return said.is_null() ? std::string() : said.get<std::string>();
  };
  const std::string of_broker = "refuses touchcal/v1/edf/", of_archive = "a newer touchcal (schema 99";
  json now = status(address);
  while ((trouble(now, "mqtt").find(of_broker) == std::string::npos ||
          trouble(now, "archive").find(of_archive) == std::string::npos) &&
         std::chrono::steady_clock::now() < end)
    now = status(address);
  EXPECT_THAT(trouble(now, "mqtt"), HasSubstr(of_broker));
  EXPECT_THAT(trouble(now, "archive"), HasSubstr(of_archive));
  EXPECT_GE(now.at("mqtt_behind"), 1);
  EXPECT_EQ(now.at("archive_behind"), now.at("mqtt_behind"));
  EXPECT_EQ(got(address, "/healthz"), R"({"status":"ok"})");
  EXPECT_THAT(got(address, "/readyz"), ::testing::AllOf(HasSubstr(of_broker), HasSubstr(of_archive)));
  const std::string figures = got(address, "/metrics");
  for (const char* sink : {"mqtt", "archive"}) {
    const std::string of_sink = std::string("{sink=\"") + sink + "\"} ";
    EXPECT_THAT(figures, HasSubstr("touchcal_sink_connected" + of_sink));
    EXPECT_THAT(figures, HasSubstr("touchcal_outbox_rows" + of_sink + now.at("mqtt_behind").dump()));
    EXPECT_THAT(figures, HasSubstr("touchcal_outbox_oldest_seconds" + of_sink));
  }
}

TEST_F(Plant, AnArchiveIsPreparedWrittenVerifiedAndListed) {
  const std::int64_t run_id = [&] {
    cell::RunStore store(state_ / "touchcal.sqlite");
    const std::int64_t run_id = store.begin_run({.recipe = "edf-25",
                                                 .started_at = "2026-01-01T00:00:00.000Z",
                                                 .conditions_json = R"({"touching":"automatic"})"});
    store.finish_run(run_id, {.outcome = cell::RunOutcome::kStopped, .ended_at = "2026-01-01T00:01:00.000Z"});
    return run_id;
  }();
  cell::Postgres postgres;
  const std::string owner = postgres.url();
  EXPECT_EQ(run({"touchcal", "fleet", "--archive", owner}).exit_code, cell::kExitRefused) << "not prepared";
  EXPECT_EQ(run({"touchcal", "archive", "prepare", "--archive", owner}).exit_code, 0);
  postgres.sql("CREATE ROLE edf LOGIN IN ROLE touchcal_writer");
  Process daemon(daemon_call({"--archive", postgres.url("edf")}), folder_ / "touchcald.err");
  const std::string address = daemon.wait_for_address();
  EXPECT_EQ(status_when_told(address, "archive").at("archive_behind"), 0);
  const json fleet = json::parse(run({"touchcal", "fleet", "--json", "--archive", owner}).out);
  ASSERT_EQ(fleet.at("cells").size(), 1U);
  EXPECT_EQ(fleet.at("cells")[0].at("cell"), "edf");
  EXPECT_EQ(fleet.at("cells")[0].at("last_run_id"), std::to_string(run_id));
  EXPECT_EQ(fleet.at("cells")[0].at("outcome"), "stopped");
  EXPECT_TRUE(fleet.at("cells")[0].at("model").is_null());
  EXPECT_THAT(run({"touchcal", "fleet", "--archive", owner}).out, HasSubstr("stopped"));
  EXPECT_THAT(run({"touchcal", "fleet", "--trends", "12", "--archive", owner}).out,
              HasSubstr("calibrations"));
  const json trends =
      json::parse(run({"touchcal", "fleet", "--trends", "12", "--json", "--archive", owner}).out);
  EXPECT_EQ(trends.at("schema"), "touchcal/fleet-trends/1");
  EXPECT_EQ(run({"touchcal", "fleet", "--trends", "0", "--archive", owner}).exit_code, cell::kExitUsage);
  EXPECT_EQ(served_fleet(address), fleet) << "the cell may read its own, and there is no other";
  const json history =
      json::parse(run({"touchcal", "fleet", "--cell", "edf", "--json", "--archive", owner}).out);
  const auto ended = std::ranges::find(history.at("facts"), json("run_ended"),
                                       [](const json& fact) { return fact.at("kind"); });
  const std::vector<std::string> of_the_cell{"touchcal", "fleet",     "--cell", "edf",
                                             "--runs",   "--archive", owner};
  std::vector<std::string> as_json = of_the_cell;
  as_json.push_back("--json");
  EXPECT_EQ(json::parse(run(as_json).out), served(address, "/api/v1/runs"))
      << "as the cell lists them itself";
  EXPECT_THAT(run(of_the_cell).out, HasSubstr("stopped"));
  EXPECT_EQ(run({"touchcal", "fleet", "--runs", "--archive", owner}).exit_code, cell::kExitUsage)
      << "of which cell";
  EXPECT_EQ(run({"touchcal", "fleet", "--cell", "fde", "--runs", "--archive", owner}).exit_code,
            cell::kExitUsage);
  ASSERT_NE(ended, history.at("facts").end());
  EXPECT_EQ(ended->at("body").at("outcome"), "stopped");
  const json newest = json::parse(
      run({"touchcal", "fleet", "--cell", "edf", "--limit", "1", "--json", "--archive", owner}).out);
  EXPECT_EQ(newest.at("next_before"), newest.at("facts").at(0).at("seq"));
  EXPECT_THAT(run({"touchcal", "fleet", "--cell", "edf", "--archive", owner}).out, HasSubstr("run_started"));
  EXPECT_EQ(run({"touchcal", "fleet", "--cell", "fde", "--archive", owner}).exit_code, cell::kExitUsage);
  EXPECT_THAT(run({"touchcal", "archive", "verify", "--archive", owner}).out,
              HasSubstr("of 1 cells are in order"));
  const auto verify_with_earlier = [&](const std::string& said) {
    const Folder folder;
    const auto file = folder.path() / "earlier.json";
    std::ofstream(file) << said;
    return run({"touchcal", "archive", "verify", "--archive", owner, "--earlier", file.string()});
  };
  const std::string earlier = run({"touchcal", "archive", "verify", "--json", "--archive", owner}).out;
  EXPECT_EQ(json::parse(earlier).at("chains").at(0).at("first"), 1);
  const Finished since = verify_with_earlier(earlier);
  EXPECT_EQ(since.exit_code, cell::kExitDone);
  EXPECT_THAT(since.out, HasSubstr("edf: events 1 to "));
  EXPECT_EQ(verify_with_earlier("{}").exit_code, cell::kExitBadInput);
  EXPECT_EQ(run({"touchcal", "archive", "verify", "--without-touches", "--archive", owner}).exit_code,
            cell::kExitDone);
  postgres.sql("DELETE FROM event WHERE seq = (SELECT max(seq) FROM event)");
  EXPECT_THAT(verify_with_earlier(earlier).err, HasSubstr(" are missing"));
  postgres.sql("UPDATE event SET at = '2026-01-01T00:00:09.000Z' WHERE seq = 1");
  const Finished damaged = run({"touchcal", "archive", "verify", "--archive", owner});
  EXPECT_EQ(damaged.exit_code, cell::kExitBadInput);
  EXPECT_THAT(damaged.err, HasSubstr("cell edf, event 1: it was changed"));
  EXPECT_EQ(run({"touchcal", "fleet", "--archive", "postgresql://db.plant/touchcal"}).exit_code,
            cell::kExitUsage);
}

}  // namespace
}  // namespace touchcal::testing
