#pragma once

#include <mosquitto.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "service/mqtt/mqtt_options.hpp"

namespace bench {

/// Who hears all events of a plant, on a thread of its own: its session outlives its connection, and it comes
/// back when the broker does. Events that come again are dropped by cell and number, as surfaces.md asks it
/// to.
class PlantReader {
 public:
  /// Returns when it has subscribed; std::runtime_error where that cannot be.
  explicit PlantReader(cell::MqttOptions options);

  /// SHA-256 of each fact by its number, as it came first.
  [[nodiscard]] std::map<std::int64_t, std::string> heard() const;
  /// Facts that came with a number of another one.
  [[nodiscard]] int contradicted() const;
  /// How often a fact came that had come before.
  [[nodiscard]] int repeated() const;

 private:
  using Client = std::unique_ptr<mosquitto, void (*)(mosquitto*)>;

  /// Null where the broker is away.
  Client subscribed();
  void note(const std::string& topic, const std::string& text);

  mutable std::mutex mutex_;
  std::map<std::int64_t, std::string> heard_;
  int contradicted_ = 0, repeated_ = 0;
  bool is_subscribed_ = false;
  cell::MqttOptions options_;
  Client client_;
  std::jthread thread_;  // the last member: it uses all others
};

}  // namespace bench
