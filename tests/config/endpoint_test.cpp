
#include "config/endpoint.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(ParseEndpoint, TakesHostAndPort) {
  const auto endpoint = parse_endpoint("127.0.0.1:8080");
  ASSERT_TRUE(endpoint);
  EXPECT_EQ(endpoint->host, "127.0.0.1");
  EXPECT_EQ(endpoint->port, 8080);
}

TEST(ParseEndpoint, AnIpv6HostStandsInBrackets) {
  const auto endpoint = parse_endpoint("[::1]:0");
  ASSERT_TRUE(endpoint);
  EXPECT_EQ(endpoint->host, "::1");
  EXPECT_EQ(endpoint->port, 0);
}

TEST(ParseEndpoint, AnythingElseIsNone) {
  for (const char* text :
       {"", ":", "host", ":80", "host:", "host:x", "host:-1", "host:65536", "host:80x", "host: 80", "[]:80",
        "[::1", "[::1:80", "::1]:80", "::1:80", "[[::1]]:80", "[::1]x:80"}) {
    EXPECT_FALSE(parse_endpoint(text)) << text;
  }
}

TEST(EndpointText, IsWhatIsParsedAgain) {
  for (const char* text : {"127.0.0.1:8080", "[::1]:0", "[fe80::1%eth0]:65535", "cell-3.example:80"}) {
    const auto endpoint = parse_endpoint(text);
    ASSERT_TRUE(endpoint) << text;
    EXPECT_EQ(endpoint_text(*endpoint), text);
  }
}

}  // namespace
}  // namespace cell
