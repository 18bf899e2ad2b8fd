// touchcal prove and touchcal check: the three programs as processes, on the simulated demo cell.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/running_cell.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class VerifyCommands : public ::testing::Test {
 protected:
  Finished done(const std::vector<std::string>& command) {
    Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitDone) << command.front() << ": " << finished.err;
    return finished;
  }
  std::string refused(const std::vector<std::string>& command) {
    const Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitRefused) << finished.out;
    return finished.err;
  }

  RunningCell cell_{"demo", "max"};
};

TEST_F(VerifyCommands, AreHeldAgainstACalibrationAndAreNone) {
  EXPECT_THAT(refused({"check"}), HasSubstr("there is no accepted calibration"));
  done({"run", "quick"});
  EXPECT_THAT(done({"check"}).out, HasSubstr("reference check 1 of 3"));
  done({"check", "--of", "1"});
  EXPECT_THAT(done({"check"}).out, HasSubstr("reference check 3 of 3"));
  const auto check = nlohmann::json::parse(done({"check", "--json", "--operator", "M. Curie"}).out);
  EXPECT_EQ(check.at("schema"), "touchcal/check/1");
  EXPECT_EQ(check.at("verdict").at("accepted"), true) << check;
  EXPECT_THAT(done({"show", "5"}).out,
              AllOf(HasSubstr("UNCHANGED since the reference"), HasSubstr("joint 5")));
  const auto runs = nlohmann::json::parse(done({"runs", "--json"}).out).at("runs");
  EXPECT_EQ(runs.at(0).at("kind"), "check");
  EXPECT_EQ(runs.at(0).at("of_run"), "1");
  EXPECT_EQ(runs.at(4).at("kind"), "calibration");
  EXPECT_TRUE(runs.at(4).at("of_run").is_null());
}

TEST_F(VerifyCommands, WhatIsNoCalibrationIsNeitherApprovedNorProvedNorReported) {
  done({"run", "quick"});
  done({"check"});
  EXPECT_THAT(refused({"prove"}), HasSubstr("proves nothing: lift it by 300 mm"));
  EXPECT_THAT(refused({"check", "--of", "2"}), HasSubstr("run 2 is a check"));
  EXPECT_THAT(refused({"prove", "--of", "7"}), HasSubstr("there is no run 7"));
  EXPECT_THAT(refused({"approve", "2"}), HasSubstr("run 2 is a check, which has no model"));
  EXPECT_THAT(refused({"report", "2"}), HasSubstr("a check has no report of this form"));
}

}  // namespace
}  // namespace touchcal::testing
