#include "sim_controller/val3/machine/run_error.hpp"

#include <gmock/gmock.h>

#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

using testing::HasSubstr;

TEST(RunErrors, EachThatALineCanEndWithHasAText) {
  for (const RunError error : {kErrorDivision,
                               kErrorArgument,
                               kErrorIndex,
                               kErrorIndexNegative,
                               kErrorTaskName,
                               kErrorNoTask,
                               kErrorTaskExists,
                               kErrorPeriods,
                               kErrorRunMemory,
                               kErrorTimeout,
                               kErrorInterpreter,
                               kErrorParameter,
                               kErrorNoLibrary,
                               kErrorNoLine,
                               kErrorVel,
                               kErrorAccel,
                               kErrorDecel,
                               kErrorTvel,
                               kErrorRvel,
                               kErrorReach,
                               kErrorLeave,
                               kErrorWriteToInput,
                               kErrorNotLinked,
                               kErrorInputOutput,
                               kErrorImpossibleMove,
                               kErrorInvalidMove,
                               kErrorPointWithoutFrame,
                               kErrorFrameWithoutFather,
                               kErrorToolWithoutFather})
    EXPECT_NE(run_error_text(error), "unknown error") << error;
  EXPECT_EQ(run_error_text(12345), "unknown error");
}

TEST(RunErrors, HelpGivesTheTextAndNeverFails) {
  SmallProject project;
  with_variables(project).program("start", "s[0]=help(20)\ns[1]=help(-99999999999)\ns[2]=help(20.9)");
  Running run(project);
  run.ticks(2);
  EXPECT_THAT(run.text("s", 0), HasSubstr("index beyond"));
  EXPECT_EQ(run.text("s", 1), "unknown error");
  EXPECT_EQ(run.text("s", 2), run.text("s", 0));
}

}  // namespace
}  // namespace val3
