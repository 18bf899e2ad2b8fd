#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "service/base/clocks.hpp"
#include "service/base/latest_text.hpp"
#include "service/mqtt/mqtt_options.hpp"
#include "service/plant/sink.hpp"

namespace cell {

/// What a broker is told of the cell besides its facts.
struct MqttCell {
  std::string name;
  std::int64_t instance = 0;           // count of the daemon's starts
  std::shared_ptr<LatestText> status;  // document of the status
  /// The document of the model that is the cell's now; nothing where none is. Called on the sink's thread.
  std::function<std::optional<std::string>()> approved;
  Clocks clocks;
};

/// How long a broker may be silent.
struct MqttDeadlines {
  std::chrono::milliseconds connect{5000};
  std::chrono::milliseconds welcome{10'000};  // to its CONNACK, with TLS
  std::chrono::milliseconds confirm{30'000};  // from one PUBACK to the next
};

/// A sink that publishes over MQTT 5, in which a broker says what it does not take. Topics begin with
/// touchcal/v1/CELL/: `online` (birth, will and end, retained), `state` and `approved` (retained) and
/// `event/KIND`, all with QoS 1; it subscribes to nothing. Connects; SinkTrouble where that fails or takes
/// longer than the deadlines.
std::unique_ptr<Sink> connect_mqtt(const MqttOptions& options, const MqttCell& cell,
                                   const std::stop_token& ending, const MqttDeadlines& deadlines = {});

}  // namespace cell
