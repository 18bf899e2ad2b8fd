#include "tests/benchmark/plant_reader.hpp"

#include <poll.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace bench {
namespace {

constexpr int kLookMs = 50;
constexpr std::chrono::seconds kPatience{30};

}  // namespace

PlantReader::PlantReader(const cell::MqttOptions& options) : client_(nullptr, mosquitto_destroy) {
  mosquitto_lib_init();
  client_.reset(mosquitto_new("plant-reader", false, this));
  mosquitto_tls_set(client_.get(), options.authority.c_str(), nullptr, options.certificate.c_str(),
                    options.key.c_str(), nullptr);
  mosquitto_connect_callback_set(client_.get(), [](mosquitto* client, void*, int) {
    mosquitto_subscribe(client, nullptr, "touchcal/v1/+/event/#", 1);
  });
  mosquitto_subscribe_callback_set(client_.get(), [](mosquitto*, void* self, int, int, const int*) {
    static_cast<PlantReader*>(self)->is_subscribed_ = true;
  });
  mosquitto_message_callback_set(client_.get(), [](mosquitto*, void* self, const mosquitto_message* message) {
    static_cast<PlantReader*>(self)->note(message->topic,
                                          std::string(static_cast<const char*>(message->payload),
                                                      static_cast<std::size_t>(message->payloadlen)));
  });
  mosquitto_connect(client_.get(), options.host.c_str(), options.port, 60);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!is_subscribed_) {
    if (mosquitto_loop(client_.get(), kLookMs, 1) != MOSQ_ERR_SUCCESS ||
        std::chrono::steady_clock::now() > end)
      throw std::runtime_error("the plant's reader is not let in by the broker");
  }
  thread_ = std::jthread([this](const std::stop_token& ending) {
    while (!ending.stop_requested()) {
      // Without a connection the library's loop is content, too.
      const bool is_connected = mosquitto_socket(client_.get()) >= 0;
      if (is_connected && mosquitto_loop(client_.get(), kLookMs, 1) == MOSQ_ERR_SUCCESS) continue;
      if (mosquitto_reconnect(client_.get()) != MOSQ_ERR_SUCCESS) ::poll(nullptr, 0, kLookMs);
    }
  });
}

void PlantReader::note(const std::string& topic, const std::string& text) {
  const nlohmann::json event = nlohmann::json::parse(text, nullptr, false);
  const std::lock_guard lock(mutex_);
  if (!event.is_object() || !event.contains("seq") || !event.contains("sha256")) {
    std::printf("%s: no event: %s\n", topic.c_str(), text.c_str());
    ++contradicted_;
    return;
  }
  const auto [known, is_new] = heard_.emplace(event.at("seq").get<std::int64_t>(), event.at("sha256"));
  if (is_new) return;
  ++(known->second == event.at("sha256") ? repeated_ : contradicted_);
}

std::map<std::int64_t, std::string> PlantReader::heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

int PlantReader::contradicted() const {
  const std::lock_guard lock(mutex_);
  return contradicted_;
}

int PlantReader::repeated() const {
  const std::lock_guard lock(mutex_);
  return repeated_;
}

}  // namespace bench
