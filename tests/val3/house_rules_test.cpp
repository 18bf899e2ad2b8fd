#include "tests/val3/house_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/val3/bench.hpp"
#include "tests/val3/small_project.hpp"

namespace val3 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> broken_in(const std::filesystem::path& project) {
  ReadApplication read = read_application(project);
  resolve(read.application, read.findings);
  for (const Finding& finding : read.findings)
    if (finding.severity == Severity::kError) ADD_FAILURE() << finding.at.line << ": " << finding.what;
  return broken_house_rules(read.application);
}

/// A right project with one task.
SmallProject& fill_right(SmallProject& project) {
  project.number("nCount").number("kLimit").flag("bOver").number("nByCall");
  project.program("work", "while true\nnCount=nCount+kLimit\ndelay(0)\nendWhile");
  project.program("clear", "x_n=0",
                  SmallProject::parameters(
                      SmallProject::parameter("x_n", "num", "xsi:type=\"element\" use=\"reference\"")));
  project.program("start",
                  "call clear(nByCall)\nnCount=0\nbOver=false\ntaskCreateSync \"work\",0.004,bOver,work()");
  project.program("stop", "taskKill(\"work\")");
  return project;
}

TEST(HouseRules, OurApplicationKeepsThem) { EXPECT_THAT(broken_in(project_path()), IsEmpty()); }

TEST(HouseRules, OurLibraryKeepsThem) {
  EXPECT_THAT(broken_in(project_path().parent_path().parent_path() / "touchcal_abs"), IsEmpty());
}

TEST(HouseRules, ARightProjectBreaksNone) {
  SmallProject project;
  EXPECT_THAT(broken_in(fill_right(project).write().path()), IsEmpty());
}

TEST(HouseRules, AVariableThatStartDoesNotSetIsNamed) {
  SmallProject project;
  fill_right(project).number("nLeft");
  EXPECT_THAT(broken_in(project.write().path()), ElementsAre(HasSubstr("nLeft is not set by start")));
}

TEST(HouseRules, AConstantThatIsWrittenIsNamed) {
  SmallProject project;
  fill_right(project).program("work", "while true\nfor kLimit=1 to 2\nendFor\ndelay(0)\nendWhile");
  EXPECT_THAT(broken_in(project.write().path()),
              ElementsAre(HasSubstr("kLimit is a constant and is written")));
}

TEST(HouseRules, ATaskThatStopDoesNotKillIsNamed) {
  SmallProject project;
  fill_right(project).program("stop", "");
  EXPECT_THAT(broken_in(project.write().path()), ElementsAre(HasSubstr("stop does not kill the task work")));
}

}  // namespace
}  // namespace val3
