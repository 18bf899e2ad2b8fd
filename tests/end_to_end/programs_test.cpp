// The three programs as processes: their exit codes, what they print and where.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/arm_file.hpp"
#include "service/base/exit_code.hpp"
#include "service/store/run_store.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/running_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kExactTouches = std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json";

class Programs : public ::testing::Test {
 protected:
  Finished run(const std::vector<std::string>& arguments) {
    return Process(arguments, folder_ / "call.err").wait();
  }

  Folder folder_;
};

TEST_F(Programs, TellTheirUsageAndTheirVersion) {
  for (const std::string program : {"touchcald", "touchcal", "cs8sim"}) {
    const Finished help = run({program, "--help"});
    EXPECT_EQ(help.exit_code, cell::kExitDone) << program;
    EXPECT_THAT(help.out, HasSubstr("--")) << program;
    EXPECT_EQ(help.err, "") << program;
    const Finished version = run({program, "--version"});
    EXPECT_EQ(version.exit_code, cell::kExitDone) << program;
    EXPECT_EQ(version.out, program + " " TOUCHCAL_VERSION "\n");
    EXPECT_EQ(version.err, "") << program;
  }
}

TEST_F(Programs, EndWithTwoWhenTheyAreUsedWrongly) {
  const std::string cell = cell_file("edf");
  const std::vector<std::vector<std::string>> calls{
      {"touchcald"},
      {"touchcald", "--nonsense"},
      {"touchcald", "--cell", cell, "--listen", "nowhere"},
      {"touchcald", "--cell", cell, "--controller", "127.0.0.1:high"},
      {"touchcal"},
      {"touchcal", "levitate"},
      {"touchcal", "identify"},
      {"touchcal", "identify", "--cell", cell, "--touches"},
      {"touchcal", "validate", "--cell", cell},
      {"touchcal", "export", "1"},
      {"touchcal", "export", "one", "--arm", "-"},
      {"touchcal", "export", "1", "--urdf", "-", "--dh", "-"},
      {"touchcal", "status", "--daemon", "gopher://127.0.0.1"},
      {"cs8sim"},
      {"cs8sim", "--cell", cell, "--speed", "-1"},
      {"cs8sim", "--cell", cell, "--seed", "-1"},
      {"cs8sim", "--cell", cell, "--listen", "127.0.0.1:0", "--block", "shelf"},
      {"cs8sim", "--cell", cell, "--listen", "127.0.0.1"}};
  for (const std::vector<std::string>& call : calls) {
    const Finished finished = run(call);
    EXPECT_EQ(finished.exit_code, cell::kExitUsage) << ::testing::PrintToString(call);
    EXPECT_EQ(finished.out, "") << ::testing::PrintToString(call);
    EXPECT_NE(finished.err, "") << ::testing::PrintToString(call);
  }
}

TEST_F(Programs, IdentifyThePapersArmFromAFileAndFlagIt) {
  const Finished json =
      run({"touchcal", "identify", "--cell", cell_file("edf"), "--touches", kExactTouches, "--json"});
  EXPECT_EQ(json.exit_code, cell::kExitLimitsMissed) << json.err;
  EXPECT_EQ(json.err, "");
  const auto result = nlohmann::json::parse(json.out);
  EXPECT_EQ(result.at("schema"), "touchcal/result/1");
  EXPECT_EQ(result.at("identifiable_count"), kRank);
  EXPECT_EQ(result.at("verdict").at("reasons"), nlohmann::json::array({result.at("scale").at("warning")}));
  const Finished text = run({"touchcal", "identify", "--cell", cell_file("edf"), "--touches", kExactTouches});
  EXPECT_EQ(text.exit_code, cell::kExitLimitsMissed);
  EXPECT_THAT(text.out, HasSubstr("alpha1"));
}

TEST_F(Programs, TellADaemonThatIsNotThere) {
  // A port that is bound and not listened at stays nobody's for the time of the test.
  boost::asio::io_context io;
  boost::asio::ip::tcp::acceptor held(io, boost::asio::ip::tcp::v4());
  held.bind({boost::asio::ip::address_v4::loopback(), 0});
  const std::string url = "http://127.0.0.1:" + std::to_string(held.local_endpoint().port());
  for (const char* command : {"status", "run", "stop", "runs", "watch"}) {
    const Finished finished = run({"touchcal", command, "--daemon", url});
    EXPECT_EQ(finished.exit_code, cell::kExitUnreachable) << command;
    EXPECT_EQ(finished.out, "") << command;
    EXPECT_THAT(finished.err, HasSubstr(url)) << command;
  }
}

TEST(Daemon, RunsTheDefaultRecipeOfTheCellWhereNoneIsNamed) {
  RunningCell cell("star", "max");
  const Finished run = cell.run({"run", "--json"});
  EXPECT_EQ(run.exit_code, cell::kExitDone) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out).at("recipe"), "star");
}

