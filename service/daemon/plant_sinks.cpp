#include "service/daemon/plant_sinks.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "service/archive/archive_sink.hpp"
#include "service/daemon/daemon.hpp"
#include "service/mqtt/mqtt_sink.hpp"
#include "service/store/model_store.hpp"

namespace cell {

namespace {

/// A broker writes what it keeps for its subscribers now and then: the shipped configuration every minute.
constexpr std::chrono::seconds kBrokerMayLose{120};

/// The document of the model that is the cell's now, over a connection of its own.
std::optional<std::string> approved_document(const std::filesystem::path& store) {
  const ModelStore models(open_database_to_read(store));
  const auto standing = standing_approvals(models.history());
  return standing.empty() ? std::nullopt : models.document(standing.back().id);
}

}  // namespace

std::vector<std::string> configured_sinks(const DaemonOptions& options) {
  std::vector<std::string> sinks;
  if (options.mqtt) sinks.emplace_back(kMqttSink);
  if (options.archive) sinks.emplace_back(kArchiveSink);
  return sinks;
}

PlantSinks::PlantSinks(const RunStore& store, boost::asio::any_io_executor disk)
    : store_(store), disk_(std::move(disk)) {}

void PlantSinks::begin(const DaemonOptions& options, const std::string& cell, std::int64_t instance,
                       const Clocks& clocks) {
  if (options.archive) {
    add(
        std::string(kArchiveSink),
        [url = *options.archive, cell, store = store_.file(),
         clock = clocks.system](const std::stop_token& ending) {
          return connect_archive(url, cell, store, ending, kArchivePatience, clock);
        },
        std::chrono::seconds(0), clocks);
  }
  if (!options.mqtt) return;
  const MqttCell told{.name = cell,
                      .instance = instance,
                      .status = status_,
                      .approved = [store = store_.file()] { return approved_document(store); },
                      .clocks = clocks};
  add(
      std::string(kMqttSink),
      [mqtt = *options.mqtt, told](const std::stop_token& ending) {
        return connect_mqtt(mqtt, told, ending);
      },
      kBrokerMayLose, clocks);
}

void PlantSinks::add(const std::string& name,
                     std::function<std::unique_ptr<Sink>(const std::stop_token&)> connect,
                     std::chrono::seconds may_lose, const Clocks& clocks) {
  const auto confirmed = [&store = store_, disk = disk_, name](std::int64_t seq) {
    boost::asio::post(disk, [&store, name, seq] {
      try {
        Outbox(store.database()).confirm(name, seq);
      } catch (const std::exception& error) {
        spdlog::warn("{}: what it has confirmed could not be stored, and will be sent again: {}", name,
                     error.what());
      }
    });
  };
  threads_.emplace_back(SinkParts{.name = name,
                                  .store = store_.file(),
                                  .states = states_,
                                  .connect = std::move(connect),
                                  .may_lose = may_lose,
                                  .clock = clocks.steady,
                                  .confirmed = confirmed});
}

}  // namespace cell
