#include "service/mqtt/mqtt_options.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"
#include "tests/service/mqtt/certificates.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(MqttOptions, AreReadFromAnAddress) {
  EXPECT_EQ(mqtt_from_url("mqtt://broker")->port, 1883);
  EXPECT_FALSE(mqtt_from_url("mqtt://broker")->tls);
  const auto tls = mqtt_from_url("mqtts://broker.plant/");
  EXPECT_EQ(tls->host, "broker.plant");
  EXPECT_EQ(tls->port, 8883);
  EXPECT_TRUE(tls->tls);
  EXPECT_EQ(mqtt_from_url("mqtts://[::1]:18883")->host, "::1");
  EXPECT_EQ(mqtt_from_url("mqtts://[::1]:18883")->port, 18883);
}

TEST(MqttOptions, RefuseWhatIsMoreThanAHostAndAPort) {
  for (const char* url :
       {"", "broker", "broker:1883", "http://broker", "mqtt://", "mqtt://:1883", "mqtt://broker:0",
        "mqtt://broker:65536", "mqtt://broker:x", "mqtt://user:word@broker", "mqtt://broker/topic",
        "mqtt://broker?x=1", "mqtt://broker#x", "mqtt://bro ker"})
    EXPECT_FALSE(mqtt_from_url(url)) << url;
}

TEST(MqttFiles, AreThoseOfTheCell) {
  const auto& folder = certificates();
  const auto options = [&](const std::string& certificate, const std::string& key) {
    return MqttOptions{.host = "h",
                       .port = 1,
                       .tls = true,
                       .authority = folder / "ca.crt",
                       .certificate = folder / certificate,
                       .key = folder / key};
  };
  EXPECT_NO_THROW(demand_mqtt_files(options("cell-1.crt", "cell-1.key"), "cell-1"));
  const auto refusal = [&](const std::string& certificate, const std::string& key, const std::string& cell) {
    return [=] { demand_mqtt_files(options(certificate, key), cell); };
  };
  EXPECT_THAT(refusal("cell-2.crt", "cell-2.key", "cell-1"),
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("is of 'cell-2'"), HasSubstr("this cell is 'cell-1'"))));
  EXPECT_THAT(refusal("cell-1.crt", "cell-2.key", "cell-1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("is not the key of")));
  EXPECT_THAT(refusal("none.crt", "cell-1.key", "cell-1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("--mqtt-cert")));
  EXPECT_THAT(refusal("cell-1.key", "cell-1.key", "cell-1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("holds no certificate")));
  EXPECT_THAT(refusal("cell-1.crt", "cell-1.crt", "cell-1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("holds no key")));
  EXPECT_THAT(refusal("cell-1.crt", "cell-1.key", "cell/1"),
              ThrowsMessage<std::runtime_error>(HasSubstr("topic")));
  MqttOptions without = options("cell-1.crt", "cell-1.key");
  without.authority = folder / "none.crt";
  EXPECT_THAT([&] { demand_mqtt_files(without, "cell-1"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--mqtt-ca")));
}

}  // namespace
}  // namespace cell
