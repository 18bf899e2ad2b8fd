#include "service/http/server/listener.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <iterator>
#include <list>
#include <new>
#include <nlohmann/json.hpp>

#include "service/http/server/internal/accepting.hpp"
#include "tests/service/http/server/served_api.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Many connections: waiting, large and slow ones, and too many of them.
class ListenerTest : public ServedApi {};

TEST_F(ListenerTest, ALongPollAnswersWhenTheStatusChanges) {
  const std::uint64_t before = sequence();
  RawClient waiting = connect();
  waiting.send(get("/api/v1/status?wait_s=60&after=" + std::to_string(before)));
  expect_served(202, post("/api/v1/cell/reset", "Content-Length: 0\r\n", ""));
  const RawAnswer answer = waiting.receive();
  EXPECT_EQ(answer.status, 200u);
  EXPECT_GT(json::parse(answer.body).at("sequence").get<std::uint64_t>(), before);
  EXPECT_EQ(json::parse(answer.body).at("state"), "RESETTING");
}

TEST_F(ListenerTest, ALongPollAnswersWhenItsTimeIsUpOrItKnowsAnotherStatus) {
  const std::uint64_t before = sequence();
  for (const std::string& query :
       {"wait_s=1&after=" + std::to_string(before), "wait_s=0&after=" + std::to_string(before),
        "wait_s=60&after=" + std::to_string(before + 1)}) {
    const RawAnswer answer = expect_served(200, get("/api/v1/status?" + query));
    EXPECT_EQ(json::parse(answer.body).at("sequence").get<std::uint64_t>(), before) << query;
  }
}

TEST_F(ListenerTest, TheStatusChangesArriveAsEventsUntilTheReaderGoes) {
  RawClient reader = connect();
  reader.send(get("/api/v1/events"));
  RawAnswer answer = reader.receive();
  EXPECT_EQ(answer.status, 200u);
  EXPECT_EQ(answer.header.at("content-type"), "text/event-stream");
  EXPECT_THAT(reader.receive_until("\n\n"), HasSubstr("retry: "));
  EXPECT_THAT(reader.receive_until("\n\n"), HasSubstr("event: status\nid: instance-"));
  expect_served(202, post("/api/v1/cell/reset", "Content-Length: 0\r\n", ""));
  EXPECT_THAT(reader.receive_until("\n\n"), HasSubstr("\"state\":\"RESETTING\""));
}

TEST_F(ListenerTest, ATouchesDocumentMayBeLargerThanOtherBodies) {
  const std::string large(kServedLimits.body_bytes_max + 1, ' ');
  const auto lines = [](std::size_t size) { return "Content-Length: " + std::to_string(size) + "\r\n"; };
  expect_served(400, post("/api/v1/identify", lines(large.size()), large));
  const std::string too_large(kTouchesBytesMax + 1, ' ');
  expect_refused(413, post("/api/v1/identify", lines(too_large.size()), too_large));
  const std::string chunk = "10001\r\n" + std::string(0x10001, ' ') + "\r\n0\r\n\r\n";
  expect_served(400, post("/api/v1/identify", "Transfer-Encoding: chunked\r\n", chunk));
  expect_refused(413, post("/api/v1/runs", "Transfer-Encoding: chunked\r\n", chunk));
}

