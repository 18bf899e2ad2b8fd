// Digital inputs and outputs: manual 6, pages 56 to 60.
#include "sim_controller/val3/machine/signals.hpp"

#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

SmallProject& with_signals(SmallProject& project, const std::string& lines) {
  project.data("di", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I0\"/>");
  project.data("dq", "dio",
               "<Value key=\"0\" link=\"BasicIO-1\\%Q0\"/><Value key=\"1\" link=\"BasicIO-1\\%Q0\"/>", 3);
  project.data("diNone", "dio", "");
  return with_variables(project).program("start", lines + "\nwait(false)");
}

TEST(Signals, StateIsReadWrittenAndCopied) {
  SmallProject project;
  with_signals(project, "dq=di\nn[0]=sel(dq==di,1,0)\nb=di\nn[1]=ioStatus(di)\nn[2]=ioStatus(diNone)");
  Running run(project);
  run.cabinet.inputs["BasicIO-1\\%I0"] = true;
  run.ticks(2);
  EXPECT_TRUE(run.cabinet.outputs["BasicIO-1\\%Q0"]) << run.log();
  EXPECT_EQ(run.number("n", 0), 1);
  EXPECT_TRUE(run.truth("b"));
  EXPECT_GE(run.number("n", 1), 0);
  EXPECT_LT(run.number("n", 2), 0);
}

TEST(Signals, AnArrayIsANumberOfBits) {
  SmallProject project;
  with_signals(project, "n[0]=dioGet(di)\nn[1]=dioSet(dq[1],1)");
  Running run(project);
  run.cabinet.inputs["BasicIO-1\\%I0"] = true;
  run.ticks(2);
  EXPECT_EQ(run.number("n", 0), 1);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorNotLinked) << "the third is not linked";
  EXPECT_TRUE(run.cabinet.outputs["BasicIO-1\\%Q0"]) << "what came before it was set";
}

TEST(Signals, ALinkIsTakenOver) {
  SmallProject project;
  with_signals(project, "dioLink(diNone,di)\nb=diNone");
  Running run(project);
  run.cabinet.inputs["BasicIO-1\\%I0"] = true;
  run.ticks(2);
  EXPECT_TRUE(run.truth("b"));
}

}  // namespace
}  // namespace val3
