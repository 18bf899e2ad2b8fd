#include "service/acquisition/reconnect_pause.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace cell {
namespace {

using namespace std::chrono_literals;
using TimePoint = ReconnectPause::TimePoint;

TEST(ReconnectPause, GrowsWithLinksThatDieAtOnceAsWithTriesThatFail) {
  for (const bool linked : {false, true}) {
    ReconnectPause pause;
    TimePoint now = TimePoint{} + 1h;
    EXPECT_LE(pause.earliest(), now) << "the first try is made at once";
    for (const auto expected : {100ms, 200ms, 400ms, 800ms, 1600ms, 2000ms, 2000ms}) {
      pause.on_try(now, linked);
      pause.on_link_end(now);
      EXPECT_EQ(pause.earliest() - now, expected);
      now = pause.earliest();
    }
    EXPECT_EQ(pause.short_links(), linked ? 7 : 0);
  }
}

TEST(ReconnectPause, ALinkThatLastedEndsTheGrowthAndItsEndIsAllowedToBeNoticed) {
  ReconnectPause pause;
  TimePoint now = TimePoint{} + 1h;
  for (int i = 0; i < 5; ++i) {
    pause.on_try(now, true);
    pause.on_link_end(now);
    now = pause.earliest();
  }
  pause.on_try(now, true);
  now += ReconnectPause::kLasts;
  pause.on_link_end(now);
  EXPECT_EQ(pause.short_links(), 0);
  EXPECT_EQ(pause.earliest() - now, ReconnectPause::kFirst);
  pause.on_try(now, false);
  EXPECT_EQ(pause.earliest() - now, ReconnectPause::kFirst);
}

TEST(ReconnectPause, KeepsWhatTheProtocolWantsOfAHost) {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/cs8_protocol/PROTOCOL.md");
  const std::string lines{std::istreambuf_iterator<char>(file), {}};
  const std::string page = std::regex_replace(lines, std::regex("\\s+"), " ");
  std::smatch figures;
  ASSERT_TRUE(std::regex_search(
      page, figures,
      std::regex(
          "A host that lost or closed a connection waits at least ([0-9]+) ms before it connects again, "
          "since the controller may not have seen the end yet, and after each failure longer, up to "
          "([0-9]+) s\\.")));
  EXPECT_GE(ReconnectPause::kFirst, std::chrono::milliseconds(std::stoi(figures[1])));
  EXPECT_EQ(ReconnectPause::kLongest, std::chrono::seconds(std::stoi(figures[2])));
}

}  // namespace
}  // namespace cell
