// Sockets as `=` reads and writes them: manual 6, pages 61 to 64.
#include "sim_controller/val3/machine/channels.hpp"

#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

SmallProject& with_socket(SmallProject& project, const std::string& lines) {
  project.data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>")
      .data("siNone", "sio", "<Value key=\"0\"/>");
  return with_variables(project).program("start", lines);
}

TEST(Channels, BytesAndStringsGoBothWays) {
  SmallProject project;
  with_socket(project, "n[0]=si\ns[0]=si\nsi=n[0]+1\nsi=\"ok\"\nsi=-1\nwait(false)");
  Running run(project);
  Socket& socket = run.cabinet.sockets["Socket\\host"];
  ASSERT_TRUE(socket.connect());
  socket.to_controller = {65, 'a', 'b'};
  run.ticks(2);
  EXPECT_EQ(run.number("n", 0), 65);
  EXPECT_TRUE(socket.to_host.empty()) << "the string has no end yet";
  socket.to_controller.push_back('c');
  socket.to_controller.push_back(13);
  run.ticks(2);
  EXPECT_EQ(run.text("s", 0), "abc");
  EXPECT_EQ(socket.to_host, (std::vector<std::uint8_t>{66, 'o', 'k', 13, 255})) << run.log();
}

TEST(Channels, ATimeOutEndsAReadAndIsAnErrorBehindAnEqualsSign) {
  SmallProject project;
  with_socket(project, "n[0]=sioCtrl(si,\"timeout\",0.04)\nn[1]=sioGet(si,n[5])\nn[2]=clock()\nn[3]=si");
  Running run(project);
  run.ticks(30);
  EXPECT_EQ(run.number("n", 1), -1);
  EXPECT_NEAR(run.number("n", 2), 0.04, 0.005);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorTimeout);
}

TEST(Channels, AConnectionThatThePeerClosedIsReadToItsEndAndNotWaitedFor) {
  SmallProject project;
  with_socket(project,
              "n[0]=sioCtrl(si,\"timeout\",0)\nn[1]=sioGet(si,n[5])\nn[2]=sioGet(si,n[5])\n"
              "n[3]=sioSet(si,n[5])\nn[4]=si");
  Running run(project);
  run.ticks(2);
  Socket& socket = run.cabinet.sockets["Socket\\host"];
  ASSERT_TRUE(socket.connect());
  socket.to_controller = {65};
  socket.close_by_host();
  run.ticks(2);
  EXPECT_EQ(run.number("n", 1), 1);
  EXPECT_EQ(run.number("n", 5), 65);
  EXPECT_EQ(run.number("n", 2), -1);
  EXPECT_EQ(run.number("n", 3), -1);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorInputOutput);
}

TEST(Channels, WithoutALinkTheyAreError123) {
  for (const std::string line : {"n[0]=sioGet(siNone,n)", "n[0]=siNone", "siNone=1", "clearBuffer(siNone)"}) {
    SmallProject project;
    with_socket(project, line);
    Running run(project);
    run.ticks(2);
    EXPECT_EQ(run.machine().task_status("small~"), kErrorNotLinked) << line;
  }
}

TEST(Channels, EveryNumberIsAByteModulo256) {
  SmallProject project;
  with_socket(project, "n[0]=256\nn[1]=-1\nn[2]=1.6\nn[3]=sioSet(si,n)\nwait(false)");
  Running run(project);
  Socket& socket = run.cabinet.sockets["Socket\\host"];
  ASSERT_TRUE(socket.connect());
  run.ticks(2);
  EXPECT_EQ(run.number("n", 3), 20) << "the whole array";
  ASSERT_EQ(socket.to_host.size(), 20U);
  EXPECT_EQ(socket.to_host[0], 0);
  EXPECT_EQ(socket.to_host[1], 255);
  EXPECT_EQ(socket.to_host[2], 2);
}

}  // namespace
}  // namespace val3
