// A person's word makes a run's model the cell's: the three programs as processes, on the simulated demo
// cell.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "service/base/exit_code.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/end_to_end/running_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Approval : public ::testing::Test {
 protected:
  nlohmann::json model_by(const std::vector<std::string>& command) {
    const Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
    return nlohmann::json::parse(finished.out, nullptr, false);
  }
  nlohmann::json rows() { return model_by({"models", "--json"}).at("models"); }
  std::string refused(const std::vector<std::string>& command) {
    const Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitRefused) << finished.out;
    return finished.err;
  }
  void calibrate() {
    const Finished run = cell_.run({"run", kRecipe, "--operator", "P. Langevin", "--arm-moving", "45"});
    ASSERT_EQ(run.exit_code, cell::kExitDone) << run.err;
  }
  void end_daemon() {
    cell_.daemon().signal(SIGTERM);
    EXPECT_EQ(cell_.daemon().wait().exit_code, 0);
  }
  Finished verified() {
    return Process({"touchcald", "--state", cell_.state(), "--verify"}, cell_.folder() / "verify.err").wait();
  }
  /// One target corrected by an approved model.
  Finished compensated_by(const std::string& model, const std::string& cell = cell_file("demo")) {
    const std::string targets = (cell_.folder() / "targets.csv").string();
    std::ofstream(targets) << "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\n";
    return cell_.run({"compensate", "--cell", cell, "--model", model, "--targets", targets, "--json"});
  }
  /// What touchcal_abs gets of an approved model.
  std::string library_by(const std::string& model) {
    const std::string file = (cell_.folder() / "touchcal_abs.dtx").string();
    const Finished written = cell_.run({"compensate", "--cell", cell_file("demo"), "--model", model,
                                        "--library", file, "--flange-mm", "100"});
    EXPECT_EQ(written.exit_code, cell::kExitDone) << written.err;
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// The cell's file beside the daemon's, of another robot of the same kind.
  std::string cell_with_serial(const std::string& serial) {
    const auto folder = cell_.folder() / "config/cells/demo";
    nlohmann::json cell;
    std::ifstream(folder / "cell.json") >> cell;
    cell.at("arm_serial") = serial;
    std::ofstream(folder / "other.json") << cell;
    return (folder / "other.json").string();
  }
  /// The run goes to another daemon of the cell as a file, and can be approved there.
  void expect_to_travel(const std::string& run, const nlohmann::json& model) {
    const std::string file = (cell_.folder() / "run.json").string();
    const Finished exported = cell_.run({"export-run", run, file});
    ASSERT_EQ(exported.exit_code, cell::kExitDone) << exported.err;
    EXPECT_THAT(exported.out, HasSubstr("with its approved model"));
    EXPECT_EQ(cell_.run({"export-run", run, file}).exit_code, cell::kExitUsage) << "the file is there";
    EXPECT_THAT(refused({"import-run", file}), HasSubstr("is here already, as run " + run));

    const RunningCell other("demo", "max");
    const Finished imported = other.run({"import-run", file});
    ASSERT_EQ(imported.exit_code, cell::kExitDone) << imported.err;
    EXPECT_THAT(imported.out, HasSubstr("is run 1 here"));
    EXPECT_THAT(other.run({"show", "1"}).out, HasSubstr("imported: it is run " + run + " of cell"));
    EXPECT_THAT(other.run({"models"}).out, HasSubstr("no model is approved"));
    const auto approved = nlohmann::json::parse(other.run({"approve", "1", "--json"}).out, nullptr, false);
    EXPECT_EQ(approved.at("parameters"), model.at("parameters"));

    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
    EXPECT_EQ(other.run({"import-run", file}).exit_code, cell::kExitBadInput);
  }
  /// So many accepted runs behind those that are there that only a model keeps one of these.
  void make_other_runs() {
    cell::RunStore store(cell_.store_file());
    for (int i = 0; i < cell::kLastRunsKept; ++i) {
      const std::int64_t run = store.begin_run({.recipe = kRecipe, .started_at = on_day(i % 3)});
      store.finish_run(run, {.outcome = cell::RunOutcome::kComplete,
                             .verdict = cell::Verdict::kAccepted,
                             .ended_at = on_day(i % 3)});
    }
  }
  /// Far ahead of the clock of any machine that runs this, on one of several days.
  static std::string on_day(int day) { return "2126-01-0" + std::to_string(1 + day) + "T08:00:00.000Z"; }

  RunningCell cell_{"demo", "max"};
};

