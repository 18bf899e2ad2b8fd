// Points whose frame is a variable of a call: manual 6, page 133.
#include "sim_controller/val3/machine/fathers.hpp"

#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

constexpr int kLinkedToLocal = 165;

/// An application with points and a frame of its own and a program inner(), which has a frame of its own.
SmallProject& with_call(SmallProject& project, const std::string& code, const std::string& more_locals = "") {
  with_variables(project);
  project.data("fG", "frame", "<Value key=\"0\" x=\"100\" fatherId=\"world[0]\"/>");
  project.data("pG", "pointRx",
               "<Value key=\"0\" x=\"1\" fatherId=\"world[0]\"/><Value key=\"1\" fatherId=\"world[0]\"/>", 2);
  return project.program(
      "inner", code,
      SmallProject::parameters(SmallProject::parameter("x_f", "frame", "xsi:type=\"element\"")) +
          SmallProject::locals(SmallProject::local_variable("l_f", "frame") +
                               SmallProject::local_variable("l_p", "pointRx") + more_locals));
}

/// With which error start() ends; 1: it runs.
int status_of(SmallProject& project) {
  Running run(project);
  run.ticks(6);
  return run.machine().task_status("small~");
}

TEST(Fathers, APointOfACallIsInAFrameOfThatCall) {
  SmallProject project;
  with_call(project, "link(l_p,x_f)\nn[0]=distance(l_p,pG)\nlink(x_f,fG)\nn[1]=distance(l_p,pG)");
  project.program("start", "call inner(fG)\nwait(false)");
  Running run(project);
  run.ticks(3);
  EXPECT_EQ(run.machine().task_status("small~"), 1);
  EXPECT_NEAR(run.number("n", 0), 99, 1e-9);
  EXPECT_NEAR(run.number("n", 1), 199, 1e-9);
}

TEST(Fathers, AGlobalIsNotLinkedToALocal) {
  for (const std::string& link : std::vector<std::string>{"link(pG,x_f)", "link(pG,l_f)", "link(fG,l_f)"}) {
    SmallProject project;
    with_call(project, link).program("start", "call inner(fG)\nwait(false)");
    EXPECT_EQ(status_of(project), kLinkedToLocal) << link;
  }
}

TEST(Fathers, APointThatHasAFrameOfACallThatIsOverHasNone) {
  // Small calls are kept for the next, large ones and those of a deep recursion are not.
  for (const std::string& more : {std::string(), SmallProject::local_variable("l_n", "num", 3000)}) {
    SmallProject project;
    with_call(project, "link(l_p,l_f)\npG=l_p", more);
    project.program("start", "call inner(fG)\nn[0]=distance(pG,pG[1])\nwait(false)").stack(1'000'000);
    EXPECT_EQ(status_of(project), kLinkedToLocal);
  }
  SmallProject deep;
  with_call(deep, "n[0]=n[0]+1\nif n[0]<80\ncall inner(fG)\nendIf\nlink(l_p,l_f)\npG=l_p").stack(1'000'000);
  deep.program("start", "call inner(fG)\nn[1]=distance(pG,pG[1])\nwait(false)");
  EXPECT_EQ(status_of(deep), kLinkedToLocal);
}

TEST(Fathers, ANumberIsNotGivenTwice) {
  Fathers fathers;
  Array<Frame> first(Type{Kind::kFrame, -1}, 1), second(Type{Kind::kFrame, -1}, 1);
  Father of_first;
  {
    CallFathers call;
    call.add(fathers, first);
    of_first = fathers.father_of({.array = &first});
    EXPECT_NO_THROW((void)fathers.frame_in_world(of_first));
  }
  CallFathers call;
  call.add(fathers, second);
  EXPECT_THROW((void)fathers.frame_in_world(of_first), RunFailure);
}

}  // namespace
}  // namespace val3
