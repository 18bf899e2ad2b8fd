// A daemon whose disk answers no more ends all the same, and says what is not on it.
#include <gmock/gmock.h>

#include <boost/asio/ip/tcp.hpp>
#include <csignal>
#include <fstream>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/environment.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/service/raw_http.hpp"

namespace touchcal::testing {
namespace {

/// touchcald without a controller, whose disk stalls for ever once it is told to.
class StalledEnd : public ::testing::Test {
 protected:
  StalledEnd() {
    const Environment preload("LD_PRELOAD", TOUCHCAL_STALLED_DISK), for_ever("TOUCHCAL_STALL_FOR_EVER", "1");
    const Environment file("TOUCHCAL_STALL_FILE", stall_file_);
    daemon_.emplace(
        std::vector<std::string>{"touchcald", "--cell",
                                 std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json", "--listen",
                                 "127.0.0.1:0", "--controller", "127.0.0.1:9", "--state", state_},
        folder_ / "touchcald.err");
    host_ = daemon_->wait_for_address();
  }

  /// A stop is answered by any disk; that it was given is to be recorded.
  unsigned stop() const {
    const auto port = static_cast<unsigned short>(std::stoi(host_.substr(host_.rfind(':') + 1)));
    cell::RawClient client({boost::asio::ip::address_v4::loopback(), port});
    std::string token;
    std::ifstream(state_ + "/operate.token") >> token;
    client.send("POST /api/v1/cell/stop HTTP/1.1\r\nHost: " + host_ + "\r\nAuthorization: Bearer " + token +
                "\r\nContent-Length: 0\r\n\r\n");
    return client.receive().status;
  }
  void stall() const { std::ofstream file(stall_file_); }

  Folder folder_;
  std::string state_ = (folder_ / "state").string();
  std::string stall_file_ = (folder_ / "stall").string();
  std::optional<Process> daemon_;
  std::string host_;
};

TEST_F(StalledEnd, ASignalEndsTheDaemonAllTheSame) {
  stall();
  EXPECT_EQ(stop(), 202U);
  daemon_->signal(SIGTERM);
  const Finished finished = daemon_->wait();
  EXPECT_EQ(finished.exit_code, cell::kExitFailed);
  EXPECT_THAT(finished.err, ::testing::HasSubstr("Still to be written"));
}

TEST_F(StalledEnd, MoreSignalsKeepItFromNothing) {
  stall();
  EXPECT_EQ(stop(), 202U);
  // They may come while it stops, or while it waits for the disk; how long it waits then: end_watch_test.
  for (int i = 0; i < 3; ++i) daemon_->signal(i % 2 == 0 ? SIGTERM : SIGINT);
  const Finished finished = daemon_->wait();
  EXPECT_EQ(finished.exit_code, cell::kExitFailed);
  EXPECT_THAT(finished.err, ::testing::HasSubstr("Still to be written"));
}

TEST_F(StalledEnd, WithADiskThatAnswersItEndsInOrder) {
  EXPECT_EQ(stop(), 202U);
  daemon_->signal(SIGTERM);
  const Finished finished = daemon_->wait();
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
}

}  // namespace
}  // namespace touchcal::testing
