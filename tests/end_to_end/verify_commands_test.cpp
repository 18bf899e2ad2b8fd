// touchcal prove and touchcal check: the three programs as processes, on the simulated demo cell.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/running_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class VerifyCommands : public ::testing::Test {
 protected:
  Finished done(const std::vector<std::string>& command) {
    Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitDone) << command.front() << ": " << finished.err;
    return finished;
  }
  std::string refused(const std::vector<std::string>& command, int exit_code = cell::kExitRefused) {
    const Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, exit_code) << finished.out;
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
  const std::string page = done({"report", "5"}).out;
  EXPECT_THAT(page, AllOf(HasSubstr("<h1>Check report "), HasSubstr("Verdict: unchanged"),
                          HasSubstr("<td>calibration that is checked</td><td>run 1 of "),
                          HasSubstr("<td>M. Curie</td>")));
  EXPECT_THAT(done({"report", "2"}).out,
              AllOf(HasSubstr("Verdict: none"), HasSubstr("reference check 1 of 3")));
  EXPECT_THAT(done({"report", "5", "--language", "de"}).out, HasSubstr("<html lang=\"de\">"));
  EXPECT_THAT(done({"report", "5", "--csv"}).out, HasSubstr(",deviation_mm,captured_at\n1,"));
  const auto report = nlohmann::json::parse(done({"report", "5", "--json"}).out);
  EXPECT_EQ(report.at("schema"), "touchcal/verification-report/1");
  EXPECT_EQ(report.at("result"), check);
  EXPECT_EQ(report.at("touches").at(3).at("deviation_mm"), check.at("touches").at(3).at("change_mm"));

  const auto runs = nlohmann::json::parse(done({"runs", "--json"}).out).at("runs");
  EXPECT_EQ(runs.at(0).at("kind"), "check");
  EXPECT_EQ(runs.at(0).at("of_run"), "1");
  EXPECT_EQ(runs.at(4).at("kind"), "calibration");
  EXPECT_TRUE(runs.at(4).at("of_run").is_null());

  EXPECT_THAT(done({"checks"}).out,
              AllOf(HasSubstr("checks of run 1: 4, reference of 3 of 3, limits from 1 of 10"),
                    HasSubstr("none is due"), ContainsRegex("2 .*reference  *-  *-"),
                    ContainsRegex("5 .*unchanged +-?0[.][0-9]{3}")));
  const auto checks = nlohmann::json::parse(done({"checks", "--of", "1", "--json"}).out);
  EXPECT_EQ(checks.at("charts").at(4).at("quantity"), "growth");
  EXPECT_EQ(checks.at("charts").at(4).at("points").at(0).at("value"), check.at("growth_ppm"));
  const Finished unknown = cell_.run({"checks", "--of", "2"});
  EXPECT_EQ(unknown.exit_code, cell::kExitUsage) << unknown.out;
  EXPECT_THAT(unknown.err, HasSubstr("there is no calibration '2'"));
  for (const std::string command : {"prove", "check", "qualify"}) {
    const Finished of_none = cell_.run({command, "--of", "99"});
    EXPECT_EQ(of_none.exit_code, cell::kExitUsage) << command << ": " << of_none.out;
    EXPECT_THAT(of_none.err, HasSubstr("there is no run 99"));
  }
  EXPECT_EQ(cell_.run({"check", "--of", "last"}).exit_code, cell::kExitUsage);

  EXPECT_EQ(done({"names", "runs"}).out, "5\n4\n3\n2\n1\n");
  EXPECT_THAT(done({"names", "recipes"}).out, HasSubstr("quick\n"));

  // A person's word applies the growth that the check found beside the model.
  done({"approve", "1"});
  const std::string targets = (cell_.folder() / "targets.csv").string();
  std::ofstream(targets) << "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\n";
  const auto compensated = [&](std::vector<std::string> more) {
    std::vector<std::string> command{"compensate", "--cell",    cell_file("demo"), "--model",
                                     "current",    "--targets", targets,           "--json"};
    command.insert(command.end(), more.begin(), more.end());
    return cell_.run(command);
  };
  EXPECT_TRUE(nlohmann::json::parse(compensated({}).out).at("warmth").is_null());
  const auto warmth = nlohmann::json::parse(compensated({"--check", "5"}).out).at("warmth");
  EXPECT_EQ(warmth.at("check_run_id"), "5");
  EXPECT_DOUBLE_EQ(warmth.at("growth_ppm").get<double>(), check.at("growth_ppm").get<double>());
  const Finished refused = compensated({"--check", "2"});
  EXPECT_EQ(refused.exit_code, cell::kExitRefused) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("check 2 has no verdict"));
  for (const char* option : {"--check", "--tool-run"})
    EXPECT_EQ(compensated({option, "99"}).exit_code, cell::kExitUsage) << "no such run";
}

TEST_F(VerifyCommands, TwoCalibrationsOfTheSameArmDoNotDiffer) {
  done({"run", "quick"});
  done({"run", "quick"});
  EXPECT_THAT(done({"compare", "1", "2"}).out,
              AllOf(HasSubstr("runs 1 and 2: UNCHANGED"), HasSubstr("arm: as it was"), HasSubstr("E_n")));
  const auto compared = nlohmann::json::parse(done({"compare", "2", "1", "--json"}).out);
  EXPECT_EQ(compared.at("earlier"), "1");
  EXPECT_EQ(compared.at("verdict").at("accepted"), true) << compared;
  EXPECT_LT(compared.at("tip_difference_mm").get<double>(),
            3.0 * compared.at("std_tip_difference_mm").get<double>());
  EXPECT_THAT(refused({"compare", "1", "7"}, cell::kExitUsage), HasSubstr("there is no run 7"));
  EXPECT_THAT(refused({"compare", "1", "1"}, cell::kExitUsage), HasSubstr("with which run?"));
}

TEST_F(VerifyCommands, WhatIsNoCalibrationIsNeitherApprovedNorProvedNorSimulated) {
  done({"run", "quick"});
  done({"check"});
  EXPECT_THAT(refused({"prove"}), HasSubstr("proves nothing: lift it by 300 mm"));
  EXPECT_THAT(refused({"check", "--of", "2"}), HasSubstr("run 2 is a check"));
  EXPECT_THAT(refused({"prove", "--of", "7"}, cell::kExitUsage), HasSubstr("there is no run 7"));
  EXPECT_THAT(refused({"approve", "2"}), HasSubstr("run 2 is a check, which has no model"));
  EXPECT_THAT(refused({"report", "2", "--monte-carlo", "100"}),
              HasSubstr("run 2 is a check, which calibrates nothing that could be simulated"));
}

}  // namespace
}  // namespace touchcal::testing
