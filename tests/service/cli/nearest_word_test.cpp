#include "service/cli/nearest_word.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cell {
namespace {

const std::vector<std::string> kWords{"status", "stop", "check", "checks", "compensate", "run", "runs"};

TEST(NearestWord, IsTheOneThatWasProbablyMeant) {
  EXPECT_EQ(nearest_word("statsu", kWords), "status") << "two letters swapped";
  EXPECT_EQ(nearest_word("chek", kWords), "check") << "one is missing";
  EXPECT_EQ(nearest_word("compansatee", kWords), "compensate") << "one is wrong, one too many";
  EXPECT_EQ(nearest_word("checks", kWords), "checks");
}

TEST(NearestWord, IsNoneOfWhatIsTooFarFromAll) {
  EXPECT_EQ(nearest_word("calibrate", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("", kWords), std::nullopt);
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'x'), kWords), std::nullopt);
  EXPECT_EQ(nearest_word("status", {}), std::nullopt);
}

}  // namespace
}  // namespace cell