TEST(Daemon, RunsOneCalibrationForOneCommandAndBothServersEndAtASignal) {
  RunningCell cell("demo", "max");
  const Finished run = cell.run({"run", kRecipe, "--json"});
  EXPECT_EQ(run.exit_code, cell::kExitDone) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  EXPECT_EQ(result.at("schema"), "touchcal/result/1");
  EXPECT_EQ(result.at("complete"), true);
  EXPECT_EQ(result.at("verdict").at("accepted"), true);
  EXPECT_EQ(cell.status().at("state"), "COMPLETE");
  const Finished shown = cell.run({"show", "1", "--json"});
  EXPECT_EQ(nlohmann::json::parse(shown.out), result);

  const std::string arm_file = (cell.folder() / "arm.json").string();
  const Finished exported = cell.run({"export", "1", "--arm", arm_file});
  EXPECT_EQ(exported.exit_code, cell::kExitDone) << exported.err;
  EXPECT_EQ(exported.err, "");
  EXPECT_EQ(cell.run({"export", "1", "--arm", arm_file}).exit_code, cell::kExitUsage) << "it is there";
  const cell::Arm arm = cell::read_arm(arm_file);
  const auto& r0 = result.at("parameters").at(1);
  EXPECT_NEAR(calib::mm_from_metres(arm.model.links[0].r_m),
              r0.at("nominal").get<double>() + r0.at("error").get<double>(), 1e-9);
  const Finished printed = cell.run({"export", "1", "--arm", "-"});
  EXPECT_EQ(nlohmann::json::parse(printed.out).at("schema"), "touchcal/arm/5");
  EXPECT_TRUE(arm.covariance);
  EXPECT_EQ(cell.run({"export", "2", "--arm", "-"}).exit_code, cell::kExitUsage) << "no such run";
  const std::string urdf_file = (cell.folder() / "arm.urdf").string();
  const Finished forms = cell.run({"export", "1", "--urdf", urdf_file, "--dh", "-"});
  EXPECT_EQ(forms.exit_code, cell::kExitDone) << forms.err;
  EXPECT_THAT(forms.out, StartsWith("# tx90: the calibrated arm of run 1\n"));
  EXPECT_TRUE(std::filesystem::exists(urdf_file));
  const std::string dh_file = (cell.folder() / "dh.json").string();
  EXPECT_EQ(cell.run({"export", "1", "--urdf", urdf_file, "--dh", dh_file}).exit_code, cell::kExitUsage);
  EXPECT_FALSE(std::filesystem::exists(dh_file)) << "all or nothing";

  const Finished page = cell.run({"report", "1", "--html"});
  EXPECT_EQ(page.exit_code, cell::kExitDone) << page.err;
  EXPECT_THAT(page.out, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page.out, HasSubstr("Verdict: accepted"));
  EXPECT_THAT(cell.run({"report", "1", "--language", "fr"}).out, HasSubstr("<html lang=\"fr\">"));
  EXPECT_EQ(cell.run({"report", "1", "--language", "fr", "--csv"}).exit_code, cell::kExitUsage);
  EXPECT_EQ(cell.run({"report", "1", "--language", "it"}).exit_code, cell::kExitUsage);
  EXPECT_THAT(cell.run({"report", "1", "--csv"}).out, StartsWith("touch,plane,role,"));
  EXPECT_EQ(nlohmann::json::parse(cell.run({"report", "1", "--json"}).out).at("schema"), "touchcal/report/1");
  const Finished printed_page = cell.run({"report", "1", "--pdf"});
  EXPECT_EQ(printed_page.exit_code, cell::kExitDone) << printed_page.err;
  EXPECT_THAT(printed_page.out, StartsWith("%PDF-"));
  EXPECT_EQ(cell.run({"report", "2"}).exit_code, cell::kExitUsage) << "no such run";

  const Finished audit = cell.run({"audit", "--json"});
  EXPECT_EQ(audit.exit_code, cell::kExitDone) << audit.err;
  const auto rows = nlohmann::json::parse(audit.out).at("rows");
  ASSERT_GE(rows.size(), 2U);
  EXPECT_EQ(rows.back().at("outcome"), "asked") << "newest first";
  EXPECT_THAT(cell.run({"audit"}).out, HasSubstr("POST /api/v1/runs"));
  const Finished table = cell.run({"audit", "--csv", "--limit", "1"});
  EXPECT_THAT(table.out, StartsWith("id,at,role,token,operator,remote,action,outcome,detail,hash\r\n"));
  EXPECT_EQ(std::ranges::count(table.out, '\n'), 2) << table.out;
  EXPECT_EQ(cell.run({"audit", "--csv", "--json"}).exit_code, cell::kExitUsage);

  cell.daemon().signal(SIGTERM);
  EXPECT_EQ(cell.daemon().wait().exit_code, 0);
  cell.controller().signal(SIGTERM);
  EXPECT_EQ(cell.controller().wait().exit_code, 0);
}

