// touchcal validate, and what touchcal identify writes besides its result: an arm file and a map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calib_core/identification/validate.hpp"
#include "config/arm_file.hpp"
#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTouches = std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json";

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class OfflineCommands : public ::testing::Test {
 protected:
  Finished call(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(arguments, folder_ / "call.err").wait();
  }
  Finished identify(const std::vector<std::string>& more) {
    return call({"touchcal", "identify", "--cell", cell_, "--touches", kTouches}, more);
  }
  Finished validate(const std::vector<std::string>& more = {}) {
    return call({"touchcal", "validate", "--cell", cell_, "--touches", kTouches}, more);
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  /// From here on the cell is a copy with another block.
  void edit_block(void (*edit)(json& block)) {
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder_ / "config",
                          std::filesystem::copy_options::recursive);
    cell_ = file("config/cells/edf/cell.json");
    json block = json::parse(read(file("config/cells/edf/block.json")));
    block["schema"] = "touchcal/block/2";
    edit(block);
    std::ofstream(file("config/cells/edf/block.json")) << block;
  }

  Folder folder_;
  std::string cell_ = cell_file("edf");
};

void expect_one_line(const Finished& finished, int exit_code, const std::string& part) {
  EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(part));
}

TEST_F(OfflineCommands, IdentifyTakesATemperatureOfTheBlockWithItsDeviation) {
  const json file = json::parse(identify({"--json"}).out);
  const json warm =
      json::parse(identify({"--json", "--block-temperature", "25", "--std-block-temperature", "0.5"}).out);
  EXPECT_EQ(file.at("conditions").at("block_temperature_source"), "file");
  EXPECT_EQ(warm.at("conditions").at("block_temperature_source"), "run");
  EXPECT_EQ(warm.at("conditions").at("block_temperature_c"), 25.0);
  EXPECT_EQ(warm.at("conditions").at("std_temperature_k"), 0.5);
  EXPECT_TRUE(warm.at("conditions").at("block_temperature_at").is_null());
  EXPECT_NE(warm.at("parameters"), file.at("parameters"));
  for (const std::vector<std::string>& half : {std::vector<std::string>{"--block-temperature", "25"},
                                               {"--std-block-temperature", "0.5"},
                                               {"--block-temperature", "298", "--std-block-temperature", "1"},
                                               {"--block-temperature", "25", "--std-block-temperature", "0"}})
    EXPECT_EQ(identify(half).exit_code, cell::kExitUsage) << half.front();
}

TEST_F(OfflineCommands, IdentifyEstimatesTheComplianceWhenItIsToldToWhateverTheRecipeSays) {
  for (const char* stiffness : {"on", "auto"}) {
    const json document = json::parse(identify({"--json", "--stiffness", stiffness}).out);
    EXPECT_EQ(document.at("model"), json::array({"compliance2", "compliance3"})) << stiffness;
    for (const json& parameter : document.at("nongeometric_parameters")) {
      EXPECT_EQ(parameter.at("unit"), "rad/Nm");
      EXPECT_TRUE(parameter.at("value").is_number() && parameter.at("std_uncertainty").is_number());
    }
  }
  for (const std::vector<std::string>& off :
       {std::vector<std::string>{"--json", "--stiffness", "off"}, std::vector<std::string>{"--json"}}) {
    const json document = json::parse(identify(off).out);  // edf-25 says off
    EXPECT_EQ(document.at("model"), json::array());
    EXPECT_EQ(document.at("model_reason"), nullptr);
  }
  EXPECT_EQ(identify({"--stiffness", "maybe"}).exit_code, cell::kExitUsage);
}

TEST_F(OfflineCommands, IdentifySimulatesAsManyCalibrationsAsItIsToldTo) {
  const json document = json::parse(identify({"--json", "--monte-carlo", "100"}).out);
  const json& simulated = document.at("monte_carlo");
  EXPECT_EQ(simulated.at("count"), 100);
  EXPECT_EQ(simulated.at("converged"), 100);
  EXPECT_GT(simulated.at("box_p95_mm"), simulated.at("box_rms_mm"));
  EXPECT_TRUE(simulated.at("joint_ranges_rms_mm").is_number());
  EXPECT_TRUE(simulated.at("linear_over_monte_carlo").is_number());
  EXPECT_EQ(json::parse(identify({"--json"}).out).at("monte_carlo"), nullptr);
  const Finished text = identify({"--monte-carlo", "100"});
  EXPECT_THAT(text.out, HasSubstr("100 of 100 simulated calibrations converged"));
  EXPECT_THAT(text.out, HasSubstr("in the arm's own frame"));
  EXPECT_EQ(text.err, "");
}

