#include "service/cli/checks_text.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ChecksDocument checked() {
  ChecksDocument document;
  document.of_run = "3";
  document.count = 2;
  document.reference = {.count = 3, .needed = 3};
  document.base = {.count = 10, .needed = 10};
  document.checks = {{.run = "4", .ended_at = "2026-11-27T09:15:00.000Z", .accepted = true},
                     {.run = "5", .ended_at = "2026-11-28T09:15:00.000Z", .accepted = true}};
  for (const char* quantity : {"joint_2", "joint_3", "joint_4", "joint_5", "growth", "residual"}) {
    const std::string unit = std::string(quantity) == "growth"     ? "ppm"
                             : std::string(quantity) == "residual" ? "mm"
                                                                   : "mrad";
    document.charts.push_back(
        {.quantity = quantity, .unit = unit, .centre = {}, .points = {{.run = "4", .value = 0.0125}}});
  }
  return document;
}

TEST(ChecksText, IsATableOfAtMost80ColumnsWhateverTheFigures) {
  ChecksDocument document = checked();
  for (ChecksDocument::Chart& chart : document.charts)
    for (const double value : {-17.4533, -1.2345, -6283.2}) {
      chart.points = {{.run = "4", .value = value, .beyond_shewhart = true}};
      std::istringstream lines(checks_text(document));
      for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
    }
  document.charts[0].points[0].value = -1.2345;
  EXPECT_THAT(checks_text(document), HasSubstr(" -1.23!"));
}

TEST(ChecksText, ACheckThatAlarmsNamesItsCause) {
  ChecksDocument document = checked();
  document.checks.back().accepted = false;
  const auto told = [&](const char* cause, std::optional<int> joint = {}) {
    document.checks.back().cause = cause;
    document.checks.back().joint = joint;
    return checks_text(document);
  };
  EXPECT_THAT(told("joint", 4), HasSubstr("JOINT 4"));
  EXPECT_THAT(told("block"), HasSubstr("BLOCK"));
  EXPECT_THAT(told("stylus"), HasSubstr("STYLUS"));
  EXPECT_THAT(told("unknown"), AllOf(HasSubstr("CHANGED"), Not(HasSubstr("unknown"))));
}

TEST(ChecksText, SaysWhenTheNextOneIsDueOrWhyNot) {
  ChecksDocument document = checked();
  EXPECT_THAT(checks_text(document), HasSubstr("no check_every_days in"));
  document.every_days = 7;
  EXPECT_THAT(checks_text(document), HasSubstr("when the next one is due is not known"));
  document.due_at = "2026-12-05T09:15:00.000Z";
  document.overdue = false;
  EXPECT_THAT(checks_text(document), HasSubstr("next one due: 2026-12-05 09:15 (every 7 days)"));
  document.overdue = true;
  EXPECT_THAT(checks_text(document), HasSubstr("OVERDUE since: 2026-12-05 09:15"));
}

TEST(ChecksText, SaysWhatAMarkIsWorthOnceThereAreLimits) {
  ChecksDocument document = checked();
  EXPECT_THAT(checks_text(document), Not(HasSubstr("Chance alone")));
  document.charts[0].centre = 0.0;
  EXPECT_THAT(checks_text(document), HasSubstr("check again before anything else"));
}

TEST(ChecksText, SaysHowManyAreListedWhereThereAreMore) {
  ChecksDocument document = checked();
  EXPECT_THAT(checks_text(document), Not(HasSubstr("are listed")));
  document.count = 700;
  EXPECT_THAT(checks_text(document),
              AllOf(HasSubstr("checks of run 3: 700"), HasSubstr("the newest 2 are listed")));
}

}  // namespace
}  // namespace cell