TEST(Daemon, SaysThatTheControllerWasLostWhenItIsKilledInARun) {
  RunningCell cell("edf", "50");
  Process run(cell.call({"run", kRecipe, "--json"}), cell.folder() / "run.err");
  cell.wait_for_touches(3);
  cell.controller().signal(SIGKILL);
  const Finished finished = run.wait();
  EXPECT_EQ(finished.exit_code, cell::kExitFailed) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("link"));
  // Nothing was begun this time: a start whose preconditions are not met is refused.
  EXPECT_EQ(cell.run({"run", kRecipe}).exit_code, cell::kExitRefused);
  const auto status = cell.status();
  EXPECT_EQ(status.at("state"), "HELD");
  EXPECT_EQ(status.at("fault_code"), "link_lost");
  EXPECT_EQ(status.at("verdict"), "none");
  EXPECT_GE(status.at("touches_done"), 3);
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  cell.daemon().signal(SIGTERM);
  EXPECT_EQ(cell.daemon().wait().exit_code, 0);
}

/// SIGHUP comes from a terminal that is closed.
class DaemonAtASignal : public ::testing::TestWithParam<int> {};

TEST_P(DaemonAtASignal, EndsInTheMiddleOfARunAndLeavesItForTheNextOne) {
  RunningCell cell("edf", "50");
  Process run(cell.call({"run", kRecipe, "--json"}), cell.folder() / "run.err");
  cell.wait_for_touches(3);
  cell.daemon().signal(GetParam());
  EXPECT_EQ(cell.daemon().wait().exit_code, 0);
  EXPECT_EQ(run.wait().exit_code, cell::kExitUnreachable);
  cell.controller().signal(SIGTERM);
  EXPECT_EQ(cell.controller().wait().exit_code, 0);
  const cell::RunStore store(cell.store_file());
  EXPECT_EQ(store.run(1)->outcome, cell::RunOutcome::kRunning);
  EXPECT_GE(store.touches(1).size(), 3U);
}

INSTANTIATE_TEST_SUITE_P(Signals, DaemonAtASignal, ::testing::Values(SIGTERM, SIGHUP, SIGINT));

/// A pipe at this path, which nobody reads any more once it goes.
class LogReader {
 public:
  explicit LogReader(std::filesystem::path pipe) : pipe_(std::move(pipe)) {
    std::filesystem::remove(pipe_);
    if (::mkfifo(pipe_.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
    reads_ = ::open(pipe_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  }
  ~LogReader() {
    ::close(reads_);
    std::filesystem::remove(pipe_);
  }
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;
  [[nodiscard]] bool has_something() const {
    pollfd readable{reads_, POLLIN, 0};
    return ::poll(&readable, 1, 0) == 1;
  }

 private:
  std::filesystem::path pipe_;
  int reads_ = -1;
};

TEST(Daemon, GoesOnWithItsRunWhereTheReaderOfItsLogHasEnded) {
  RunningCell cell("edf", "50");
  cell.daemon().signal(SIGTERM);
  EXPECT_EQ(cell.daemon().wait().exit_code, 0);
  {
    const LogReader reader(cell.folder() / "touchcald.err");
    cell.start_daemon();
    EXPECT_TRUE(reader.has_something()) << "it is the log";
  }
  Process run(cell.call({"run", kRecipe, "--json"}), cell.folder() / "run.err");
  cell.wait_for_touches(3);  // each of them is a line of the log
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  EXPECT_EQ(run.wait().exit_code, cell::kExitFailed);
  cell.daemon().signal(SIGTERM);
  EXPECT_EQ(cell.daemon().wait().exit_code, 0);
}

TEST(Daemon, ThatWasKilledFindsItsRunAndResumesItOrRunsAgain) {
  RunningCell cell("edf", "50");
  Process run(cell.call({"run", kRecipe, "--json"}), cell.folder() / "run.err");
  cell.wait_for_touches(3);
  cell.daemon().signal(SIGKILL);
  EXPECT_EQ(cell.daemon().wait().exit_code, 128 + SIGKILL);
  EXPECT_EQ(run.wait().exit_code, cell::kExitUnreachable);

  cell.start_daemon();
  const auto held = cell.status();
  EXPECT_EQ(held.at("state"), "HELD");
  EXPECT_EQ(held.at("fault_code"), "daemon_restarted");
  EXPECT_EQ(held.at("run_id"), "1");
  const int done = held.at("touches_done");
  EXPECT_GE(done, 3);
  EXPECT_EQ(cell.run({"resume"}).exit_code, cell::kExitDone);
  cell.wait_for_touches(done + 2);

  cell.daemon().signal(SIGKILL);
  cell.daemon().wait();
  cell.start_daemon();
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  cell.wait_for_state("STOPPED");  // the run's end is stored by then
  const auto history = nlohmann::json::parse(cell.run({"runs", "--json"}).out).at("runs");
  ASSERT_EQ(history.size(), 1U);
  EXPECT_EQ(history[0].at("outcome"), "interrupted");
  EXPECT_EQ(history[0].at("verdict"), "incomplete");
  EXPECT_GE(history[0].at("touches_done"), done + 2);
  EXPECT_EQ(cell.run({"reset"}).exit_code, cell::kExitDone);
  Process again(cell.call({"run", kRecipe, "--json"}), cell.folder() / "run.err");
  cell.wait_for_touches(3, "2");
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  EXPECT_EQ(again.wait().exit_code, cell::kExitFailed);
}

}  // namespace
}  // namespace touchcal::testing