TEST_F(OfflineCommands, IdentifyRefusesCountsOfSimulatedCalibrationsThatMakeNoSense) {
  for (const char* count : {"99", "1000001", "0", "-5", "many", "1e3", ""}) {
    const Finished finished = identify({"--monte-carlo", count});
    EXPECT_EQ(finished.exit_code, cell::kExitUsage) << count;
    EXPECT_EQ(finished.out, "");
    EXPECT_THAT(finished.err, HasSubstr("--monte-carlo"));
  }
}

TEST_F(OfflineCommands, ValidatePassesThePapersTouchesAndSaysWhyThereIsNoOtherSet) {
  const Finished finished = validate({"--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("schema"), "touchcal/validation/1");
  EXPECT_EQ(document.at("identifiable_count"), kRank);
  const json& same = document.at("same_touches");
  EXPECT_EQ(same.at("passed"), true);
  EXPECT_LT(same.at("new_error_max_si").get<double>(), calib::kSameTouchesErrorMax);
  for (const json& parameter : same.at("parameters"))
    EXPECT_EQ(parameter.at("new_error").is_number(), parameter.at("status") == "identified") << parameter;
  EXPECT_EQ(document.at("planes").size(), static_cast<std::size_t>(kPlaneCount));
  const json& other = document.at("other_touches");
  EXPECT_EQ(other.at("done"), false);
  EXPECT_THAT(other.at("why_not").get<std::string>(), HasSubstr("there are 0"));
  EXPECT_EQ(document.at("planes_held_out"), json::array());
}

TEST_F(OfflineCommands, ValidateTakesAnotherSetFromAFile) {
  json half = json::parse(read(kTouches));
  const json all = half.at("touches");  // plane after plane
  half["touches"] = json::array();
  for (std::size_t i = 0; i < all.size(); i += 2) half["touches"].push_back(all[i]);
  const auto count = static_cast<int>(half["touches"].size());
  std::ofstream(file("half.json")) << half;
  const Finished finished = validate({"--other", file("half.json"), "--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("other_touches").at("done"), true) << document.at("other_touches").at("why_not");
  int held_out = 0;
  for (const json& plane : document.at("planes_held_out")) held_out += plane.at("touch_count").get<int>();
  EXPECT_EQ(held_out, count);

  const Finished text = validate({"--other", file("half.json")});
  for (const char* part : {"B.1", "B.2", "B.3", "B.4", "validation: passed"})
    EXPECT_THAT(text.out, HasSubstr(part));
}

TEST_F(OfflineCommands, ValidateTakesStiffnessAndTemperatureOfTheCommandLine) {
  const auto plane = [](const Finished& finished) {
    EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
    return json::parse(finished.out).at("planes").at(0);
  };
  const json as_written = plane(validate({"--json"}));
  const json warm = plane(validate({"--json", "--block-temperature", "60", "--std-block-temperature", "1"}));
  // A warmer block is larger, and the arm reads the same.
  EXPECT_NE(warm.at("nominal_mean_mm"), as_written.at("nominal_mean_mm"));
  const json bending = plane(validate({"--json", "--stiffness", "on"}));
  EXPECT_NE(bending.at("calibrated_rms_mm"), as_written.at("calibrated_rms_mm"));
  EXPECT_EQ(validate({"--stiffness", "maybe"}).exit_code, cell::kExitUsage);
}

TEST_F(OfflineCommands, ValidateTellsBadInputAsIdentifyDoes) {
  expect_one_line(validate({"--other", file("none.json")}), cell::kExitBadInput, "none.json");
  expect_one_line(validate({"--recipe", "edf-99"}), cell::kExitBadInput, "edf-99");
  json few = json::parse(read(kTouches));
  json& touches = few.at("touches");
  touches.erase(touches.begin() + 5, touches.end());
  std::ofstream(file("few.json")) << few;
  expect_one_line(call({"touchcal", "validate", "--cell", cell_, "--touches", file("few.json")}),
                  cell::kExitRefused, "few.json");
  EXPECT_EQ(call({"touchcal", "validate", "--cell", cell_}).exit_code, cell::kExitUsage);
}

TEST_F(OfflineCommands, AnExportedArmReadsBackWithItsErrorsAndIsNotOverwritten) {
  const Finished finished = identify({"--export", file("arm.json"), "--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitLimitsMissed);
  EXPECT_THAT(finished.err, HasSubstr("not accepted"));
  const cell::Arm arm = cell::read_arm(folder_ / "arm.json");
  const json parameters = json::parse(finished.out).at("parameters");
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double scale = parameters[i].at("unit") == "mm" ? 1e3 : 1.0;
    const json& error = parameters[i].at("error");
    const double expected =
        parameters[i].at("nominal").get<double>() + (error.is_number() ? error.get<double>() : 0.0);
    EXPECT_NEAR(scale * calib::parameter_value(arm.model, static_cast<int>(i)), expected, 1e-9)
        << parameters[i];
  }
  const std::string first = read(folder_ / "arm.json");
  const Finished again = identify({"--export", file("arm.json"), "--recipe", "edf-23", "--json"});
  expect_one_line(again, cell::kExitUsage, "--force");
  EXPECT_EQ(read(folder_ / "arm.json"), first);
  identify({"--export", file("arm.json"), "--recipe", "edf-23", "--json", "--force"});
  EXPECT_NE(read(folder_ / "arm.json"), first);
  expect_one_line(identify({"--export", file("no/folder/arm.json")}), cell::kExitFailed, "no/folder");
}

TEST_F(OfflineCommands, AnArmWhoseFramesTheCellGivesItselfIsExportedWithAWarning) {
  std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder_ / "config",
                        std::filesystem::copy_options::recursive);
  cell_ = file("config/cells/edf/cell.json");
  json cell = json::parse(read(cell_));
  cell["frames"] = {{{"j", 0}, {"theta_deg", 0}, {"r_mm", 149.6}}};
  std::ofstream(cell_) << cell;
  const Finished finished = identify({"--export", file("arm.json"), "--json"});
  EXPECT_THAT(finished.err, HasSubstr("frame 0"));
  EXPECT_EQ(json::parse(finished.out).at("cell_frames"), json::array({0}));
}

TEST_F(OfflineCommands, ABlockThatCanGrowAndHasNoTemperatureIsAWarning) {
  edit_block([](json& block) {
    for (const char* key : {"temperature_c", "std_temperature_k"}) block.erase(key);
  });
  EXPECT_THAT(identify({}).err, HasSubstr("block.json: /temperature_c is missing"));
  EXPECT_THAT(json::parse(identify({"--json"}).out).at("warnings").dump(), HasSubstr("/temperature_c"));
  EXPECT_THAT(identify({"--block-temperature", "21", "--std-block-temperature", "1"}).err,
              Not(HasSubstr("/temperature_c")));
}

TEST_F(OfflineCommands, ATemperatureOfYesterdayIsAWarning) {
  edit_block([](json& block) { block["temperature_at"] = "2020-01-31T08:00:00Z"; });
  const auto is_told =
      HasSubstr("block.json: /temperature_at: the block's temperature of 20.0 degrees C is ");
  for (const Finished& text : {identify({}), validate()}) EXPECT_THAT(text.err, is_told);
  for (const Finished& document : {identify({"--json"}), validate({"--json"})})
    EXPECT_THAT(json::parse(document.out).at("warnings"), ::testing::Contains(is_told));
  const std::vector<std::string> given{"--block-temperature", "21", "--std-block-temperature", "1"};
  for (const Finished& text : {identify(given), validate(given)}) EXPECT_THAT(text.err, Not(is_told));
}

TEST_F(OfflineCommands, TheMapHasALineForEachCell) {
  const Finished finished = identify({"--map", file("map.csv"), "--json"});
  const json map = json::parse(finished.out).at("tip_uncertainty").at("map");
  std::istringstream lines(read(folder_ / "map.csv"));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "x_mm,y_mm,z_mm,predicted_rms_mm");
  std::size_t count = 0;
  for (; std::getline(lines, line); ++count) EXPECT_EQ(std::ranges::count(line, ','), 3) << line;
  EXPECT_EQ(count, map.at("values_mm").size());
}

}  // namespace
}  // namespace touchcal::testing
