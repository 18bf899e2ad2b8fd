#include "service/http/server/listener.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "service/http/routes/api.hpp"
#include "tests/service/quiet_cell.hpp"
#include "tests/service/raw_http.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const HttpLimits kLimits{.host_names = {"cell-3.plant.example"}};

/// A listener on a free port, on a thread of its own; the test is its client.
class ListenerTest : public ::testing::Test {
 protected:
  explicit ListenerTest(HttpLimits limits = kLimits)
      : listener_(cell_.context().get_executor(), {boost::asio::ip::address_v4::loopback(), 0}, api_,
                  limits) {
    listener_.launch();
    server_ = std::thread([this] { cell_.context().run(); });
  }
  ~ListenerTest() override {
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
    return "POST " + target + " HTTP/1.1\r\n" + host_line() + "Authorization: Bearer " + tokens_.operate +
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
    EXPECT_EQ(json::parse(answer.body).at("status"), status) << shown;
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
    return json::parse(expect_served(200, get("/api/v1/status")).body).at("sequence");
  }

  const Tokens tokens_{std::string(64, 'a'), std::string(64, 'b')};
  QuietCell cell_;
  Api api_{cell_.context().get_executor(), cell_.operation(), tokens_};
  HttpListener listener_;
  std::thread server_;
};

TEST_F(ListenerTest, OneHostThatIsOursIsWanted) {
  const std::string line = "GET /api/v1/status HTTP/1.1\r\n";
  expect_refused(400, line + "\r\n");
  expect_refused(400, line + host_line() + host_line() + "\r\n");
  expect_refused(400, line + host_line() + "Host: evil.example\r\n\r\n");
  const std::string port = ":" + std::to_string(listener_.address().port());
  for (const std::string& foreign :
       {std::string("evil.example"), "evil.example" + port, std::string("cell-3.plant.example:1"),
        std::string("127.0.0.1:1"), std::string(), "127.0.0.1" + port + ".evil.example",
        "evil.example@" + host(), std::string(4000, 'h') + port}) {
    expect_refused(421, line + "Host: " + foreign + "\r\n\r\n");
  }
  for (const std::string& ours : {host(), "localhost" + port, "[::1]" + port, "LocalHost" + port,
                                  std::string("cell-3.plant.example"), "Cell-3.plant.example" + port}) {
    expect_served(200, line + "Host: " + ours + "\r\n\r\n");
  }
}

