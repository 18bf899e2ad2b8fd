// What a daemon is sent that it must not take: JSON that is none, requests that are none, tokens that are
// none. Each is answered with a 4xx (501 for a transfer coding that it does not know) that says what is
// wrong.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/served_daemon.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// Values that are no JSON, or none that a document may hold: each stands alone, in an array, and as a
/// member.
std::vector<std::string> bad_values() {
  using namespace std::string_literals;
  return {
      // numbers
      "01", "-", "+1", "1.", ".5", "-.5", "1e", "1e+", "1E-", "0x1F", "1_000", "1,5", "--1", "1-", "1..2",
      "1e5.5", "-01", "NaN", "nan", "Infinity", "-Infinity", "1e400", "-1e400", "\xef\xbc\x91", "1 2",
      // texts
      "\"", "\"a", "a\"", "'a'", "\"\\\"", "\"\\x41\"", "\"\\u12\"", "\"\\u12g4\"", "\"\\U0041\"",
      "\"\\ud800\"", "\"\\udc00\"", "\"\\ud800\\u0041\"", "\"\\ud800\\ud800\"", "\"a\nb\"", "\"a\tb\"",
      "\"a\0b\""s, "\"\x1f\"", "\"\\a\"", "\"\\\0\""s, "\"\xff\"", "\"\xc0\xaf\"", "\"\xe0\x80\xaf\"",
      "\"\xed\xa0\x80\"", "\"\xf4\x90\x80\x80\"", "\"\xc3\"", "\"\x80\"", "\"a\" \"b\"",
      // words
      "nul", "nulll", "NULL", "True", "tru", "falsee", "undefined", "None", "yes",
      // arrays and objects
      "[", "]", "[1", "[1,", "[,1]", "[1,]", "[1 2]", "[1;2]", "[1,,2]", "[[]", "[]]", "[1:2]", "[\"a\":1]",
      "{", "}", "{\"a\"", "{\"a\":", "{\"a\":1", "{\"a\":1,", "{\"a\":1,}", "{,\"a\":1}", "{\"a\" 1}",
      "{\"a\":}", "{:1}", "{a:1}", "{'a':1}", "{1:1}", "{null:1}", "{\"a\":1 \"b\":2}", "{\"a\":1;\"b\":2}",
      "{\"a\":1}}", "{\"a\":1,\"a\":1}", "{\"a\":{\"b\":1,\"b\":1}}", "{[]:1}", "[}", "{]", "{\"a\":[}",
      // what stands around it
      "", "\xef\xbb\xbf{}", "{}\0"s, "\0{}"s, "{}x", "{}{}", "{}//", "/*a*/{}", "#\n{}", "\xff\xfe{\0}\0"s,
      "\x0c{}", "\xc2\xa0{}", "\xe2\x80\xa8{}", "{}\x1a", ")]}',\n{}", "<a/>", "a=1&b=2",
      // depth
      repeated("[", 33) + repeated("]", 33), repeated("{\"a\":", 40) + "1" + repeated("}", 40),
      repeated("[", 20'000), repeated("{\"a\":", 8'000), repeated("[{\"a\":", 500)};
}

class BadRequests : public ServedDaemon {
 protected:
  using ServedDaemon::ServedDaemon;

  /// The answer is a problem document that says in one line what is wrong.
  static void expect_told(const cell::RawAnswer& answer, const std::string& what) {
    const bool refused = (answer.status >= 400 && answer.status < 500) || answer.status == 501;
    EXPECT_TRUE(refused) << answer.status << " to " << what;
    if (answer.status == 0) return;
    const json problem = json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(problem.is_object()) << what << '\n' << answer.body;
    const std::string detail = problem.value("detail", "");
    EXPECT_FALSE(detail.empty()) << what;
    EXPECT_EQ(detail.find('\n'), std::string::npos) << what << '\n' << detail;
  }
  static std::string shown(const std::string& bytes) {
    std::string text;
    const std::string ends =
        bytes.size() <= 400 ? bytes : bytes.substr(0, 200) + " ... " + bytes.substr(bytes.size() - 200);
    for (const char c : ends) text += c >= ' ' && c <= '~' ? c : '?';
    return text;
  }