TEST_F(ListenerTest, WhatIsWrongInABodyIsToldAndNothingHappens) {
  const std::uint64_t before = sequence();
  const std::string nul("{\"recipe\":\"edf-25\"}\0", 21);
  for (const std::string& body : {std::string("{"),
                                  std::string("[]"),
                                  std::string("null"),
                                  std::string("\"edf-25\""),
                                  std::string("\xef\xbb\xbf{\"recipe\":\"edf-25\"}"),
                                  nul,
                                  std::string("{\"recipe\":\"\xff\"}"),
                                  std::string("{\"recipe\":\"edf-25\"}x"),
                                  std::string("{\"recipe\":\"edf-25\"}{}"),
                                  std::string("{\"recipe\":\"edf-25\",\"recipe\":\"edf-25\"}"),
                                  std::string("{\"recipe\":1}"),
                                  std::string("{\"recipe\":1e999}"),
                                  std::string("{\"recipe\":true}"),
                                  std::string("{\"recipe\":[]}"),
                                  std::string("{\"recipe\":null}"),
                                  std::string("{\"recipe\":\"edf-25\",\"plan_id\":\"x\"}"),
                                  std::string("{\"recipe\":\"edf-25\",\"operator\":1}"),
                                  std::string("{\"recipe\":\"edf-25\",\"operator\":\"\"}"),
                                  "{\"recipe\":\"edf-25\",\"operator\":\"" + std::string(101, 'o') + "\"}",
                                  std::string("{\"recipe\":\"edf-25\",\"touching\":1}"),
                                  std::string("{\"recipe\":\"edf-25\",\"touching\":\"by foot\"}"),
                                  std::string("{\"recipe\":\"edf-25\",\"block_temperature_c\":\"20\"}"),
                                  std::string("{\"recipe\":\"edf-25\",\"block_temperature_c\":293.15}"),
                                  std::string("{\"recipe\":\"edf-25\",\"unknown\":1}"),
                                  std::string("{'recipe':'edf-25'}"),
                                  std::string("{\"recipe\":\"edf-25\",}"),
                                  std::string("{\"recipe\":NaN}"),
                                  std::string(30000, '['),
                                  std::string(30000, '[') + std::string(30000, ']')}) {
    const RawAnswer answer = expect_served(
        400, post("/api/v1/runs", "Content-Length: " + std::to_string(body.size()) + "\r\n", body));
    EXPECT_TRUE(json::parse(answer.body).contains("pointer")) << body.substr(0, 80);
  }
  EXPECT_EQ(sequence(), before);
}

TEST_F(ListenerTest, AFieldThatDecidesSomethingStandsOnce) {
  for (const char* field : {"Authorization: Bearer x\r\n", "Content-Type: text/plain\r\n"})
    expect_refused(400, post("/api/v1/cell/reset", std::string(field) + "Content-Length: 0\r\n", ""));
  expect_refused(400, post("/api/v1/cell/reset",
                           "Idempotency-Key: a\r\nIdempotency-Key: b\r\nContent-Length: 0\r\n", ""));
}

class CrowdedListenerTest : public ServedApi {
 protected:
  CrowdedListenerTest() : ServedApi({.connections = {.loopback_connections_max = 2}}) {}

  [[nodiscard]] std::string get_with_token() const {
    return get("/healthz", "Authorization: Bearer " + kTokens.view + "\r\n");
  }
};

TEST_F(CrowdedListenerTest, TheOldestConnectionWithoutATokenGoesForANewOne) {
  RawClient operating = connect();
  operating.send(get_with_token());
  EXPECT_EQ(operating.receive().status, 200u);
  RawClient silent = connect();
  // Each of them is served, and the one with the token is still there.
  for (int i = 0; i < 10; ++i) {
    RawClient next = connect();
    next.send(post("/api/v1/cell/stop", "Content-Length: 0\r\nConnection: close\r\n", ""));
    EXPECT_EQ(next.receive().status, 202u);
  }
  EXPECT_TRUE(silent.closed());
  operating.send(get("/healthz"));
  EXPECT_EQ(operating.receive().status, 200u);
}

TEST_F(CrowdedListenerTest, AStopGetsThroughWhereAllConnectionsHaveAToken) {
  RawClient first = connect();
  RawClient second = connect();
  for (RawClient* client : {&first, &second, &first}) {
    client->send(get_with_token());
    EXPECT_EQ(client->receive().status, 200u);
  }
  RawClient stopping = connect();
  stopping.send(post("/api/v1/cell/stop", "Content-Length: 0\r\n", ""));
  EXPECT_EQ(stopping.receive().status, 202u);
  EXPECT_TRUE(second.closed()) << "it was idle longest";
  RawClient next = connect();
  next.send(get_with_token());
  EXPECT_EQ(next.receive().status, 200u);
  EXPECT_TRUE(first.closed());
  stopping.send(get("/healthz"));
  EXPECT_EQ(stopping.receive().status, 200u) << "who operates stays";
}

