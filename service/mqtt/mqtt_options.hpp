#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cell {

/// Where the broker is, and who this cell is to it.
struct MqttOptions {
  std::string host;
  std::uint16_t port = 0;
  bool tls = false;
  std::filesystem::path authority;    // PEM: who has signed the broker's certificate; needed with TLS
  std::filesystem::path certificate;  // PEM: the cell's own, its CN the name of the cell; with `key`, or none
  std::filesystem::path key;          // PEM
};

/// mqtt://HOST[:PORT] (1883) or mqtts://HOST[:PORT] (8883), in which nothing else stands: no user, as a
/// command line shows it to everybody, and no path. Nothing for another text.
std::optional<MqttOptions> mqtt_from_url(std::string_view url);

/// Throws std::runtime_error, with the remedy, where the broker cannot be reached like that, whatever it
/// says: a file that is missing or holds no certificate or key, a key of another certificate, a certificate
/// of another cell, one that has ended; a cell whose name cannot stand in a topic.
void demand_mqtt_files(const MqttOptions& options, const std::string& cell);

}  // namespace cell
