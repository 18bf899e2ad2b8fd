#pragma once

#include <optional>
#include <pqxx/pqxx>
#include <string>
#include <vector>

#include "service/archive/archive_schema.hpp"
#include "tests/service/archive/postgres.hpp"
#include "tests/service/mqtt/broker.hpp"
#include "tests/service/mqtt/certificates.hpp"

namespace bench {

/// A broker that keeps what it has, and a prepared archive in which one cell may write.
class PlantBeside {
 public:
  explicit PlantBeside(const std::string& cell) : cell_(cell) {
    cell::prepare_archive(database.url());
    database.sql("CREATE ROLE " + cell + " LOGIN IN ROLE touchcal_writer");
  }

  /// Of a touchcald that tells them.
  [[nodiscard]] std::vector<std::string> daemon_options() const {
    const cell::MqttOptions mqtt = broker.options_of(cell_);
    return {"--archive",   database.url(cell_),
            "--mqtt",      "mqtts://127.0.0.1:" + std::to_string(mqtt.port),
            "--mqtt-ca",   mqtt.authority.string(),
            "--mqtt-cert", mqtt.certificate.string(),
            "--mqtt-key",  mqtt.key.string()};
  }

  /// From now on neither answers, and both take what they are sent.
  void hang() {
    broker.hang();
    lock_.emplace(database.url());
  }

  cell::Postgres database;
  cell::Broker broker{cell::certificates(), {}, true};

 private:
  /// All who write wait for it.
  struct Lock {
    explicit Lock(const std::string& url) : connection(url) { work.exec0("LOCK TABLE event"); }
    pqxx::connection connection;
    pqxx::work work{connection};
  };

  std::string cell_;
  std::optional<Lock> lock_;
};

}  // namespace bench
