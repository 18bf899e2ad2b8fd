#include "service/acquisition/cs8_controller.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <optional>

namespace cell {
namespace {

using boost::asio::ip::tcp;
using ::testing::StartsWith;

/// Where nobody listens: a port that is bound, so that nobody else can take it.
class Cs8ControllerTest : public ::testing::Test {
 protected:
  Cs8ControllerTest() {
    const tcp::endpoint any_port(boost::asio::ip::address_v4::loopback(), 0);
    held_port_.open(any_port.protocol());
    held_port_.bind(any_port);
  }
  cs8::LinkError connect_to(const std::string& host) {
    Cs8Controller controller(io_.get_executor(), {.connect = std::chrono::milliseconds(500)},
                             {host, held_port_.local_endpoint().port()});
    std::optional<cs8::ConnectReply> reply;
    boost::asio::co_spawn(
        io_, controller.connect({}),
        [&reply](const std::exception_ptr&, cs8::ConnectReply given) { reply = std::move(given); });
    io_.restart();
    while (!reply) io_.run_one();
    return std::get<cs8::LinkError>(*reply);
  }

  boost::asio::io_context io_{1};
  tcp::socket held_port_{io_};
};

TEST_F(Cs8ControllerTest, ConnectsToAnAddressAndToAName) {
  for (const char* host : {"127.0.0.1", "localhost"}) {
    const cs8::LinkError error = connect_to(host);
    EXPECT_EQ(error.kind, cs8::LinkErrorKind::kUnreachable);
    EXPECT_THAT(error.text, StartsWith("no connection: "));
  }
}

TEST_F(Cs8ControllerTest, ANameThatIsNotKnownIsNamed) {
  const cs8::LinkError error = connect_to("no.such.host.invalid");
  EXPECT_EQ(error.kind, cs8::LinkErrorKind::kUnreachable);
  EXPECT_THAT(error.text, StartsWith("no.such.host.invalid: "));
}

}  // namespace
}  // namespace cell
