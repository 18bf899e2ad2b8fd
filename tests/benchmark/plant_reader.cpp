#include "tests/benchmark/plant_reader.hpp"

#include <poll.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace bench {
namespace {

constexpr int kLookMs = 50;
/// From a connection to the answer to its subscription.
constexpr std::chrono::seconds kPatience{5};

}  // namespace

PlantReader::PlantReader(cell::MqttOptions options)
    : options_(std::move(options)), client_(nullptr, mosquitto_destroy) {
  mosquitto_lib_init();
  client_ = subscribed();
  if (!client_) throw std::runtime_error("the plant's reader is not let in by the broker");
  thread_ = std::jthread([this](const std::stop_token& ending) {
    while (!ending.stop_requested()) {
      // A new one each time: one whose broker was killed in the middle of a connection stays where it is.
      if (!client_) client_ = subscribed();
      if (!client_)
        ::poll(nullptr, 0, kLookMs);
      else if (mosquitto_loop(client_.get(), kLookMs, 1) != MOSQ_ERR_SUCCESS)
        client_.reset();
    }
  });
}

PlantReader::Client PlantReader::subscribed() {
  Client client(mosquitto_new("plant-reader", false, this), mosquitto_destroy);
  mosquitto_tls_set(client.get(), options_.authority.c_str(), nullptr, options_.certificate.c_str(),
                    options_.key.c_str(), nullptr);
  mosquitto_connect_callback_set(client.get(), [](mosquitto* connected, void*, int) {
    mosquitto_subscribe(connected, nullptr, "touchcal/v1/+/event/#", 1);
  });
  mosquitto_subscribe_callback_set(client.get(), [](mosquitto*, void* self, int, int, const int*) {
    static_cast<PlantReader*>(self)->is_subscribed_ = true;
  });
  mosquitto_message_callback_set(client.get(), [](mosquitto*, void* self, const mosquitto_message* message) {
    static_cast<PlantReader*>(self)->note(message->topic,
                                          std::string(static_cast<const char*>(message->payload),
                                                      static_cast<std::size_t>(message->payloadlen)));
  });
  is_subscribed_ = false;
  bool goes_on =
      mosquitto_connect(client.get(), options_.host.c_str(), options_.port, 60) == MOSQ_ERR_SUCCESS;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (goes_on && !is_subscribed_)
    goes_on = mosquitto_loop(client.get(), kLookMs, 1) == MOSQ_ERR_SUCCESS &&
              std::chrono::steady_clock::now() < end;
  if (!goes_on) client.reset();
  return client;
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
