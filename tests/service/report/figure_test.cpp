#include "service/report/internal/figure.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/service/report/markup.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Figures, TicksAreRoundAndWithinTheAxis) {
  EXPECT_THAT(ticks(0.0, 10.0), ::testing::ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_EQ(ticks(-0.031, 0.042).size(), 8U);
  for (const auto& [low, high] : {std::pair{-75.3, -70.1}, {1e-6, 3e-6}, {0.0, 7500.0}}) {
    for (const double tick : ticks(low, high)) {
      EXPECT_GE(tick, low);
      EXPECT_LE(tick, high);
    }
    EXPECT_GE(ticks(low, high).size(), 3U);
  }
}

TEST(Figures, AFigureWithoutAPointIsALineOfText) {
  EXPECT_THAT(svg(english(), {.title = "empty", .series = {}, .level = {}, .level_name = {}}),
              Not(HasSubstr("<svg")));
}

TEST(Figures, PointsThatAreNoNumbersAreLeftOut) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::string drawn = svg(english(), {.title = "t",
                                            .series = {{.name = "s", .points = {{1, 2}, {2, none}, {3, 2}}}},
                                            .level = {},
                                            .level_name = {}});
  EXPECT_THAT(drawn, Not(HasSubstr("nan")));
  EXPECT_EQ(first_unclosed(drawn), "");
}

}  // namespace
}  // namespace cell
