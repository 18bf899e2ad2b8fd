#include "service/mqtt/mqtt_sink.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "service/plant/sink_thread.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/mqtt/broker.hpp"
#include "tests/service/mqtt/certificates.hpp"
#include "tests/service/mqtt/slow_line.hpp"

namespace cell {
namespace {

namespace asio = boost::asio;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;

constexpr const char* kTopics = "touchcal/v1/cell-1/";

/// A cell that tells a broker, at a folder's store.
class MqttSinkTest : public ::testing::Test {
 protected:
  [[nodiscard]] MqttCell cell(std::int64_t instance) {
    return {
        .name = "cell-1",
        .instance = instance,
        .status = status_,
        .approved = [this] { return approved_; },
        .clocks = {[] { return std::chrono::system_clock::time_point{}; }, std::chrono::steady_clock::now}};
  }
  std::unique_ptr<Sink> connect(const Broker& broker, std::int64_t instance = 1) {
    return connect_mqtt(broker.options_of("cell-1"), cell(instance), {});
  }
  std::vector<Fact> facts() { return OutboxReader(file_).next(0, 100); }
  void begin_run() { store_.begin_run({.recipe = "edf-25", .started_at = "then"}); }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  std::shared_ptr<LatestText> status_ = std::make_shared<LatestText>();
  std::optional<std::string> approved_;
};

TEST_F(MqttSinkTest, TellsBirthStateModelAndEventsToWhoMayReadThem) {
  Broker broker(certificates());
  status_->put(R"({"state":"IDLE"})");
  approved_ = R"({"hash":"a"})";
  begin_run();
  auto sink = connect(broker, 7);
  EXPECT_EQ(sink->deliver(facts(), {}), 1);
  Subscriber late(broker.options_of("plant-reader"));
  std::map<std::string, Message> retained;
  for (const Message& message : late.wait_for(3)) retained[message.topic] = message;
  ASSERT_EQ(retained.size(), 3u) << "an event is not retained";
  for (const auto& [topic, message] : retained) EXPECT_TRUE(message.retained) << topic;
  EXPECT_EQ(retained[std::string(kTopics) + "state"].text, R"({"state":"IDLE"})");
  EXPECT_EQ(retained[std::string(kTopics) + "approved"].text, R"({"hash":"a"})");
  const json birth = json::parse(retained[std::string(kTopics) + "online"].text);
  EXPECT_EQ(birth.at("online"), true);
  EXPECT_EQ(birth.at("instance"), 7);

  status_->put(R"({"state":"EXECUTE"})");
  ModelStore(store_.database())
      .approve({.run_id = 1, .at = "then", .hash = "b", .document = "{}", .arm_json = "{}"});
  approved_ = R"({"hash":"b"})";
  const std::vector<Fact> told = facts();
  EXPECT_EQ(sink->deliver(told, {}), 2);
  std::map<std::string, std::string> live;
  for (const Message& message : late.wait_for(7)) live[message.topic] = message.text;
  EXPECT_EQ(live[std::string(kTopics) + "state"], R"({"state":"EXECUTE"})");
  EXPECT_EQ(live[std::string(kTopics) + "approved"], R"({"hash":"b"})");
  const json event = json::parse(live[std::string(kTopics) + "event/approved"]);
  EXPECT_EQ(event, (json{{"schema", "touchcal/event/1"},
                         {"cell", "cell-1"},
                         {"seq", 2},
                         {"instance", 0},
                         {"kind", "approved"},
                         {"at", "then"},
                         {"run", "1"},
                         {"previous", told[0].sha256},
                         {"body", json::parse(told[1].body)},
                         {"sha256", told[1].sha256}}));
  sink.reset();
  const json end = json::parse(late.wait_for(8).back().text);
  EXPECT_EQ(end.at("online"), false);
  EXPECT_EQ(end.at("at"), "1970-01-01T00:00:00.000Z") << "told, not missed";
}

TEST_F(MqttSinkTest, AWillOfTheStartBeforeComesBeforeTheNextBirth) {
  Broker broker(certificates());
  Subscriber plant(broker.options_of("plant-reader"));
  const auto first = connect(broker, 1);
  plant.wait_for(2);  // its birth, and that no model is approved
  const auto second = connect(broker, 2);
  std::vector<json> online;
  for (const Message& message : plant.wait_for(5))
    if (message.topic.ends_with("/online")) online.push_back(json::parse(message.text));
  ASSERT_EQ(online.size(), 3u);
  EXPECT_EQ(online[1].at("instance"), 1);
  EXPECT_EQ(online[1].at("online"), false);
  EXPECT_TRUE(online[1].at("at").is_null()) << "the will";
  EXPECT_EQ(online[2].at("instance"), 2);
  EXPECT_EQ(online[2].at("online"), true);
  EXPECT_THAT(
      [&] {
        for (int i = 0; i < 100; ++i) first->rest(250ms, {});
      },
      ThrowsMessage<SinkTrouble>(HasSubstr("the connection broke off")));
}

TEST_F(MqttSinkTest, ABrokerThatStopsAndComesBackWithNothingGetsAllThatItHasNotConfirmed) {
  Broker broker(certificates());
  begin_run();
  std::promise<void> first_confirmed, all_confirmed;
  const auto states = std::make_shared<SinkStates>();
  std::optional<Subscriber> plant;
  std::string trouble;
  bool is_first = true;
  const SinkThread thread({.name = "mqtt",
                           .store = file_,
                           .states = states,
                           .connect = [&](const std::stop_token&) { return connect(broker); },
                           .confirmed =
                               [&](std::int64_t seq) {
                                 if (std::exchange(is_first, false)) first_confirmed.set_value();
                                 if (seq == 3) all_confirmed.set_value();
                               },
                           .wait =
                               [&](std::stop_token, std::chrono::milliseconds) {
                                 if (plant) return;
                                 trouble = states->of("mqtt")->trouble.value_or("");
                                 broker.start();
                                 plant.emplace(broker.options_of("plant-reader"));
                               }});
  first_confirmed.get_future().wait();
  broker.kill();
  begin_run();
  begin_run();
  all_confirmed.get_future().wait();
  EXPECT_THAT(trouble, HasSubstr("the broker 127.0.0.1"));
  std::vector<std::int64_t> seen;
  bool is_born = false;
  for (const Message& message : plant->wait_for(4)) {
    is_born = is_born || message.topic.ends_with("/online");
    if (message.topic.ends_with("/event/run_started")) seen.push_back(json::parse(message.text).at("seq"));
  }
  EXPECT_TRUE(is_born) << "what is retained is told again";
  EXPECT_THAT(seen, ::testing::ElementsAre(2, 3));
}

TEST_F(MqttSinkTest, ASlowBrokerIsWaitedForWhileItConfirms) {
  Broker broker(certificates());
  Subscriber plant(broker.options_of("plant-reader"));
  MqttOptions options = broker.options_of("cell-1");
  const SlowLine line(options.port, 200, 20ms);
  options.port = line.port();
  constexpr int kFacts = 60;
  for (int i = 0; i < kFacts; ++i) begin_run();
  const MqttDeadlines deadlines{.connect = 5s, .welcome = 30s, .confirm = 1500ms};
  const auto sink = connect_mqtt(options, cell(1), {}, deadlines);
  status_->put(R"({"state":"EXECUTE"})");
  const auto begun_at = std::chrono::steady_clock::now();
  EXPECT_EQ(sink->deliver(facts(), {}), kFacts);
  EXPECT_GT(std::chrono::steady_clock::now() - begun_at, deadlines.confirm) << "else the line is not slow";
  std::vector<std::int64_t> seen;
  bool has_state = false;
  for (const Message& message :
       plant.wait_for(kFacts + 3)) {  // with birth, status and that no model is approved
    has_state = has_state || message.topic.ends_with("/state");
    if (message.topic.ends_with("/event/run_started")) seen.push_back(json::parse(message.text).at("seq"));
  }
  EXPECT_TRUE(has_state);
  ASSERT_EQ(seen.size(), static_cast<std::size_t>(kFacts));
  EXPECT_TRUE(std::ranges::is_sorted(seen)) << "each once, in order";
  EXPECT_EQ(seen.back(), kFacts);
}

TEST_F(MqttSinkTest, FactsComeInTheirOrderWhateverTheClockSaysThatWroteThem) {
  Broker broker(certificates());
  Subscriber plant(broker.options_of("plant-reader"));
  for (const char* year : {"2026", "2031", "1970"})
    store_.begin_run({.recipe = "edf-25", .started_at = std::string(year) + "-01-01T00:00:00.000Z"});
  EXPECT_EQ(connect(broker)->deliver(facts(), {}), 3);
  std::vector<std::string> at;
  for (const Message& message : plant.wait_for(5))
    if (message.topic.ends_with("/event/run_started"))
      at.push_back(json::parse(message.text).at("at").get<std::string>().substr(0, 4));
  EXPECT_THAT(at, ::testing::ElementsAre("2026", "2031", "1970")) << "seq tells their order";
}

TEST_F(MqttSinkTest, WhoIsNotTakenIsToldWhy) {
  Broker broker(certificates());
  MqttOptions options = broker.options_of("foreign");
  EXPECT_THAT([&] { connect_mqtt(options, cell(1), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("cannot be connected")));
  options = broker.options_of("cell-1");
  options.authority = certificates() / "other.crt";
  EXPECT_THAT([&] { connect_mqtt(options, cell(1), {}); },
              ThrowsMessage<SinkTrouble>(AllOf(HasSubstr("certificate verify failed"),
                                               HasSubstr("over by this machine's clock (1970-01-01T"))));
  options = broker.options_of("cell-2");
  EXPECT_THAT([&] { connect_mqtt(options, cell(1), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("is of 'cell-2'")));
  options = broker.options_of("cell-1");
  broker.kill();
  EXPECT_THAT([&] { connect_mqtt(options, cell(1), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("is not reached")));
}

TEST_F(MqttSinkTest, ABrokerWhoseAccessListKeepsTheCellOutConfirmsNothing) {
  Broker broker(certificates(), "user plant-reader\ntopic read touchcal/v1/#\n");
  const auto all = [&] {
    const auto sink = connect(broker);
    begin_run();
    sink->deliver(facts(), {});
  };
  EXPECT_THAT(all, ThrowsMessage<SinkTrouble>(
                       AllOf(HasSubstr("refuses touchcal/v1/cell-1/"), HasSubstr("Not authorized"))));
}

/// Takes a connection, answers its first bytes with these and then nothing.
class MuteBroker {
 public:
  explicit MuteBroker(std::string answer)
      : acceptor_(context_, {asio::ip::address_v4::loopback(), 0}), answer_(std::move(answer)) {
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~MuteBroker() {
    context_.stop();
    thread_.join();
  }
  /// All bytes that it was sent, once whoever sent them has ended the connection.
  std::size_t heard_to_the_end() {
    ended_.get_future().wait();
    return heard_bytes_;
  }
  [[nodiscard]] MqttOptions options() const {
    return {.host = "127.0.0.1", .port = acceptor_.local_endpoint().port()};
  }

 private:
  void accept() {
    acceptor_.async_accept([this](const boost::system::error_code&, asio::ip::tcp::socket socket) {
      sockets_.push_back(std::make_unique<asio::ip::tcp::socket>(std::move(socket)));
      hear(*sockets_.back(), answer_);
      accept();
    });
  }

  void hear(asio::ip::tcp::socket& from, const std::string& answer) {
    from.async_read_some(asio::buffer(heard_),
                         [this, &from, answer](const boost::system::error_code& failure, std::size_t bytes) {
                           heard_bytes_ += bytes;
                           if (failure) {
                             if (!std::exchange(has_ended_, true)) ended_.set_value();
                             return;
                           }
                           boost::system::error_code ignored;
                           asio::write(from, asio::buffer(answer), ignored);
                           hear(from, {});
                         });
  }

  asio::io_context context_{1};
  asio::ip::tcp::acceptor acceptor_;
  std::string answer_;
  std::size_t heard_bytes_ = 0;
  bool has_ended_ = false;
  std::promise<void> ended_;
  std::array<char, 1024> heard_{};
  std::vector<std::unique_ptr<asio::ip::tcp::socket>> sockets_;
  std::thread thread_;
};

TEST_F(MqttSinkTest, NobodyTakesTheConnectionOfACellByItsClientId) {
  Broker broker(certificates());
  begin_run();
  auto sink = connect(broker);
  const Subscriber another(broker.options_of("cell-2"), "touchcal-cell-1");
  const Subscriber by_name(broker.options_of("plant-reader"), "cell-1");
  EXPECT_EQ(sink->deliver(facts(), {}), 1) << "the connection is the same";
}

TEST_F(MqttSinkTest, ABrokerThatIsSilentIsNotWaitedFor) {
  const MqttDeadlines soon{.connect = 5s, .welcome = 50ms, .confirm = 50ms};
  const MuteBroker deaf("");
  EXPECT_THAT([&] { connect_mqtt(deaf.options(), cell(1), {}, soon); },
              ThrowsMessage<SinkTrouble>(HasSubstr("listens and does not answer")));
  const MuteBroker polite(std::string("\x20\x03\x00\x00\x00", 5));  // CONNACK, and no PUBACK ever
  MqttDeadlines patient = soon;
  patient.welcome = 10s;
  const auto sink = connect_mqtt(polite.options(), cell(1), {}, patient);
  begin_run();
  EXPECT_THAT([&] { sink->deliver(facts(), {}); },
              ThrowsMessage<SinkTrouble>(HasSubstr("does not confirm them")));
  const MuteBroker refusing(std::string("\x20\x03\x00\x87\x00", 5));
  EXPECT_THAT([&] { connect_mqtt(refusing.options(), cell(1), {}, patient); },
              ThrowsMessage<SinkTrouble>(HasSubstr("refuses this cell: Not authorized")));
}

TEST_F(MqttSinkTest, OfAThousandStatusesOneWaitsForABrokerThatDoesNotConfirm) {
  MuteBroker polite(std::string("\x20\x03\x00\x00\x00", 5));
  auto sink = connect_mqtt(polite.options(), cell(1), {}, {.connect = 5s, .welcome = 10s, .confirm = 50ms});
  constexpr std::size_t kStatusBytes = 1000;
  for (int change = 0; change < 1000; ++change) {
    status_->put(std::string(kStatusBytes, 'x'));
    sink->rest(0ms, {});
  }
  sink.reset();
  EXPECT_LT(polite.heard_to_the_end(), 2 * kStatusBytes) << "with birth and end";
}

}  // namespace
}  // namespace cell
