#pragma once

#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/service/raw_http.hpp"

namespace touchcal::testing {

/// touchcald as a process without a controller, and its client, which sends the bytes it is given.
class ServedDaemon : public ::testing::Test {
 protected:
  explicit ServedDaemon(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{
        "touchcald",   "--cell",      std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json",
        "--listen",    "127.0.0.1:0", "--controller",
        "127.0.0.1:9", "--state",     (folder_ / "state").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    daemon_.emplace(arguments, folder_ / "touchcald.err");
    host_ = daemon_->wait_for_address();
    const auto port = static_cast<unsigned short>(std::stoi(host_.substr(host_.rfind(':') + 1)));
    endpoint_ = {boost::asio::ip::address_v4::loopback(), port};
    operate_ = token("operate.token");
    view_ = token("view.token");
  }

  /// Whatever it was sent, the daemon answers, and ends at a signal as it should.
  void TearDown() override {
    EXPECT_EQ(answer_to(request("GET", "/healthz")).status, 200U);
    daemon_->signal(SIGTERM);
    const Finished finished = daemon_->wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  }

  /// The first answer; status 0 when there is none.
  [[nodiscard]] cell::RawAnswer answer_to(const std::string& bytes, bool send_no_more = false) const {
    cell::RawClient client(endpoint_, from_);
    client.send(bytes);
    if (send_no_more) client.send_no_more();
    return client.receive();
  }
  /// `lines` are header lines, each with its line break.
  [[nodiscard]] std::string request(const std::string& method, const std::string& target,
                                    const std::string& lines = "", const std::string& body = "") const {
    const std::string length = body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return method + ' ' + target + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + lines + length + "\r\n" + body;
  }
  [[nodiscard]] static std::string bearer(const std::string& token) {
    return "Authorization: Bearer " + token + "\r\n";
  }

  std::optional<boost::asio::ip::address_v4> from_;  // where requests come from; the system's choice
  std::string host_;
  std::string operate_;
  std::string view_;

 private:
  [[nodiscard]] std::string token(const std::string& file) const {
    std::ifstream stream(folder_ / ("state/" + file));
    std::string text;
    stream >> text;
    return text;
  }

  Folder folder_;
  std::optional<Process> daemon_;
  boost::asio::ip::tcp::endpoint endpoint_;
};

}  // namespace touchcal::testing
