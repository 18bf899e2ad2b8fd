#include "service/mqtt/mqtt_sink.hpp"

#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <map>
#include <utility>

#include "service/base/utc_time.hpp"
#include "service/base/version.hpp"
#include "service/documents/event_document.hpp"

namespace cell {
namespace {

namespace asio = boost::asio;

constexpr int kQos = 1;
constexpr int kKeepAliveSeconds = 15;
constexpr int kInFlightMax = 100;
/// How long one look at the socket takes at most: an end is seen so late.
constexpr std::chrono::milliseconds kSocketLook{250};
/// An answer from here on is a refusal.
constexpr int kFirstRefusal = 0x80;

/// Of the process; made by the first sink.
struct MosquittoLibrary {
  MosquittoLibrary() { mosquitto_lib_init(); }
  ~MosquittoLibrary() { mosquitto_lib_cleanup(); }
};

/// The library connects without a bound of time: whether somebody listens there is found out before.
void demand_listener(const MqttOptions& options, std::chrono::milliseconds within) {
  asio::io_context context(1);
  asio::ip::tcp::resolver resolver(context);
  asio::ip::tcp::socket socket(context);
  boost::system::error_code failure = asio::error::timed_out;
  resolver.async_resolve(
      options.host, std::to_string(options.port),
      [&](const boost::system::error_code& unresolved, const auto& found) {
        failure = unresolved;
        if (unresolved) return;
        failure = asio::error::timed_out;
        asio::async_connect(
            socket, found, [&](const boost::system::error_code& refused, const auto&) { failure = refused; });
      });
  context.run_for(within);
  if (failure)
    throw SinkTrouble(
        fmt::format("the broker {}:{} is not reached: {}", options.host, options.port, failure.message()));
}

class MqttSink final : public Sink {
 public:
  MqttSink(const MqttOptions& options, MqttCell cell, const std::stop_token& ending,
           const MqttDeadlines& deadlines)
      : cell_(std::move(cell)),
        deadlines_(deadlines),
        place_(fmt::format("{}:{}", options.host, options.port)),
        client_(make_client(options)) {
    welcome(options, ending);
    retain("online", document_text(online(true)));
    publish_approved();
    if (const auto status = cell_.status->take()) retain(kState, *status);
  }

  ~MqttSink() override {
    if (!is_welcome_) return;
    try {
      const auto end = cell_.clocks.steady() + kEndPatience;
      retain("online", document_text(online(false)));
      while (!waiting_.empty() && cell_.clocks.steady() < end) look(kSocketLook);
      mosquitto_disconnect_v5(client_.get(), 0, nullptr);
    } catch (const std::exception&) {
      // Then the broker tells it, by the will.
    }
  }

  std::int64_t deliver(std::span<const Fact> facts, std::stop_token ending) override {
    publish_status();
    for (const Fact& fact : facts) {
      const int id = publish("event/" + fact.kind, document_text(event_of(fact, cell_.name)), false);
      open_facts_.emplace(id, fact.seq);
    }
    auto silent_from = cell_.clocks.steady();
    while (!open_facts_.empty() && !ending.stop_requested()) {
      const std::size_t before = open_facts_.size();
      look(kSocketLook);
      publish_status();
      const auto now = cell_.clocks.steady();
      if (open_facts_.size() < before) silent_from = now;
      if (now - silent_from > deadlines_.confirm)
        throw SinkTrouble(fmt::format("the broker {} takes events and does not confirm them", place_));
    }
    std::int64_t confirmed = facts.back().seq;
    for (const auto& [id, seq] : open_facts_) confirmed = std::min(confirmed, seq - 1);
    for (const Fact& fact : facts) {
      if (fact.kind != fact_kind_name(FactKind::kApproved) &&
          fact.kind != fact_kind_name(FactKind::kRolledBack))
        continue;
      publish_approved();
      break;
    }
    return confirmed;
  }

  void rest(std::chrono::milliseconds time, std::stop_token) override {
    publish_status();
    look(std::min(time, kSocketLook));
  }

 private:
  using Client = std::unique_ptr<mosquitto, void (*)(mosquitto*)>;
  static constexpr std::chrono::milliseconds kEndPatience{1000};
  static constexpr const char* kState = "state";

  [[nodiscard]] OnlineDocument online(bool is_online) const {
    OnlineDocument document{.cell = cell_.name, .instance = cell_.instance, .online = is_online};
    document.version = kVersion;
    document.at = format_utc(cell_.clocks.system());
    return document;
  }
  [[nodiscard]] std::string topic(const std::string& behind) const {
    return "touchcal/v1/" + cell_.name + "/" + behind;
  }
  [[nodiscard]] SinkTrouble trouble(int code, const char* what) const {
    std::string words = last_words_.empty() ? "" : " (" + last_words_ + ")";
    // The library does not say which, and of a clock that stands wrong nobody would think.
    if (last_words_.find("certificate verify failed") != std::string::npos)
      words += fmt::format(
          "; the broker's certificate is not of --mqtt-ca, has another name, or is over by this machine's "
          "clock ({})",
          format_utc(cell_.clocks.system()));
    return SinkTrouble(fmt::format("the broker {}: {}: {}{}", place_, what, mosquitto_strerror(code), words));
  }
  void demand(int code, const char* what) const {
    if (code != MOSQ_ERR_SUCCESS) throw trouble(code, what);
  }

