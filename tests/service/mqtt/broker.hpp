#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/mqtt/mqtt_options.hpp"

struct mosquitto;

namespace cell {

/// A mosquitto of its own on a free port, with the configuration that is shipped, in a folder with its
/// certificates (make_certificates).
class Broker {
 public:
  /// `access`: in place of the shipped access list. `keeps`: what it has outlives it, as the shipped
  /// configuration has it.
  explicit Broker(std::filesystem::path folder, const std::optional<std::string>& access = {},
                  bool keeps = false);
  ~Broker() { kill(); }
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  /// At the same port again, with what it kept.
  void start();
  void kill();
  /// It takes what it is sent and does nothing any more.
  void hang() const;
  /// Lets it write what it has, as it does now and then, and waits until the file is there.
  void save() const;

  /// As the owner of these two files, `NAME.crt` and `NAME.key`.
  [[nodiscard]] MqttOptions options_of(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::uint16_t port_ = 0;
  std::atomic<pid_t> pid_ = -1;
};

struct Message {
  std::string topic;
  std::string text;
  bool retained = false;
};

/// A subscriber to all of the plant, which looks when it is asked.
class Subscriber {
 public:
  /// `client_id`: none for one that the broker makes.
  explicit Subscriber(const MqttOptions& options, const char* client_id = nullptr);
  ~Subscriber();
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  /// All so far, when there are `count`; fewer where they do not come.
  const std::vector<Message>& wait_for(std::size_t count);

 private:
  std::unique_ptr<mosquitto, void (*)(mosquitto*)> client_;
  bool is_subscribed_ = false;
  std::vector<Message> messages_;
};

}  // namespace cell
