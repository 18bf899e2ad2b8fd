#include "sim_controller/run_socket.hpp"

#include <gtest/gtest.h>

namespace sim {
namespace {

TEST(RunSocket, WithAPortIsAServerAndWithAHostAClient) {
  EXPECT_EQ(parse_run_socket("Socket\\host=5000"), (RunSocket{"Socket\\host", "", 5000}));
  EXPECT_EQ(parse_run_socket("host=0"), (RunSocket{"host", "", 0}));
  EXPECT_EQ(parse_run_socket("a=b=65535"), (RunSocket{"a=b", "", 65535}));
  EXPECT_EQ(parse_run_socket("vision=192.168.0.9:1"), (RunSocket{"vision", "192.168.0.9", 1}));
  EXPECT_EQ(parse_run_socket("vision=[::1]:80"), (RunSocket{"vision", "::1", 80}));
  EXPECT_EQ(run_socket_at("host", "5000"), (RunSocket{"host", "", 5000}));
}

TEST(RunSocket, IsRefusedWithoutANameOrAPlaceThatIsOne) {
  for (const char* text :
       {"", "=", "host", "host=", "=5000", "host=65536", "host=-1", "host=+1", "host=0x50", "host=5000 ",
        "host=:5000", "host=peer:", "host=peer:0", "host=peer:65536", "host=::1:80", "host=[::1:80"})
    EXPECT_EQ(parse_run_socket(text), std::nullopt) << text;
}

}  // namespace
}  // namespace sim
