#include "service/http/server/ends.hpp"

#include <gtest/gtest.h>

#include "service/http/server/session.hpp"

namespace cell {
namespace {

using boost::asio::ip::make_address;
using boost::asio::ip::tcp;

TEST(Ends, HostIsTheAddressALoopbackNameOrOneThatWasGiven) {
  const Ends ends({make_address("192.0.2.7"), 4000}, {make_address("192.0.2.1"), 8443}, "https://",
                  HttpLimits{.host_names = {{"cell-3"}}});
  EXPECT_FALSE(ends.from_loopback());
  EXPECT_EQ(ends.remote(), "192.0.2.7");
  for (const char* ours :
       {"192.0.2.1:8443", "localhost:8443", "127.0.0.1:8443", "[::1]:8443", "cell-3", "Cell-3:8443"}) {
    EXPECT_TRUE(ends.is_our_host(ours)) << ours;
    EXPECT_TRUE(ends.is_our_origin(std::string("https://") + ours)) << ours;
    EXPECT_FALSE(ends.is_our_origin(std::string("http://") + ours)) << ours;
  }
  for (const char* foreign : {"", "192.0.2.1", "cell-3:80", "cell-30", "evil.example:8443"})
    EXPECT_FALSE(ends.is_our_host(foreign)) << foreign;
}

TEST(Ends, BehindAProxyThatEndsTlsItsNameIsAcceptedAsHttpsAndLoopbackMayLoseItsRights) {
  const tcp::endpoint own(make_address("127.0.0.1"), 8080);
  const tcp::endpoint client(make_address("127.0.0.1"), 4000);
  const Ends proxied(client, own, "http://",
                     HttpLimits{.host_names = {{"cell-3"}}, .trusts_loopback = false});
  EXPECT_FALSE(proxied.from_loopback());
  EXPECT_TRUE(proxied.is_our_origin("https://cell-3"));
  EXPECT_TRUE(proxied.is_our_origin("http://127.0.0.1:8080"));
  EXPECT_FALSE(proxied.is_our_origin("https://127.0.0.1:8080"));
  EXPECT_FALSE(proxied.is_our_origin("https://cell-30"));
  EXPECT_TRUE(Ends(client, own, "http://", HttpLimits{}).from_loopback());
}

TEST(Ends, AProxyThatEndsTlsMayListenAtAnotherPort) {
  const tcp::endpoint own(make_address("127.0.0.1"), 8080);
  const tcp::endpoint client(make_address("127.0.0.1"), 4000);
  const Ends proxied(client, own, "http://", HttpLimits{.host_names = {{"robot.example", 8443}}});
  EXPECT_TRUE(proxied.is_our_host("robot.example:8443"));
  EXPECT_TRUE(proxied.is_our_origin("https://robot.example:8443"));
  EXPECT_TRUE(proxied.is_our_origin("https://Robot.Example:8443"));
  for (const char* elsewhere : {"robot.example", "robot.example:8080", "robot.example:443", "evil:8443"}) {
    EXPECT_FALSE(proxied.is_our_host(elsewhere)) << elsewhere;
    EXPECT_FALSE(proxied.is_our_origin(std::string("https://") + elsewhere)) << elsewhere;
  }
  const Ends usual(client, own, "http://", HttpLimits{.host_names = {{"robot.example", 443}}});
  EXPECT_TRUE(usual.is_our_host("robot.example")) << "a client leaves the port of the scheme out";
  EXPECT_TRUE(usual.is_our_origin("https://robot.example"));
  EXPECT_FALSE(usual.is_our_host("robot.example:8080"));
}

TEST(Ends, AUnixSocketIsThisMachineUnderAnyNameAndNoPageReachesIt) {
  const Ends ends = Ends::of_unix_socket();
  EXPECT_TRUE(ends.from_loopback());
  EXPECT_EQ(ends.remote(), "unix");
  EXPECT_TRUE(ends.is_our_host("localhost"));
  EXPECT_FALSE(ends.is_our_origin("http://localhost"));
}

}  // namespace
}  // namespace cell