TEST_F(ListenerTest, Http10NeedsNoHostAndEndsTheConnection) {
  RawClient client = connect();
  client.send("GET /healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 200u);
  EXPECT_TRUE(client.closed());
  expect_refused(421, "GET /healthz HTTP/1.0\r\nHost: evil.example\r\n\r\n");
}

TEST_F(ListenerTest, TheOnlyTransferEncodingIsChunkedOnce) {
  const std::string chunks = "2\r\n{}\r\n0\r\n\r\n";
  for (const char* coding : {"xchunked", "chunked, identity", "gzip, chunked", "identity", ""})
    expect_refused(501,
                   post("/api/v1/cell/stop", std::string("Transfer-Encoding: ") + coding + "\r\n", chunks));
  expect_refused(
      400, post("/api/v1/cell/stop", "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n", chunks));
  expect_refused(501, "POST /api/v1/cell/stop HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n" + chunks);
  expect_refused(400,
                 post("/api/v1/cell/stop", "Transfer-Encoding: chunked\r\nContent-Length: 2\r\n", chunks));
  expect_refused(400,
                 post("/api/v1/cell/stop", "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n", chunks));
  expect_refused(400, post("/api/v1/cell/stop", "Transfer-Encoding: chunked\r\n", "x\r\n{}\r\n0\r\n\r\n"));
  expect_served(202, post("/api/v1/cell/stop", "Transfer-Encoding: Chunked\r\n", chunks));
}

TEST_F(ListenerTest, TheContentLengthIsOneNumber) {
  for (const char* lines :
       {"Content-Length: 2\r\nContent-Length: 2\r\n", "Content-Length: 2\r\nContent-Length: 3\r\n",
        "Content-Length: 2, 2\r\n", "Content-Length: -2\r\n", "Content-Length: +2\r\n",
        "Content-Length: 0x2\r\n", "Content-Length: 2x\r\n", "Content-Length: 99999999999999999999\r\n"}) {
    expect_refused(400, post("/api/v1/cell/stop", lines, "{}"));
  }
  expect_served(202, post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}"));
}

TEST_F(ListenerTest, OnlyAPathIsATarget) {
  for (const std::string& target :
       {std::string("http://evil.example/api/v1/status"), "http://" + host() + "/api/v1/status",
        std::string("*"), std::string("evil.example:80")}) {
    expect_refused(400, "GET " + target + " HTTP/1.1\r\n" + host_line() + "\r\n");
  }
}

TEST_F(ListenerTest, APercentEncodedTargetIsServedAndAMalformedOneIs400WithTheReason) {
  EXPECT_EQ(expect_served(200, get("/api/v1/status?wait_s=%32&after=9%39")).status, 200u);
  // Taken as the recipe edf-25, and refused for the touches document that is none.
  const RawAnswer identified =
      expect_served(400, post("/api/v1/identify?recipe=edf%2D25", "Content-Length: 2\r\n", "{}"));
  EXPECT_THAT(json::parse(identified.body).at("type"), HasSubstr(":body"));
  for (const char* target :
       {"/api/v1/status?wait_s=%zz", "/api/v1/runs/%00", "/api/v1/runs?limit=1%0a", "/%"}) {
    expect_refused(400, get(target));
    RawClient client = connect();
    client.send(get(target));
    const json problem = json::parse(client.receive().body);
    EXPECT_EQ(problem.at("type"), "urn:touchcal:problem:target");
    EXPECT_THAT(problem.at("detail"), HasSubstr("a % takes two hexadecimal digits"));
  }
}

TEST_F(ListenerTest, AStopIsTakenWhateverItsQueryIs) {
  for (const char* query : {"?%zz", "?x=%00", "?[", "?a=1&a=1"})
    expect_served(202, post(std::string("/api/v1/cell/stop") + query, "Content-Length: 2\r\n", "{}"));
  expect_refused(400, post("/api/v1/cell/reset?%zz", "Content-Length: 0\r\n", ""));
}

TEST_F(ListenerTest, WhatIsNoRequestIsToldSo) {
  for (const std::string& bytes :
       {std::string("garbage\r\n\r\n"), std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),
        std::string("GET\r\n\r\n"), std::string("GET /healthz\r\n\r\n"),
        "GET /healthz HTTP/1.2\r\n" + host_line() + "\r\n",
        "GET /healthz HTTP/2.0\r\n" + host_line() + "\r\n", "GET /healthz HTTP/1.1\n" + host_line() + "\r\n",
        "GET  /healthz HTTP/1.1\r\n" + host_line() + "\r\n", get("/healthz", "No-Colon\r\n"),
        get("/healthz", "Blank : x\r\n"), get("/healthz", std::string("Nul: a\0b\r\n", 10)),
        get("/healthz", "Return: a\rb\r\n"), get("/healthz", ": nameless\r\n")}) {
    expect_refused(400, bytes);
  }
}

TEST_F(ListenerTest, AHeaderFieldOnTwoLinesIsRefused) {
  expect_refused(400, get("/healthz", "Folded: a\r\n b\r\n"));
  expect_refused(400, get("/healthz", "Folded: a\r\n\tb\r\n"));
  expect_refused(400, get("/healthz", "Folded:\r\n \r\n"));
  const std::string folded_late = get("/healthz", "Folded: a\r\n b\r\n");
  for (std::size_t cut = 1; cut < folded_late.size(); ++cut) {
    RawClient client = connect();
    client.send(folded_late.substr(0, cut));
    client.send(folded_late.substr(cut));
    EXPECT_EQ(client.receive().status, 400u) << "in two pieces, " << cut;
  }
}

