#include "service/http/server/session.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/service/http/server/served_api.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Messages of one connection: what is a request, and what an answer holds.
class SessionTest : public ServedApi {};

TEST_F(SessionTest, OneHostThatIsOursIsWanted) {
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

TEST_F(SessionTest, Http10NeedsNoHostAndEndsTheConnection) {
  RawClient client = connect();
  client.send("GET /healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(client.receive().status, 200u);
  EXPECT_TRUE(client.closed());
  expect_refused(421, "GET /healthz HTTP/1.0\r\nHost: evil.example\r\n\r\n");
}

TEST_F(SessionTest, TheOnlyTransferEncodingIsChunkedOnce) {
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
  expect_refused(400, post("/api/v1/cell/reset", "Transfer-Encoding: chunked\r\n", "x\r\n{}\r\n0\r\n\r\n"));
  expect_served(202, post("/api/v1/cell/reset", "Transfer-Encoding: Chunked\r\n", chunks));
}

TEST_F(SessionTest, ChunkExtensionsAreRefusedAlsoWhereTheyDoNotEnd) {
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  expect_refused(400, post("/api/v1/cell/reset", chunked, "2;a=b\r\n{}\r\n0\r\n\r\n"));
  expect_refused(400, post("/api/v1/cell/reset", chunked, "2\r\n{}\r\n0;a=b\r\n\r\n"));
  const std::string endless(3 * kServedLimits.header_bytes_max, 'x');
  expect_refused(400, post("/api/v1/cell/reset", chunked, "2;a=" + endless));
  expect_refused(400, post("/api/v1/cell/reset", chunked, "2\r\n{}\r\n0\r\nTrailer: " + endless));
}

TEST_F(SessionTest, TrailersAreNoHeaders) {
  const std::string begin = "POST /api/v1/cell/reset HTTP/1.1\r\n" + host_line() +
                            "Transfer-Encoding: chunked\r\nContent-Type: application/json\r\n";
  const std::string token = "Authorization: Bearer " + kTokens.operate + "\r\n";
  const std::string chunks = "2\r\n{}\r\n0\r\n";
  RawClient client = connect();
  client.send(begin + "\r\n" + chunks + token + "\r\n");
  EXPECT_EQ(client.receive().status, 401u) << "the token has to stand in the header";
  expect_served(202, begin + token + "\r\n" + chunks +
                         "Connection: close\r\nIdempotency-Key: a\r\nOrigin: http://evil.example\r\n\r\n");
}

TEST_F(SessionTest, WhatTheHeaderDecidesIsAnsweredBeforeTheBody) {
  const auto begun = [&](const std::string& target, const std::string& lines) {
    RawClient client = connect();
    client.send("POST " + target + " HTTP/1.1\r\n" + host_line() + lines +
                "Content-Length: 1000000\r\n\r\n{");
    RawAnswer answer = client.receive();
    EXPECT_EQ(answer.header["connection"], "close") << target << lines;
    return answer.status;
  };
  const std::string json_type = "Content-Type: application/json\r\n";
  const auto token = [](const std::string& text) { return "Authorization: Bearer " + text + "\r\n"; };
  EXPECT_EQ(begun("/api/v1/identify", json_type), 401u);
  EXPECT_EQ(begun("/api/v1/identify", json_type + token(std::string(64, 'x'))), 401u);
  EXPECT_EQ(begun("/api/v1/identify", json_type + token(kTokens.view)), 403u);
  EXPECT_EQ(begun("/nothing", json_type + token(kTokens.operate)), 404u);
  EXPECT_EQ(begun("/api/v1/status", json_type + token(kTokens.operate)), 405u);
  EXPECT_EQ(begun("/api/v1/runs", json_type + token(kTokens.operate)), 413u);
  EXPECT_EQ(begun("/api/v1/identify", token(kTokens.operate)), 415u);
}

TEST_F(SessionTest, AStopDoesNotWaitForItsBodyHoweverLargeItIs) {
  const std::string body = "Content-Length: 100000000\r\n";
  RawClient client = connect();
  client.send(post("/api/v1/cell/stop", body, std::string(100000, 'x')));
  RawAnswer answer = client.receive();
  EXPECT_EQ(answer.status, 202u);
  EXPECT_EQ(answer.header["connection"], "close");
  RawClient chunked = connect();
  chunked.send(post("/api/v1/cell/stop", "Transfer-Encoding: chunked\r\n", "x;"));
  EXPECT_EQ(chunked.receive().status, 202u);
  expect_served(202, post("/api/v1/cell/stop", "Content-Length: 9\r\n", "no object"));
}

TEST_F(SessionTest, AStopComesThroughAProxyThatEndsTlsAtAnotherPort) {
  const auto stop = [&](const std::string& as, const std::string& origin) {
    return "POST /api/v1/cell/stop HTTP/1.1\r\nHost: " + as + "\r\nOrigin: " + origin +
           "\r\nAuthorization: Bearer " + kTokens.operate + "\r\nContent-Length: 0\r\n\r\n";
  };
  expect_served(202, stop("robot.example:8443", "https://robot.example:8443"));
  expect_served(202, stop(host(), "https://robot.example:8443"));
  expect_refused(421, stop("robot.example:8444", "https://robot.example:8443"));
  expect_refused(403, stop(host(), "https://robot.example:8444"));
}

class SmallBudgetTest : public ServedApi {
 protected:
  SmallBudgetTest() : ServedApi({.bodies_bytes_max = 1000}) {}
};

TEST_F(SmallBudgetTest, BodiesTogetherAreBoundedAndTheRoomOfOneThatEndedIsFree) {
  const std::string body(700, ' ');
  const std::string lines = "Content-Length: 700\r\n";
  RawClient slow = connect();
  slow.send(post("/api/v1/identify", lines, body.substr(100)));
  expect_refused(503, post("/api/v1/identify", lines, body));
  slow.send(body.substr(0, 100));
  EXPECT_EQ(slow.receive().status, 400u) << "no touches document, but it was received";
  expect_served(400, post("/api/v1/identify", lines, body));
}

TEST_F(SessionTest, TheContentLengthIsOneNumber) {
  for (const char* lines :
       {"Content-Length: 2\r\nContent-Length: 2\r\n", "Content-Length: 2\r\nContent-Length: 3\r\n",
        "Content-Length: 2, 2\r\n", "Content-Length: -2\r\n", "Content-Length: +2\r\n",
        "Content-Length: 0x2\r\n", "Content-Length: 2x\r\n", "Content-Length: 99999999999999999999\r\n"}) {
    expect_refused(400, post("/api/v1/cell/stop", lines, "{}"));
  }
  expect_served(202, post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}"));
}

TEST_F(SessionTest, OnlyAPathIsATarget) {
  for (const std::string& target :
       {std::string("http://evil.example/api/v1/status"), "http://" + host() + "/api/v1/status",
        std::string("*"), std::string("evil.example:80")}) {
    expect_refused(400, "GET " + target + " HTTP/1.1\r\n" + host_line() + "\r\n");
  }
}

TEST_F(SessionTest, APercentEncodedTargetIsServedAndAMalformedOneIs400WithTheReason) {
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

TEST_F(SessionTest, AStopIsTakenWhateverItsQueryIs) {
  for (const char* query : {"?%zz", "?x=%00", "?[", "?a=1&a=1"})
    expect_served(202, post(std::string("/api/v1/cell/stop") + query, "Content-Length: 2\r\n", "{}"));
  expect_refused(400, post("/api/v1/cell/reset?%zz", "Content-Length: 0\r\n", ""));
}

TEST_F(SessionTest, WhatIsNoRequestIsToldSo) {
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

TEST_F(SessionTest, AHeaderFieldOnTwoLinesIsRefused) {
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

TEST_F(SessionTest, AHeaderThatIsTooLongIs431) {
  expect_refused(431, get("/healthz", "Long: " + std::string(kServedLimits.header_bytes_max, 'x') + "\r\n"));
  expect_refused(431, get("/" + std::string(kServedLimits.header_bytes_max, 'x')));
  expect_refused(431, "GET /healthz HTTP/1.1\r\n" + std::string(kServedLimits.header_bytes_max, 'x'));
  expect_served(200,
                get("/healthz", "Long: " + std::string(kServedLimits.header_bytes_max / 2, 'x') + "\r\n"));
}

TEST_F(SessionTest, ABodyThatIsTooLongIs413AndTheAnswerArrives) {
  for (const std::size_t size : {kServedLimits.body_bytes_max + 1, 32 * kServedLimits.body_bytes_max}) {
    const std::string body(size, ' ');
    expect_refused(413, post("/api/v1/runs", "Content-Length: " + std::to_string(size) + "\r\n", body));
    std::string chunks;
    for (std::size_t sent = 0; sent < size; sent += 0x1000)
      chunks += "1000\r\n" + std::string(0x1000, ' ') + "\r\n";
    expect_refused(413, post("/api/v1/runs", "Transfer-Encoding: chunked\r\n", chunks + "0\r\n\r\n"));
  }
  expect_refused(413, post("/api/v1/runs", "Content-Length: 99999999999\r\n", ""));
  const std::string largest(kServedLimits.body_bytes_max, ' ');
  expect_served(400,
                post("/api/v1/runs", "Content-Length: " + std::to_string(largest.size()) + "\r\n", largest));
}

TEST_F(SessionTest, WhoeverExpectsIsToldBeforeTheBody) {
  expect_refused(417, post("/api/v1/runs", "Expect: 100-continue\r\nContent-Length: 2\r\n", ""));
  expect_refused(417, post("/api/v1/runs", "Expect: 100-continue\r\nContent-Length: 2\r\n", "{}"));
}

TEST_F(SessionTest, AStopIsExecutedWhateverItExpects) {
  for (const std::string expected : {"100-continue", "100-Continue", "something else", ""}) {
    for (const char* body : {"", "{}"}) {
      RawClient client = connect();
      client.send(post("/api/v1/cell/stop", "Expect: " + expected + "\r\nContent-Length: 2\r\n", body));
      RawAnswer answer = client.receive();
      EXPECT_EQ(answer.status, 202u) << expected << " with " << body;
      EXPECT_EQ(answer.header["connection"], "close") << "whether a body follows is not known";
      EXPECT_TRUE(client.closed());
    }
    expect_served(202, post("/api/v1/cell/stop", "Expect: " + expected + "\r\n", ""));
  }
}

TEST_F(SessionTest, ARefusalByTheHeaderDoesNotWaitForTheBody) {
  expect_refused(421, "POST /api/v1/runs HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 2\r\n\r\n");
}

TEST_F(SessionTest, OtherPagesAreNotTaken) {
  for (const std::string& foreign :
       {std::string("http://evil.example"), "https://" + host(), std::string("null"),
        "http://" + host() + ".evil.example", std::string("http://127.0.0.1:1")}) {
    expect_refused(403, get("/api/v1/status", "Origin: " + foreign + "\r\n"));
  }
  const std::string own = "Origin: http://" + host() + "\r\n";
  expect_served(200, get("/api/v1/status", own));
  expect_served(200, get("/api/v1/status", "Origin: https://cell-3.plant.example\r\n"));
  expect_refused(400, get("/api/v1/status", own + own));
}

TEST_F(SessionTest, HeadSaysWhatGetWouldAndNoBody) {
  const RawAnswer got = expect_served(200, get("/api/v1/runs"));
  const RawAnswer head = expect_served(200, "HEAD /api/v1/runs HTTP/1.1\r\n" + host_line() + "\r\n", true);
  EXPECT_EQ(head.header, got.header);
  EXPECT_EQ(head.header.at("content-length"), std::to_string(got.body.size()));
  expect_served(404, "HEAD /nothing HTTP/1.1\r\n" + host_line() + "\r\n", true);
  EXPECT_TRUE(expect_served(200, "HEAD /api/v1/status HTTP/1.1\r\n" + host_line() + "\r\n", true)
                  .header.contains("etag"));
}

TEST_F(SessionTest, AKnownStatusIs304WithItsTagAndNoBody) {
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

TEST_F(SessionTest, AConnectionServesRequestsInTheirOrderUntilItIsToEnd) {
  RawClient client = connect();
  client.send(get("/healthz"));
  EXPECT_EQ(client.receive().status, 200u);
  client.send(get("/nothing") + post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}") + get("/healthz") +
              get("/api/v1/status", "Connection: close\r\n") + get("/healthz"));
  for (const unsigned status : {404u, 202u, 200u, 200u}) EXPECT_EQ(client.receive().status, status);
  EXPECT_TRUE(client.closed()) << "what comes after a close is not served";
}

TEST_F(SessionTest, BytesMayComeOneByOne) {
  const std::string request = post("/api/v1/cell/stop", "Content-Length: 2\r\n", "{}");
  RawClient client = connect();
  for (const char byte : request) client.send(std::string(1, byte));
  EXPECT_EQ(client.receive().status, 202u);
}

TEST_F(SessionTest, MethodsAreCaseSensitiveAndOthersAreNotAllowed) {
  for (const char* method : {"get", "DELETE", "PUT", "OPTIONS", "TRACE", "PATCH", "INVENTED"}) {
    const RawAnswer answer =
        expect_served(405, std::string(method) + " /api/v1/status HTTP/1.1\r\n" + host_line() + "\r\n");
    EXPECT_EQ(answer.header.at("allow"), "GET") << method;
  }
}

TEST_F(SessionTest, EveryAnswerForbidsStoringSniffingAndFrames) {
  const RawAnswer answer = expect_served(200, get("/healthz"));
  EXPECT_EQ(answer.header.at("cache-control"), "no-store");
  EXPECT_EQ(answer.header.at("x-content-type-options"), "nosniff");
  EXPECT_THAT(answer.header.at("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
}

}  // namespace
}  // namespace cell
