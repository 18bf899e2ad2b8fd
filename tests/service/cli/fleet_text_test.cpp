#include "service/cli/fleet_text.hpp"

#include <gmock/gmock.h>

#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(FleetText, HasItsColumnsBelowEachOtherWhateverIsInThem) {
  FleetDocument fleet;
  fleet.cells.push_back({.cell = "welding-line-2-cell-07",
                         .heard_at = "2026-11-29T19:00:00.000Z",
                         .state = "running",
                         .arm = "staubli-tx2-90"});
  fleet.cells.push_back(
      {.cell = "müller", .heard_at = "2026-11-28T19:00:00.000Z", .state = "idle", .arm = "tx90"});
  fleet.cells.push_back(
      {.cell = "a", .certificate_artefact = "block", .last_fault_code = "reference_drift_beyond"});
  const auto lines = lines_of(fleet_text(fleet));
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_THAT(lines[1], StartsWith("welding-line-2-cell-07  running  staubli-tx2-90  2026-11-29  -"));
  EXPECT_THAT(lines[2], StartsWith("müller                  idle     tx90            2026-11-28  -"));
  EXPECT_THAT(lines[3], HasSubstr("- reference_drift_beyond  block -"));
}

TEST(FleetText, ShowsNothingThatIsNotThereAndNoLineOfAnotherCell) {
  FleetDocument fleet;
  fleet.cells.push_back({.cell = "liar\ncell-1  idle\x1b[2J"});
  const auto lines = lines_of(fleet_text(fleet));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[1], StartsWith("liar?cell-1"));
  EXPECT_THAT(lines[1], Not(HasSubstr("\x1b")));
  EXPECT_THAT(lines_of(fleet_text({})), SizeIs(2)) << "an archive without a cell";
}

TEST(TrendsText, IsALineAMonthAndTypeOfArm) {
  FleetTrendsDocument trends;
  trends.trends.push_back(
      {.month = "2026-11", .cells = 2, .calibrations = 12, .tip_box_max_mm = 0.2344, .faults = 7});
  const auto lines = lines_of(trends_text(trends));
  ASSERT_EQ(lines.size(), 2U);
  std::istringstream words(lines[1]);
  const std::vector<std::string> told{std::istream_iterator<std::string>(words), {}};
  EXPECT_THAT(told, ElementsAre("2026-11", "not", "known", "2", "12", "0", "0", "0.234", "0", "0", "-", "0",
                                "0", "7"));
}

}  // namespace
}  // namespace cell
