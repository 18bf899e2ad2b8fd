#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "service/http/routes/api.hpp"
#include "service/http/server/listener.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"
#include "tests/service/raw_http.hpp"

namespace cell {

inline const HttpLimits kServedLimits{.host_names = {{"cell-3.plant.example"}, {"robot.example", 8443}}};

/// A listener on a free port, on a thread of its own; the test is its client.
class ServedApi : public ::testing::Test {
 protected:
  explicit ServedApi(HttpLimits limits = kServedLimits)
      : listener_(cell_.context().get_executor(), {boost::asio::ip::address_v4::loopback(), 0}, api_,
                  limits) {
    listener_.launch();
    server_ = std::thread([this] { cell_.context().run(); });
  }
  ~ServedApi() override {
    cell_.context().stop();
    server_.join();
  }

  [[nodiscard]] RawClient connect() const { return RawClient(listener_.address()); }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(listener_.address().port()); }
  [[nodiscard]] std::string host_line() const { return "Host: " + host() + "\r\n"; }
  [[nodiscard]] std::string get(const std::string& target, const std::string& lines = "") const {
    return "GET " + target + " HTTP/1.1\r\n" + host_line() + lines + "\r\n";
  }
  [[nodiscard]] std::string post(const std::string& target, const std::string& lines,
                                 const std::string& body) const {
    return "POST " + target + " HTTP/1.1\r\n" + host_line() + "Authorization: Bearer " + kTokens.operate +
           "\r\nContent-Type: application/json\r\n" + lines + "\r\n" + body;
  }

  /// Sends `bytes` and expects a problem document of `status` and the end of the connection.
  void expect_refused(unsigned status, const std::string& bytes) const {
    const std::string shown = bytes.substr(0, 200);
    RawClient client = connect();
    client.send(bytes);
    RawAnswer answer = client.receive();
    EXPECT_EQ(answer.status, status) << shown << '\n' << answer.body;
    if (answer.status == 0) return;
    EXPECT_EQ(answer.header.at("content-type"), "application/problem+json") << shown;
    EXPECT_EQ(nlohmann::json::parse(answer.body).at("status"), status) << shown;
    if (shown.find("HTTP/1.0") == std::string::npos) {
      EXPECT_EQ(answer.header["connection"], "close") << shown;
    }
    EXPECT_TRUE(client.closed()) << shown;
  }

  /// Sends one request and expects `status`, and that the connection serves the next one.
  RawAnswer expect_served(unsigned status, const std::string& bytes, bool head = false) const {
    RawClient client = connect();
    client.send(bytes);
    RawAnswer answer = client.receive(head);
    EXPECT_EQ(answer.status, status) << bytes << '\n' << answer.body;
    client.send(get("/healthz"));
    EXPECT_EQ(client.receive().status, 200u) << "next after " << bytes;
    return answer;
  }

  std::uint64_t sequence() const {
    return nlohmann::json::parse(expect_served(200, get("/api/v1/status")).body).at("sequence");
  }

  QuietCell cell_;
  Api api_{cell_.context().get_executor(), cell_.operation(), kTokens};
  HttpListener listener_;
  std::thread server_;
};

}  // namespace cell