TEST_F(CrowdedListenerTest, WhoFollowsTheEventsStaysLongerThanWhoIsIdle) {
  RawClient following = connect();
  following.send(get("/api/v1/events", "Authorization: Bearer " + kTokens.view + "\r\n"));
  EXPECT_EQ(following.receive().status, 200u);
  following.receive_until("\n\n");
  following.receive_until("\n\n");
  RawClient idle = connect();
  idle.send(post("/api/v1/cell/stop", "Content-Length: 0\r\n", ""));
  EXPECT_EQ(idle.receive().status, 202u);
  RawClient next = connect();
  next.send(get("/healthz"));
  EXPECT_EQ(next.receive().status, 200u);
  EXPECT_TRUE(idle.closed());
  expect_served(202, post("/api/v1/cell/reset", "Content-Length: 0\r\n", ""));
  EXPECT_THAT(following.receive_until("\n\n"), HasSubstr("\"state\":\"RESETTING\""));
}

class FloodedListenerTest : public ServedApi {
 protected:
  FloodedListenerTest() : ServedApi({.connections = {.loopback_connections_max = 16}}) {}
};

TEST_F(FloodedListenerTest, AStopThatComesLateOnItsConnectionGetsThroughAFloodWithTheViewToken) {
  RawClient stopping = connect();
  const std::string view = "Authorization: Bearer " + kTokens.view + "\r\n";
  std::list<RawClient> flood;
  for (int i = 0; i < 40; ++i) {
    flood.emplace_back(listener_.address());
    flood.back().send(get("/healthz", view));
    EXPECT_EQ(flood.back().receive().status, 200u);
  }
  stopping.send(post("/api/v1/cell/stop", "Content-Length: 0\r\n", ""));
  EXPECT_EQ(stopping.receive().status, 202u);
}

TEST_F(ListenerTest, EventStreamsAndLongPollsDoNotHoldAStopUp) {
  const std::uint64_t before = sequence();
  std::list<RawClient> waiting;
  const auto add = [&](const std::string& request) {
    waiting.emplace_back(listener_.address());
    waiting.back().send(request);
  };
  constexpr int kStreams = 32;
  for (int i = 0; i < kStreams; ++i) {
    add(get("/api/v1/events"));
    EXPECT_EQ(waiting.back().receive().status, 200u);
  }
  for (int i = 0; i < 128; ++i) add(get("/api/v1/status?wait_s=60&after=" + std::to_string(before)));
  for (int i = 0; i < 3; ++i) {
    RawClient stopping = connect();
    stopping.send(post("/api/v1/cell/stop", "Content-Length: 0\r\n", ""));
    EXPECT_EQ(stopping.receive().status, 202u);
  }
  expect_served(202, post("/api/v1/cell/reset", "Content-Length: 0\r\n", ""));
  waiting.erase(waiting.begin(), std::next(waiting.begin(), kStreams));
  for (RawClient& poll : waiting) EXPECT_EQ(poll.receive().status, 200u) << "and they are answered";
}

class ImpatientListenerTest : public ServedApi {
 protected:
  ImpatientListenerTest()
      : ServedApi({.connections = {.connections_max = 1}, .request_deadline = std::chrono::seconds(1)}) {}
};

TEST_F(ImpatientListenerTest, HalfARequestEndsAtTheDeadline) {
  for (const std::string& half : {std::string("G"), "GET /healthz HTTP/1.1\r\n" + host_line(),
                                  post("/api/v1/cell/reset", "Content-Length: 2\r\n", "{"),
                                  post("/api/v1/cell/reset", "Transfer-Encoding: chunked\r\n", "2\n{}\n")}) {
    RawClient client = connect();
    client.send(half);
    const RawAnswer answer = client.receive();
    EXPECT_TRUE(answer.status == 0 || answer.status == 400) << half;
    EXPECT_TRUE(client.closed()) << half;
  }
}

TEST_F(ImpatientListenerTest, AConnectionThatSaysNothingEndsAtTheDeadlineOfItsFirstRequest) {
  RawClient silent = connect();
  EXPECT_TRUE(silent.closed());
}

TEST(AcceptConnections, OneWithoutMemoryIsNotTheLast) {
  namespace asio = boost::asio;
  using asio::ip::tcp;
  asio::io_context context;
  tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  int seen = 0;
  const auto serve = [&](const tcp::socket&) {
    if (++seen == 1) throw std::bad_alloc();
    acceptor.close();
  };
  asio::co_spawn(context, accept_connections<tcp>(acceptor, serve), asio::detached);
  tcp::socket first(context), second(context);
  first.connect(acceptor.local_endpoint());
  second.connect(acceptor.local_endpoint());
  context.run();
  EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace cell