TEST_F(ListenerTest, AHeaderThatIsTooLongIs431) {
  expect_refused(431, get("/healthz", "Long: " + std::string(kLimits.header_bytes_max, 'x') + "\r\n"));
  expect_refused(431, get("/" + std::string(kLimits.header_bytes_max, 'x')));
  expect_refused(431, "GET /healthz HTTP/1.1\r\n" + std::string(kLimits.header_bytes_max, 'x'));
  expect_served(200, get("/healthz", "Long: " + std::string(kLimits.header_bytes_max / 2, 'x') + "\r\n"));
}

TEST_F(ListenerTest, ABodyThatIsTooLongIs413AndTheAnswerArrives) {
  for (const std::size_t size : {kLimits.body_bytes_max + 1, 32 * kLimits.body_bytes_max}) {
    const std::string body(size, ' ');
    expect_refused(413, post("/api/v1/runs", "Content-Length: " + std::to_string(size) + "\r\n", body));
    std::string chunks;
    for (std::size_t sent = 0; sent < size; sent += 0x1000)
      chunks += "1000\r\n" + std::string(0x1000, ' ') + "\r\n";
    expect_refused(413, post("/api/v1/runs", "Transfer-Encoding: chunked\r\n", chunks + "0\r\n\r\n"));
  }
  expect_refused(413, post("/api/v1/runs", "Content-Length: 99999999999\r\n", ""));
  const std::string largest(kLimits.body_bytes_max, ' ');
  expect_served(400,
                post("/api/v1/runs", "Content-Length: " + std::to_string(largest.size()) + "\r\n", largest));
}

TEST_F(ListenerTest, WhoeverExpectsIsToldBeforeTheBody) {
  expect_refused(417, post("/api/v1/cell/stop", "Expect: 100-continue\r\nContent-Length: 2\r\n", ""));
  expect_refused(417, post("/api/v1/cell/stop", "Expect: 100-continue\r\nContent-Length: 2\r\n", "{}"));
}

TEST_F(ListenerTest, ARefusalByTheHeaderDoesNotWaitForTheBody) {
  expect_refused(421, "POST /api/v1/runs HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 2\r\n\r\n");
}

TEST_F(ListenerTest, OtherPagesAreNotTaken) {
  for (const std::string& foreign :
       {std::string("http://evil.example"), "https://" + host(), std::string("null"),
        "http://" + host() + ".evil.example", std::string("http://127.0.0.1:1")}) {
    expect_refused(403, get("/api/v1/status", "Origin: " + foreign + "\r\n"));
  }
  expect_served(200, get("/api/v1/status", "Origin: http://" + host() + "\r\n"));
}

TEST_F(ListenerTest, HeadSaysWhatGetWouldAndNoBody) {
  const RawAnswer got = expect_served(200, get("/api/v1/runs"));
  const RawAnswer head = expect_served(200, "HEAD /api/v1/runs HTTP/1.1\r\n" + host_line() + "\r\n", true);
  EXPECT_EQ(head.header, got.header);
  EXPECT_EQ(head.header.at("content-length"), std::to_string(got.body.size()));
  expect_served(404, "HEAD /nothing HTTP/1.1\r\n" + host_line() + "\r\n", true);
  EXPECT_TRUE(expect_served(200, "HEAD /api/v1/status HTTP/1.1\r\n" + host_line() + "\r\n", true)
                  .header.contains("etag"));
}

TEST_F(ListenerTest, AKnownStatusIs304WithItsTagAndNoBody) {
  const std::string tag = expect_served(200, get("/api/v1/status")).header.at("etag");
  for (const std::string& known : {tag, "W/" + tag, "\"x\", " + tag, std::string("*")}) {
    const RawAnswer answer = expect_served(304, get("/api/v1/status", "If-None-Match: " + known + "\r\n"));
    EXPECT_EQ(answer.header.at("etag"), tag);
    EXPECT_FALSE(answer.header.contains("content-type"));
  }
  const std::string other_first = "If-None-Match: \"x\"\r\nIf-None-Match: " + tag + "\r\n";
  expect_served(304, get("/api/v1/status", other_first));
  expect_served(304, "HEAD /api/v1/status HTTP/1.1\r\n" + host_line() + "If-None-Match: " + tag + "\r\n\r\n",
                true);
  expect_served(200, get("/api/v1/status", "If-None-Match: \"x\"\r\n"));
}

