#include "service/http/server/host_name.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(HostName, IsANameWithOrWithoutAPort) {
  const auto plain = parse_host_name("cell-3.plant.example");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->name, "cell-3.plant.example");
  EXPECT_EQ(plain->port, std::nullopt);
  for (const auto& [text, port] : {std::pair("robot.example:8443", 8443), std::pair("robot.example:1", 1),
                                   std::pair("robot.example:65535", 65535)}) {
    const auto host = parse_host_name(text);
    ASSERT_TRUE(host) << text;
    EXPECT_EQ(host->name, "robot.example");
    EXPECT_EQ(host->port, port);
  }
}

TEST(HostName, AnotherTextIsNone) {
  for (const std::string& text :
       {std::string(), std::string(":8443"), std::string("robot:"), std::string("robot:0"),
        std::string("robot:65536"), std::string("robot:-1"), std::string("robot:+1"), std::string("robot: 1"),
        std::string("robot:8443x"), std::string("robot:1:2"), std::string("https://robot"),
        std::string("robot/"), std::string("ro bot"), std::string("robot_1"), std::string(254, 'a')})
    EXPECT_FALSE(parse_host_name(text)) << text;
  EXPECT_TRUE(parse_host_name(std::string(253, 'a')));
}

}  // namespace
}  // namespace cell
