#include "service/run/check_reference.hpp"

#include <gmock/gmock.h>

#include <string_view>

#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Checks that agree have the same letter; the runs are numbered from 1.
std::vector<ReferenceCandidate> checks_of_plans(std::string_view plans) {
  std::vector<ReferenceCandidate> checks;
  for (const char plan : plans) {
    const auto first = table3_touches().begin() + calib::kCheckTouchCount * (plan - 'A');
    checks.push_back({.run = static_cast<std::int64_t>(checks.size()) + 1,
                      .time = {{first, first + calib::kCheckTouchCount}}});
  }
  return checks;
}

std::vector<std::size_t> chosen(const std::vector<ReferenceCandidate>& checks) {
  return reference_among(edf().arm.model, checks);
}

TEST(CheckReferenceAmong, NoneNoneIs) { EXPECT_THAT(chosen({}), IsEmpty()); }

TEST(CheckReferenceAmong, TheFirstThreeThatAgreeAreTheReferenceForEver) {
  EXPECT_THAT(chosen(checks_of_plans("AA")), ElementsAre(0, 1));
  EXPECT_THAT(chosen(checks_of_plans("AAA")), ElementsAre(0, 1, 2));
  EXPECT_THAT(chosen(checks_of_plans("AAABBBAB")), ElementsAre(0, 1, 2)) << "whatever comes later";
}

TEST(CheckReferenceAmong, WhereTheNewestAgreesWithNoneItBeginsAnew) {
  EXPECT_THAT(chosen(checks_of_plans("AB")), ElementsAre(1));
  EXPECT_THAT(chosen(checks_of_plans("ABC")), ElementsAre(2)) << "three, and none of them agree";
  EXPECT_THAT(chosen(checks_of_plans("AAB")), ElementsAre(2));
}

TEST(CheckReferenceAmong, ItGoesOnWithWhicheverAgree) {
  EXPECT_THAT(chosen(checks_of_plans("ABB")), ElementsAre(1, 2));
  EXPECT_THAT(chosen(checks_of_plans("ABA")), ElementsAre(0, 2));
  EXPECT_THAT(chosen(checks_of_plans("ABCBAB")), ElementsAre(1, 3, 5));
  EXPECT_THAT(chosen(checks_of_plans("AABBB")), ElementsAre(2, 3, 4));
  EXPECT_THAT(chosen(checks_of_plans("ABABA")), ElementsAre(0, 2, 4));
  EXPECT_THAT(chosen(checks_of_plans("ABABABBB")), ElementsAre(0, 2, 4));
}

TEST(CheckReferenceAmong, OneThatLeftTouchesOutIsNever) {
  std::vector<ReferenceCandidate> checks = checks_of_plans("AAAA");
  checks[1].time.touches.pop_back();
  EXPECT_THAT(chosen(checks), ElementsAre(0, 2, 3));
  EXPECT_THAT(chosen({checks[1]}), IsEmpty());
}

TEST(CheckReferenceAmong, OneThatWasImportedBehindTheOthersChangesNothing) {
  std::vector<ReferenceCandidate> checks = checks_of_plans("AAAA");
  checks.front().run = 9;
  EXPECT_THAT(chosen(checks), ElementsAre(1, 2, 3));
}

TEST(CheckReferenceAmong, TheProbeMayScatterAndTheArmGrow) {
  std::vector<ReferenceCandidate> checks = checks_of_plans("AAA");
  for (calib::Touch& touch : checks[1].time.touches) touch.joints.array() += 0.2e-3;
  EXPECT_THAT(chosen(checks), ElementsAre(0, 1, 2));
  for (calib::Touch& touch : checks[1].time.touches) touch.joints.array() += 20e-3;
  EXPECT_THAT(chosen(checks), ElementsAre(0, 2));
}

}  // namespace
}  // namespace cell