TEST_F(ListenerTest, AConnectionServesRequestsInTheirOrderUntilItIsToEnd) {
  RawClient client = connect();
  client.send(get("/healthz"));
  EXPECT_EQ(client.receive().status, 200u);
  client.send(get("/nothing") + post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}") + get("/healthz") +
              get("/api/v1/status", "Connection: close\r\n") + get("/healthz"));
  for (const unsigned status : {404u, 202u, 200u, 200u}) EXPECT_EQ(client.receive().status, status);
  EXPECT_TRUE(client.closed()) << "what comes after a close is not served";
}

TEST_F(ListenerTest, BytesMayComeOneByOne) {
  const std::string request = post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}");
  RawClient client = connect();
  for (const char byte : request) client.send(std::string(1, byte));
  EXPECT_EQ(client.receive().status, 202u);
}

TEST_F(ListenerTest, MethodsAreCaseSensitiveAndOthersAreNotAllowed) {
  for (const char* method : {"get", "DELETE", "PUT", "OPTIONS", "TRACE", "PATCH", "INVENTED"}) {
    const RawAnswer answer =
        expect_served(405, std::string(method) + " /api/v1/status HTTP/1.1\r\n" + host_line() + "\r\n");
    EXPECT_EQ(answer.header.at("allow"), "GET") << method;
  }
}

TEST_F(ListenerTest, EveryAnswerForbidsStoringSniffingAndFrames) {
  const RawAnswer answer = expect_served(200, get("/healthz"));
  EXPECT_EQ(answer.header.at("cache-control"), "no-store");
  EXPECT_EQ(answer.header.at("x-content-type-options"), "nosniff");
  EXPECT_THAT(answer.header.at("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
}

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
  const std::string large(kLimits.body_bytes_max + 1, ' ');
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

class CrowdedListenerTest : public ListenerTest {
 protected:
  CrowdedListenerTest() : ListenerTest({.loopback_connections_max = 2}) {}
};

TEST_F(CrowdedListenerTest, OneAddressDoesNotTakeAllConnections) {
  RawClient first = connect();
  RawClient second = connect();
  for (RawClient* client : {&first, &second}) {
    client->send(get("/healthz"));
    EXPECT_EQ(client->receive().status, 200u);
  }
  EXPECT_TRUE(connect().closed());
  first.send(get("/healthz", "Connection: close\r\n"));
  EXPECT_EQ(first.receive().status, 200u);
  EXPECT_TRUE(first.closed());
  second.send(get("/healthz"));
  EXPECT_EQ(second.receive().status, 200u);
}

class ImpatientListenerTest : public ListenerTest {
 protected:
  ImpatientListenerTest()
      : ListenerTest({.connections_max = 1, .request_deadline = std::chrono::seconds(1)}) {}
};

TEST_F(ImpatientListenerTest, HalfARequestEndsAtTheDeadline) {
  for (const std::string& half : {std::string("G"), "GET /healthz HTTP/1.1\r\n" + host_line(),
                                  post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{"),
                                  post("/api/v1/cell/stop", "Transfer-Encoding: chunked\r\n", "2\n{}\n")}) {
    RawClient client = connect();
    client.send(half);
    const RawAnswer answer = client.receive();
    EXPECT_TRUE(answer.status == 0 || answer.status == 400) << half;
    EXPECT_TRUE(client.closed()) << half;
  }
}

TEST_F(ImpatientListenerTest, OneConnectionTooManyIsClosedAndTheOthersAreServed) {
  RawClient first = connect();
  first.send(get("/healthz"));
  EXPECT_EQ(first.receive().status, 200u);
  EXPECT_TRUE(connect().closed());
  first.send(get("/healthz"));
  EXPECT_EQ(first.receive().status, 200u);
}

}  // namespace
}  // namespace cell