  [[nodiscard]] json openapi() const {
    return json::parse(answer_to(request("GET", "/openapi.json", bearer(operate_))).body);
  }
};

TEST_F(BadRequests, JsonThatIsNoneIsRefusedWithItsPlaceWhereverABodyIsTaken) {
  const std::string lines = bearer(operate_) + "Content-Type: application/json\r\n";
  int sent = 0;
  const auto send = [&](const std::string& target, const std::string& body) {
    const cell::RawAnswer answer = answer_to(request("POST", target, lines, body));
    const std::string what = target + " with " + shown(body);
    expect_told(answer, what);
    EXPECT_TRUE(json::parse(answer.body, nullptr, false).contains("pointer")) << what << '\n' << answer.body;
    ++sent;
  };
  for (const char* target : {"/api/v1/runs", "/api/v1/plan", "/api/v1/identify"}) {
    const std::string known = target == std::string("/api/v1/identify") ? "touches" : "recipe";
    for (const std::string& value : bad_values()) {
      send(target, value);
      send(target, "[" + value + "]");
      send(target, "{\"" + known + "\":" + value + "}");
    }
    const std::string whole = "{\"" + known + "\":[{\"a\":[1,2.5e1,true,null,\"\\u00e9\"]}]}";
    for (std::size_t cut = 0; cut < whole.size(); ++cut) send(target, whole.substr(0, cut));
  }
  EXPECT_GT(sent, 1'000);
}

TEST_F(BadRequests, ValuesOfAnotherKindAreRefusedWithThePointerOfTheirKey) {
  const std::string lines = bearer(operate_) + "Content-Type: application/json\r\n";
  const std::vector<std::string> keys{"recipe",
                                      "plan_id",
                                      "operator",
                                      "arm_moving_min",
                                      "touching",
                                      "kind",
                                      "unknown",
                                      "block_temperature_c",
                                      "std_block_temperature_k",
                                      "block_temperature_at",
                                      "stiffness"};
  for (const std::string& key : keys) {
    for (const char* value :
         {"[]", "{}", "[[1]]", "{\"a\":1}", "true", "false", "null", "-1e308", "\"\\u0000\""}) {
      std::string body = "{\"" + key + "\":" + value + "}";
      if (key != "recipe" && key != "plan_id") body.insert(1, "\"recipe\":\"edf-25\",");
      const cell::RawAnswer answer = answer_to(request("POST", "/api/v1/runs", lines, body));
      expect_told(answer, body);
      const json problem = json::parse(answer.body, nullptr, false);
      if (answer.status == 409) {
        ADD_FAILURE() << "taken, but for the cell that is not ready: " << body;
      } else {
        EXPECT_TRUE(problem.contains("pointer")) << body << '\n' << answer.body;
      }
    }
  }
}

/// Raw bytes that are no request of this API; `%HOST%` is the daemon's own.
std::vector<std::string> bad_requests() {
  using namespace std::string_literals;
  std::vector<std::string> all;
  const auto add = [&](std::initializer_list<std::string> lines, const std::string& before,
                       const std::string& behind) {
    for (const std::string& line : lines) all.push_back(before + line + behind);
  };
  const std::string host = "Host: %HOST%\r\n";
  // The request line.
  add({"GET",
       "GET ",
       "GET /healthz",
       "GET /healthz ",
       "GET /healthz HTTP",
       "GET /healthz HTTP/",
       "GET /healthz HTTP/1",
       "GET /healthz HTTP/1.",
       "GET /healthz HTTP/1.1 ",
       "GET /healthz HTTP/1.1 x",
       " GET /healthz HTTP/1.1",
       "GET\t/healthz\tHTTP/1.1",
       "GET /healthz\tHTTP/1.1",
       "GET  /healthz HTTP/1.1",
       "GET /healthz  HTTP/1.1",
       "GET /healthz http/1.1",
       "GET /healthz HTTP/0.9",
       "GET /healthz HTTP/1.2",
       "GET /healthz HTTP/2",
       "GET /healthz HTTP/2.0",
       "GET /healthz HTTP/3.0",
       "GET /healthz HTTP/11",
       "GET /healthz HTTP/1.1.1",
       "GET /healthz HTTP/-1.1",
       "GET /healthz HTTP/1.a",
       "GET /healthz HTTPS/1.1",
       "GET /healthz XTTP/1.1",
       "GET /health z HTTP/1.1",
       "GET healthz HTTP/1.1",
       "GET http://%HOST%/healthz HTTP/1.1",
       "GET //evil.example/healthz HTTP/1.1",
       "GET * HTTP/1.1",
       "OPTIONS * HTTP/1.1",
       "CONNECT %HOST% HTTP/1.1",
       "CONNECT evil.example:443 HTTP/1.1",
       "G\0T /healthz HTTP/1.1"s,
       "GET /heal\0thz HTTP/1.1"s,
       "GET /heal\x7fthz HTTP/1.1",
       "GET /heal\x01thz HTTP/1.1",
       "GET /\xff HTTP/1.1",
       "G(T /healthz HTTP/1.1",
       "GET: /healthz HTTP/1.1",
       "\"GET\" /healthz HTTP/1.1",
       "get /healthz HTTP/1.1",
       "GETX /healthz HTTP/1.1",
       "DELETE /api/v1/runs/1 HTTP/1.1",
       "PUT /api/v1/status HTTP/1.1",
       "PATCH /api/v1/cell HTTP/1.1",
       "TRACE /healthz HTTP/1.1",
       "PROPFIND / HTTP/1.1",
       "POST /healthz HTTP/1.1",
       "PRI * HTTP/2.0"},
      "", "\r\n" + host + "\r\n");
  // Targets.
  add({"/%",
       "/%2",
       "/%zz",
       "/%00",
       "/api/v1/status?%zz",
       "/api/v1/status?wait_s=%00",
       "/api/v1/status?wait_s=-1",
       "/api/v1/status?wait_s=1e3",
       "/api/v1/status?wait_s=99999999999999999999&after=1",
       "/api/v1/status?wait_s=0&wait_s=1",
       "/api/v1/status?unknown=1",
       "/api/v1/status?after=x",
       "/api/v1/runs?limit=0",
       "/api/v1/runs?limit=201",
       "/api/v1/runs?limit=",
       "/api/v1/runs?before=-9223372036854775809",
       "/api/v1/runs?limit=1%0a",
       "/api/v1/runs/0",
       "/api/v1/runs/-1",
       "/api/v1/runs/x",
       "/api/v1/runs/1x",
       "/api/v1/runs/9223372036854775808",
       "/api/v1/runs/99999999999999999999/events",
       "/api/v1/runs/x/events",
       "/api/v1/runs/1/events",
       "/api/v1/runs//events",

       "/api/v1/runs/1/",
       "/api/v1/runs//",
       "/api/v1/runs/%31%00",
       "/api/v1/runs/..%2f..",
       "/api/v1/runs/1/report?format=exe",
       "/api/v1/runs/1/report?format=",
       "/api/v1/../v1/statu",
       "/api/v1/runs/1/touches",
       "/api/v1/runs/1/result",
       "/api/v1/runs/1/arm",
       "/api/v1/runs/1/plan",
       "/assets/",
       "/assets/..",
       "/assets/../../etc/passwd",
       "/assets/%2e%2e%2fetc%2fpasswd",
       "/assets/nothing",
       "/api/v2/status",
       "/API/V1/STATUS",
       "/api/v1/status/",
       "/api",
       "/nothing",
       "/" + std::string(9'000, 'a'),
       "/api/v1/status?" + std::string(9'000, 'a')},
      "GET ", " HTTP/1.1\r\n" + host + "\r\n");
  // Header lines.
  add({"Host: evil.example\r\n", "Host: \r\n", "Host: %HOST%x\r\n", "Host: %HOST%, %HOST%\r\n",
       "Host: a@%HOST%\r\n", "Host: %HOST%/\r\n", "Host: [::1\r\n", "Host:\r\n", "hOsT: 127.0.0.1:1\r\n", "",
       "Host: 127.0.0.1\r\n"},
      "GET /healthz HTTP/1.1\r\n", "\r\n");
  add({"No-Colon",
       ": nameless",
       "Blank : x",
       " Leading: x",
       "\tLeading: x",
       "Na me: x",
       "N\0me: x"s,
       "Name: a\0b"s,
       "Name: a\rb",
       "N\x80me: x",
       "Name(: x",
       "Name: a\r\n folded",
       "Name: a\r\n\tfolded",
       "Name: \x01",
       "Long: " + std::string(9'000, 'x'),
       std::string(9'000, 'n') + ": x",
       "Host: %HOST%",
       "Host: evil.example",
       "Content-Length: x",
       "Content-Length: -1",
       "Content-Length: +1",
       "Content-Length: 1 1",
       "Content-Length: 0x1",
       "Content-Length: 1\r\nContent-Length: 1",
       "Content-Length: 1, 1",
       "Content-Length: ",
       "Content-Length: 1.0",
       "Content-Length: 18446744073709551616",
       "Transfer-Encoding: x",
       "Transfer-Encoding: gzip, chunked",
       "Transfer-Encoding: chunked, chunked",
       "Transfer-Encoding: ",
       "Transfer-Encoding: chunked\r\nContent-Length: 1",
       "Expect: 100-continue",
       "Authorization: Bearer x\r\nAuthorization: Bearer x",
       "Origin: a\r\nOrigin: a",
       repeated("A: b\r\n", 3'000) + "A: b"},
      "GET /healthz HTTP/1.1\r\n" + host, "\r\n\r\n");
  // Bodies in pieces, of a command that a token would allow.
  add({"x\r\n", "-1\r\n", "+2\r\n{}\r\n0\r\n\r\n", " 2\r\n{}\r\n0\r\n\r\n", "0x2\r\n{}\r\n0\r\n\r\n",
       "2;a=b\r\n{}\r\n0\r\n\r\n", "2\r\n{}0\r\n\r\n", "2\r\n{}x\r\n0\r\n\r\n", "FFFFFFFFFFFFFFFFF\r\n",
       "\r\n2\r\n{}\r\n0\r\n\r\n", "2\r\n{}\r\n0\r\nTrailer : a\r\n\r\n", "2\r\n{}\r\n0\r\n: a\r\n\r\n",
       "2\r\n{}\r\n0\r\nNo-Colon\r\n\r\n"},
      "POST /api/v1/cell/reset HTTP/1.1\r\n" + host +
          "Authorization: Bearer %TOKEN%\r\nContent-Type: application/json\r\nTransfer-Encoding: "
          "chunked\r\n\r\n",
      "");
  // No HTTP at all.
  add({"\n", "\0\0\0\0"s, "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"s, "SSH-2.0-x\r\n", "EHLO x\r\n",
       "<policy-file-request/>\0"s, "{\"recipe\":\"edf-25\"}\r\n", std::string(20'000, 'a'),
       std::string(20'000, '\0'), "\r\nx\r\n"},
      "", "\r\n\r\n");
  return all;
}

TEST_F(BadRequests, WhatIsNoRequestIsToldSoAndTheNextClientIsServed) {
  const auto replace = [](std::string text, const std::string& mark, const std::string& by) {
    for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + by.size()))
      text.replace(at, mark.size(), by);
    return text;
  };
  const std::vector<std::string> all = bad_requests();
  EXPECT_GE(all.size(), 150U);
  for (const std::string& one : all) {
    const std::string bytes = replace(replace(one, "%HOST%", host_), "%TOKEN%", operate_);
    expect_told(answer_to(bytes, true), shown(bytes));
  }
}

TEST_F(BadRequests, ARequestThatEndsTooEarlyIsNeverTaken) {
  const std::string whole =
      request("POST", "/api/v1/cell/reset", bearer(operate_) + "Content-Type: application/json\r\n", "{}");
  ASSERT_EQ(answer_to(whole).status, 202U);
  for (std::size_t cut = 1; cut < whole.size(); ++cut) {
    const cell::RawAnswer answer = answer_to(whole.substr(0, cut), true);
    EXPECT_TRUE(answer.status == 0 || (answer.status >= 400 && answer.status < 500))
        << answer.status << " to " << cut << " bytes";
  }
}

class TokensWanted : public BadRequests {
 protected:
  TokensWanted() : BadRequests({"--loopback-needs-token"}) {}

  /// Who sends many wrong tokens is answered late.
  void come_from_another_address() {
    constexpr boost::asio::ip::address_v4::uint_type kFirst = 0x7f010000;  // 127.1.0.0
    from_ = boost::asio::ip::address_v4(from_ ? from_->to_uint() + 1 : kFirst);
  }
};

TEST_F(TokensWanted, NoRouteOfTheOpenApiDocumentTakesAWrongToken) {
  // Who signs in has no token yet; people_desk_test says what the others tell to nobody.
  const std::string open =
      " /healthz / /assets/{id} /api/v1/session /api/v1/sign-in /api/v1/sign-out /api/v1/session/secret ";
  std::string other = operate_, last = operate_;
  other.front() = other.front() == '0' ? '1' : '0';
  last.back() = last.back() == '0' ? '1' : '0';
  std::string upper = operate_;
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  const std::string a = "Authorization: ";
  std::vector<std::string> wrong{"",
                                 a + "\r\n",
                                 a + "Bearer\r\n",
                                 a + "Bearer \r\n",
                                 a + operate_ + "\r\n",
                                 a + "Basic " + operate_ + "\r\n",
                                 a + "Bearer" + operate_ + "\r\n",
                                 a + "Bearer Bearer " + operate_ + "\r\n",
                                 a + "Token " + operate_ + "\r\n",
                                 a + "Bearer, " + operate_ + "\r\n",
                                 bearer(other),
                                 bearer(last),
                                 bearer(operate_.substr(1)),
                                 bearer(operate_.substr(0, 63)),
                                 bearer(operate_ + "0"),
                                 bearer(operate_ + operate_),
                                 bearer(operate_ + " x"),
                                 bearer("\"" + operate_ + "\""),
                                 bearer(std::string(64, '0')),
                                 bearer(std::string(4'000, 'a')),
                                 "X-" + bearer(operate_),
                                 "Cookie: token=" + operate_ + "\r\n"};
  if (upper != operate_) wrong.push_back(bearer(upper));
  int asked = 0;
  const json paths = openapi().at("paths");
  for (const auto& [path, methods] : paths.items()) {
    if (open.find(' ' + path + ' ') != std::string::npos) continue;
    std::string target = path;
    if (const auto id = target.find("{id}"); id != target.npos) target.replace(id, 4, "1");
    for (const auto& [method, unused] : methods.items()) {
      std::string verb = method;
      std::ranges::transform(verb, verb.begin(), [](unsigned char c) { return std::toupper(c); });
      for (const std::string& lines : wrong) {
        const cell::RawAnswer answer = answer_to(request(verb, target, lines));
        EXPECT_EQ(answer.status, 401U) << verb << ' ' << target << " with " << lines;
        expect_told(answer, verb + ' ' + target);
        if (++asked % 3 == 0) come_from_another_address();
      }
      if (verb == "POST") {
        EXPECT_EQ(answer_to(request(verb, target, bearer(view_))).status, 403U) << target;
      }
    }
  }
  EXPECT_GT(asked, 500);
}

}  // namespace
}  // namespace touchcal::testing