TEST_F(Approval, MakesAnAcceptedRunTheCellsModelUntilItIsRolledBackAlsoAcrossARestart) {
  EXPECT_THAT(cell_.run({"models"}).out, HasSubstr("no model is approved"));
  EXPECT_THAT(refused({"rollback"}), HasSubstr("no model is approved"));
  calibrate();
  const auto first = model_by({"approve", "1", "--operator", "M. Curie", "--valid-days", "90", "--json"});
  EXPECT_EQ(first.at("schema"), "touchcal/model/1");
  EXPECT_EQ(first.at("run_id"), "1");
  EXPECT_EQ(first.at("approved_by"), "M. Curie");
  EXPECT_EQ(first.at("arm"), "tx90");
  EXPECT_EQ(first.at("arm_moving_min"), 45);
  EXPECT_TRUE(first.at("proof_run_id").is_null());
  EXPECT_TRUE(first.at("valid_until").is_string());
  const auto result = nlohmann::json::parse(cell_.run({"show", "1", "--json"}).out);
  EXPECT_EQ(first.at("parameters"), result.at("parameters"));
  EXPECT_EQ(first.at("tip_uncertainty"), result.at("tip_uncertainty"));
  EXPECT_EQ(model_by({"approve", "1", "--json"}), first) << "the same word twice";
  EXPECT_THAT(cell_.run({"approve", "1"}).err, HasSubstr("the model is not proved"));
  EXPECT_THAT(refused({"rollback"}), HasSubstr("no model before that of run 1"));

  calibrate();
  const auto second = model_by({"approve", "2", "--json"});
  EXPECT_NE(second.at("hash"), first.at("hash"));
  const Finished shown = cell_.run({"models"});
  EXPECT_EQ(shown.exit_code, cell::kExitDone) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("the model of run 2 is the cell's"));
  EXPECT_THAT(shown.out, HasSubstr("not proved"));
  EXPECT_THAT(shown.out, HasSubstr("M. Curie"));
  EXPECT_EQ(model_by({"rollback", "--operator", "M. Curie", "--json"}), first);

  const Finished by_current = compensated_by("current");
  EXPECT_EQ(by_current.exit_code, cell::kExitDone) << by_current.err;
  EXPECT_EQ(nlohmann::json::parse(by_current.out).at("model"), first.at("hash"));
  EXPECT_EQ(compensated_by("1").out, by_current.out);
  const std::string digits = second.at("hash").get<std::string>().substr(0, 12);
  const Finished taken_back = compensated_by(digits);
  EXPECT_EQ(nlohmann::json::parse(taken_back.out).at("model"), second.at("hash"));
  EXPECT_THAT(taken_back.err, HasSubstr("is not the cell's any more"));
  EXPECT_EQ(by_current.err, "");
  const Finished other_robot = compensated_by("current", cell_with_serial("ANOTHER-ROBOT"));
  EXPECT_EQ(other_robot.exit_code, cell::kExitRefused);
  EXPECT_EQ(other_robot.out, "");
  EXPECT_THAT(other_robot.err, HasSubstr("the serial number 'SIMULATED-TX90-0001', and the cell's file has "
                                         "'ANOTHER-ROBOT'"));
  const std::string numbers = library_by("current");
  EXPECT_THAT(numbers, HasSubstr("value=\"SIMULATED-TX90-0001\""));
  EXPECT_THAT(numbers, HasSubstr("value=\"" + first.at("hash").get<std::string>() + "\""));
  EXPECT_THAT(numbers, HasSubstr("value=\"as warm as at the calibration\""));
  const std::string last_day =
      std::regex_replace(first.at("valid_until").get<std::string>().substr(0, 10), std::regex("-"), "");
  EXPECT_THAT(numbers, HasSubstr("value=\"" + last_day + "\""));
  const Finished unknown = compensated_by(digits.substr(1));
  EXPECT_EQ(unknown.exit_code, cell::kExitRefused);
  EXPECT_THAT(unknown.err, HasSubstr("touchcal models lists them"));

  const Finished noted = cell_.run({"applied", "pick.dtx on the robot", "--operator", "M. Curie"});
  EXPECT_EQ(noted.exit_code, cell::kExitDone) << noted.err;
  EXPECT_THAT(noted.out, HasSubstr("M. Curie: pick.dtx on the robot"));
  EXPECT_EQ(cell_.run({"applied", "it", "--model", digits}).exit_code, cell::kExitDone);
  EXPECT_THAT(refused({"applied", "it", "--model", digits.substr(1) + "00"}),
              HasSubstr("no approval has the hash"));
  EXPECT_EQ(cell_.run({"applied"}).exit_code, cell::kExitUsage);
  EXPECT_EQ(compensated_by("current").out, by_current.out) << "what is in use changes no model";

  end_daemon();
  cell_.start_daemon();
  ASSERT_EQ(rows().size(), 5U);
  EXPECT_EQ(rows()[0].at("hash"), second.at("hash"));
  EXPECT_EQ(rows()[1].at("applied_to"), "pick.dtx on the robot");
  EXPECT_EQ(rows()[2].at("kind"), "rolled_back");
  EXPECT_EQ(rows()[4].at("current"), true);
  EXPECT_EQ(rows()[4].at("hash"), first.at("hash"));
  EXPECT_EQ(model_by({"approve", "2", "--json"}).at("hash"), second.at("hash")) << "approved anew";
  EXPECT_EQ(rows().size(), 6U);
  const auto audit = nlohmann::json::parse(cell_.run({"audit", "--json"}).out).at("rows");
  EXPECT_EQ(audit[0].at("action"), "POST /api/v1/runs/2/approve");
  expect_to_travel("2", second);
}

