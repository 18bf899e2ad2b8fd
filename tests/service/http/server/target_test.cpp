#include "service/http/server/internal/target.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(ParseTarget, TakesPathAndQueryApart) {
  const auto parsed = parse_target("/a/b?x=1&y=&z&x=2&&w=a=b");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->first, "/a/b");
  EXPECT_EQ(parsed->second, (Query{{"", ""}, {"w", "a=b"}, {"x", "1"}, {"x", "2"}, {"y", ""}, {"z", ""}}));
  EXPECT_EQ(parse_target("/")->second.size(), 0u);
  for (const char* target : {"", "*", "http://127.0.0.1/api/v1/status", "127.0.0.1:80", "?x=1"})
    EXPECT_FALSE(parse_target(target)) << target;
}

}  // namespace
}  // namespace cell
