#include "service/daemon/supervision.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/datagram_protocol.hpp>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

namespace asio = boost::asio;
using asio::local::datagram_protocol;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The socket that systemd hands to a service.
class SupervisionTest : public ::testing::Test {
 protected:
  SupervisionTest() : socket_(io_, datagram_protocol::endpoint((folder_.path() / "notify").string())) {
    setenv("NOTIFY_SOCKET", (folder_.path() / "notify").c_str(), 1);
    socket_.non_blocking(true);
  }
  ~SupervisionTest() override {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(name);
  }

  /// The next message; empty when there is none.
  std::string told() {
    std::string message(1000, '\0');
    boost::system::error_code none;
    message.resize(socket_.receive(asio::buffer(message), 0, none));
    return message;
  }

  Folder folder_;
  asio::io_context io_{1};
  datagram_protocol::socket socket_;
};

TEST_F(SupervisionTest, TellsWhenTheDaemonServesAndWhenItStops) {
  Supervision supervision(io_.get_executor());
  EXPECT_EQ(told(), "");
  supervision.notify_ready("cell demo");
  EXPECT_EQ(told(), "READY=1\nSTATUS=cell demo");
  EXPECT_EQ(told(), "") << "nobody waits for a sign of life";
  supervision.notify_stopping();
  EXPECT_THAT(told(), StartsWith("STOPPING=1"));
}

TEST_F(SupervisionTest, GivesSignsOfLifeOnlyAsLongAsTheThreadTurns) {
  setenv("WATCHDOG_USEC", "3000", 1);
  Supervision supervision(io_.get_executor());
  supervision.notify_ready("cell demo");
  EXPECT_THAT(told(), HasSubstr("READY=1"));
  EXPECT_EQ(told(), "WATCHDOG=1");
  EXPECT_EQ(told(), "") << "a thread that does not turn is silent";
  io_.run_one();
  EXPECT_EQ(told(), "WATCHDOG=1");
}

TEST_F(SupervisionTest, IsSilentWhereNobodyListens) {
  unsetenv("NOTIFY_SOCKET");
  Supervision supervision(io_.get_executor());
  supervision.notify_ready("cell demo");
  EXPECT_EQ(told(), "");
}

}  // namespace
}  // namespace cell