TEST_F(Approval, OfARunThatWasNotAcceptedIsRefused) {
  Process run(cell_.call({"run", kRecipe}), cell_.folder() / "run.err");
  cell_.wait_for_touches(3);
  EXPECT_EQ(cell_.run({"stop"}).exit_code, cell::kExitDone);
  EXPECT_EQ(run.wait().exit_code, cell::kExitFailed);
  EXPECT_THAT(refused({"approve", "1"}), HasSubstr("only a run that is complete and accepted"));
  // A number that no run has is a wrong argument, whichever command it is given to; what the daemon has and
  // does not approve, or cannot take back, is refused.
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"approve", "2"},
                                             {"show", "2"},
                                             {"report", "2"},
                                             {"export", "2"},
                                             {"export-run", "2", (cell_.folder() / "run.json").string()},
                                             {"checks", "--of", "2"},
                                             {"compare", "1", "2"}}) {
    const Finished finished = cell_.run(command);
    EXPECT_EQ(finished.exit_code, cell::kExitUsage) << command[0] << ": " << finished.err;
  }
  EXPECT_EQ(cell_.run({"rollback"}).exit_code, cell::kExitRefused);
  EXPECT_EQ(cell_.run({"approve", "one"}).exit_code, cell::kExitUsage);
  EXPECT_EQ(cell_.run({"approve", "1", "--valid-days", "0"}).exit_code, cell::kExitUsage);
  EXPECT_THAT(rows(), IsEmpty());
}

TEST_F(Approval, KeepsItsRunHoweverOldThatIsAndAChangedByteIsFound) {
  calibrate();
  calibrate();
  model_by({"approve", "1", "--json"});
  end_daemon();
  make_other_runs();
  {
    const cell::RunStore store(cell_.store_file());
    EXPECT_EQ(cell::delete_runs_before(store.database(), on_day(0)), 1) << "the second run";
    EXPECT_TRUE(store.run(1));
    EXPECT_EQ(store.touches(1).size(), static_cast<std::size_t>(kTouchCount));
  }
  EXPECT_EQ(verified().exit_code, cell::kExitDone);
  SQLite::Database(cell_.store_file().string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE models SET document = replace(document, '\"run_id\":\"1\"', '\"run_id\":\"2\"')");
  const Finished damaged = verified();
  EXPECT_EQ(damaged.exit_code, cell::kExitBadInput);
  EXPECT_THAT(damaged.out + damaged.err, HasSubstr("table models, run 1, number 1"));
  cell_.start_daemon();
  const Finished told = cell_.run({"models"});
  EXPECT_NE(told.exit_code, cell::kExitDone);
  EXPECT_THAT(told.out, Not(HasSubstr("is the cell's")));
  EXPECT_THAT(told.err, HasSubstr("restore the last backup"));
}

}  // namespace
}  // namespace touchcal::testing
