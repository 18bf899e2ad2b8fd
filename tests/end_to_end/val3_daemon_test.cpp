// The daemon as a process against cs8sim that runs the VAL3 application which goes onto a controller.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/running_cell.hpp"
#include "tests/val3/small_project.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

const std::string kApplication = std::string(TOUCHCAL_SOURCE_DIR) + "/cs8_protocol/val3/touchcal";
constexpr const char* kShortest = "quick";  // of the shipped recipes

class Val3Daemon : public ::testing::Test {
 protected:
  /// cs8sim with our application, and what goes wrong: the faults of a fault file, or none.
  RunningCell& begin(const std::string& speed, const std::string& faults = "") {
    std::vector<std::string> more{"--val3", kApplication};
    if (!faults.empty()) {
      const auto file = folder_ / "faults.json";
      std::ofstream(file) << R"({"schema": "touchcal/faults/1", "faults": [)" << faults << "]}";
      more.insert(more.end(), {"--faults", file.string()});
    }
    return cell_.emplace("demo", speed, more);
  }
  /// `touchcal run` in the background.
  Process& run() { return run_.emplace(cell_->call({"run", kShortest, "--json"}), folder_ / "run.err"); }
  /// Both programs end at a signal as they should.
  void end() {
    cell_->daemon().signal(SIGTERM);
    EXPECT_EQ(cell_->daemon().wait().exit_code, 0);
    cell_->controller().signal(SIGTERM);
    const Finished controller = cell_->controller().wait();
    EXPECT_EQ(controller.exit_code, 0);
    EXPECT_THAT(controller.err, ::testing::Not(HasSubstr("stopped with error"))) << "no task died";
  }

  Folder folder_;
  std::optional<RunningCell> cell_;
  std::optional<Process> run_;
};

TEST_F(Val3Daemon, RunsToAnAcceptedResult) {
  RunningCell& cell = begin("max");
  const Finished finished = run().wait();
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const auto result = nlohmann::json::parse(finished.out);
  EXPECT_EQ(result.at("complete"), true);
  EXPECT_EQ(result.at("verdict").at("accepted"), true);
  EXPECT_EQ(cell.status().at("state"), "COMPLETE");
  end();
}

TEST_F(Val3Daemon, StopsInTheMiddleOfARunAndBeginsAnother) {
  RunningCell& cell = begin("50");
  Process& stopped = run();
  cell.wait_for_touches(3);
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  EXPECT_EQ(stopped.wait().exit_code, cell::kExitFailed);
  cell.wait_for_state("STOPPED");
  const auto history = nlohmann::json::parse(cell.run({"runs", "--json"}).out).at("runs");
  ASSERT_EQ(history.size(), 1U);
  EXPECT_EQ(history[0].at("outcome"), "stopped");
  EXPECT_GE(history[0].at("touches_done"), 3);
  EXPECT_EQ(cell.run({"reset"}).exit_code, cell::kExitDone);
  cell.wait_for_state("IDLE");
  Process& again = run();
  cell.wait_for_touches(3, "2");
  EXPECT_EQ(cell.run({"stop"}).exit_code, cell::kExitDone);
  EXPECT_EQ(again.wait().exit_code, cell::kExitFailed);
  end();
}

TEST_F(Val3Daemon, HoldsItsRunWhenTheLinkIsLostAndGoesOnBehindANewConfirmation) {
  RunningCell& cell = begin("max", R"({"fault": "half_open", "on": "touch_result", "count": 4})");
  const Finished lost = run().wait();
  EXPECT_EQ(lost.exit_code, cell::kExitFailed) << lost.err;
  const auto held = cell.status();
  EXPECT_EQ(held.at("state"), "HELD");
  // The link is silent, or the answer is late: on a busy machine either is seen first.
  EXPECT_THAT(held.at("fault_code"), AnyOf("link_lost", "answer_missing"));
  cell.wait_for_link();
  cell.wait_for_touches(3);  // the one whose acknowledgement was lost is settled on the new link
  EXPECT_EQ(cell.run({"resume"}).exit_code, cell::kExitDone);
  cell.wait_for_state("COMPLETE");
  const auto history = nlohmann::json::parse(cell.run({"runs", "--json"}).out).at("runs");
  ASSERT_EQ(history.size(), 1U) << "it is the same run";
  EXPECT_EQ(history[0].at("verdict"), "accepted");
  end();
}

/// cs8sim --val3 with somebody's application, which it does not come to serve or which ends at a signal.
class Val3Serving : public ::testing::Test {
 protected:
  std::vector<std::string> call() {
    return {"cs8sim",   "--cell",     cell_file("demo"), "--val3", project_.write().path().string(),
            "--listen", "127.0.0.1:0"};
  }

  val3::SmallProject project_;
  Folder folder_;
};

TEST_F(Val3Serving, RefusesAnApplicationAsARunDoes) {
  project_.number("n").program("start", "n=nothing");
  const Finished refused = Process(call(), folder_ / "cs8sim.err").wait();
  EXPECT_EQ(refused.exit_code, cell::kExitBadInput);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("start.pgx:3: "), HasSubstr("[undefined-name]"),
                                 HasSubstr("a controller would not load it; `cs8sim --check` tells more")));
}

TEST_F(Val3Serving, TellsWhatItDoesNotSimulateWithItsLine) {
  project_.data("j", "jointRx", "").data("m", "mdesc", "");
  project_.program("start", "movejf(j,flange,m,5)");
  const Finished refused = Process(call(), folder_ / "cs8sim.err").wait();
  EXPECT_EQ(refused.exit_code, cell::kExitBadInput);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("start.pgx:3: "), HasSubstr("movejf"), HasSubstr("[not-simulated]")));
}

TEST_F(Val3Serving, TellsAMissingCardAndServesAllTheSame) {
  project_.data("di", "dio", "<Value key=\"0\" link=\"NoCard\\nothing\"/>");
  project_.program("start", "while true\ndelay(1)\nendWhile");
  Process serving(call(), folder_ / "cs8sim.err");
  serving.wait_for_address();
  serving.signal(SIGTERM);
  const Finished finished = serving.wait();
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.err, HasSubstr("di is linked to NoCard\\nothing, and there is no card NoCard"));
}

}  // namespace
}  // namespace touchcal::testing