  Client make_client(const MqttOptions& options) {
    static const MosquittoLibrary library;
    // A second daemon with this name takes the place of the first, which the log shows.
    Client client(mosquitto_new(("touchcal-" + cell_.name).c_str(), true, this), mosquitto_destroy);
    if (!client) throw std::bad_alloc();
    mosquitto* raw = client.get();
    demand(mosquitto_int_option(raw, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5), "its protocol");
    demand(mosquitto_int_option(raw, MOSQ_OPT_SEND_MAXIMUM, kInFlightMax), "what it takes at once");
    OnlineDocument gone = online(false);
    gone.at.reset();
    const std::string will = document_text(gone);
    demand(mosquitto_will_set_v5(raw, topic("online").c_str(), static_cast<int>(will.size()), will.data(),
                                 kQos, true, nullptr),
           "the will");
    if (options.tls) {
      const bool has_own = !options.certificate.empty();
      demand(mosquitto_tls_set(raw, options.authority.c_str(), nullptr,
                               has_own ? options.certificate.c_str() : nullptr,
                               has_own ? options.key.c_str() : nullptr, nullptr),
             "the certificates");
    }
    mosquitto_connect_v5_callback_set(raw,
                                      [](mosquitto*, void* self, int reason, int, const mosquitto_property*) {
                                        static_cast<MqttSink*>(self)->answer_ = reason;
                                      });
    mosquitto_publish_v5_callback_set(
        raw, [](mosquitto*, void* self, int id, int reason, const mosquitto_property*) {
          static_cast<MqttSink*>(self)->on_confirmed(id, reason);
        });
    mosquitto_log_callback_set(raw, [](mosquitto*, void* self, int level, const char* text) {
      if (level == MOSQ_LOG_ERR || level == MOSQ_LOG_WARNING)
        static_cast<MqttSink*>(self)->last_words_ = text;
    });
    return client;
  }

  void welcome(const MqttOptions& options, const std::stop_token& ending) {
    // A certificate that the broker does not take ends either call: TLS 1.3 tells it after the handshake.
    constexpr const char* kNotConnected = "it cannot be connected";
    demand(mosquitto_connect_bind_v5(client_.get(), options.host.c_str(), options.port, kKeepAliveSeconds,
                                     nullptr, nullptr),
           kNotConnected);
    const auto end = cell_.clocks.steady() + deadlines_.welcome;
    while (!answer_) {
      if (ending.stop_requested() || cell_.clocks.steady() > end)
        throw SinkTrouble(fmt::format("the broker {} listens and does not answer", place_));
      // A refusal is an error of the protocol to the library.
      const int result = mosquitto_loop(client_.get(), static_cast<int>(kSocketLook.count()), 1);
      if (!answer_ || *answer_ == MQTT_RC_SUCCESS) demand(result, kNotConnected);
    }
    if (*answer_ != MQTT_RC_SUCCESS)
      throw SinkTrouble(
          fmt::format("the broker {} refuses this cell: {}", place_, mosquitto_reason_string(*answer_)));
    is_welcome_ = true;
  }

  void look(std::chrono::milliseconds time) {
    demand(mosquitto_loop(client_.get(), static_cast<int>(time.count()), 1), "the connection broke off");
    if (refusal_) throw SinkTrouble(*std::exchange(refusal_, std::nullopt));
  }

  int publish(const std::string& behind, const std::string& text, bool retained) {
    int id = 0;
    demand(mosquitto_publish_v5(client_.get(), &id, topic(behind).c_str(), static_cast<int>(text.size()),
                                text.data(), kQos, retained, nullptr),
           "it does not take a message");
    waiting_.emplace(id, behind);
    return id;
  }
  void retain(const std::string& behind, const std::string& text) { publish(behind, text, true); }

  /// One at a time: a slow broker gets the latest then, and not each that there was.
  void publish_status() {
    constexpr auto is_status = [](const auto& sent) { return sent.second == kState; };
    if (std::ranges::any_of(waiting_, is_status)) return;
    if (const auto status = cell_.status->take_new()) retain(kState, *status);
  }
  /// An empty message takes away the one that is retained.
  void publish_approved() { retain("approved", cell_.approved().value_or("")); }

  /// Called by the library inside look(): what is thrown here would not get through.
  void on_confirmed(int id, int reason) {
    const auto sent = waiting_.extract(id);
    const bool is_refused = reason >= kFirstRefusal;
    if (is_refused && !sent.empty())
      refusal_ = fmt::format(
          "the broker {} refuses {}: {}; its access list has to let the certificate's cell write there",
          place_, topic(sent.mapped()), mosquitto_reason_string(reason));
    if (!is_refused) open_facts_.erase(id);
  }

  MqttCell cell_;
  MqttDeadlines deadlines_;
  std::string place_;
  std::optional<int> answer_;  // to the connection
  bool is_welcome_ = false;
  std::string last_words_;                  // of the library
  std::map<int, std::string> waiting_;      // message id: topic
  std::map<int, std::int64_t> open_facts_;  // message id: number of the fact
  std::optional<std::string> refusal_;
  Client client_;  // the last: its callbacks use the others
};

}  // namespace

std::unique_ptr<Sink> connect_mqtt(const MqttOptions& options, const MqttCell& cell,
                                   const std::stop_token& ending, const MqttDeadlines& deadlines) {
  try {
    demand_mqtt_files(options, cell.name);
  } catch (const std::runtime_error& error) {
    throw SinkTrouble(error.what());
  }
  demand_listener(options, deadlines.connect);
  return std::make_unique<MqttSink>(options, cell, ending, deadlines);
}

}  // namespace cell
