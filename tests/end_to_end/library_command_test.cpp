// touchcal compensate --library: the numbers of touchcal_abs as the program writes them, on the simulated
// controller.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kSource = TOUCHCAL_SOURCE_DIR;
const std::string kDemoCell = kSource + "/config/cells/demo/cell.json";

/// An arm a tenth of a millimetre longer than the shipped one, and the library's folder as it is shipped.
class LibraryCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream shipped(kSource + "/config/arms/tx90.json");
    json arm = json::parse(shipped);
    arm.at("frames").at(4).at("r_mm") = arm.at("frames").at(4).at("r_mm").get<double>() + 0.1;
    arm["schema"] = "touchcal/arm/5";
    arm["serial"] = "SIMULATED-TX90-0001";
    std::ofstream(folder_ / "arm.json") << arm;
    std::filesystem::copy(kSource + "/cs8_protocol/val3/touchcal_abs", folder_ / "touchcal_abs");
  }
  Finished write_library(const std::vector<std::string>& more, const std::string& cell = kDemoCell) {
    std::vector<std::string> arguments{"touchcal", "compensate",     "--cell",    cell,
                                       "--arm",    file("arm.json"), "--library", library_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(arguments, folder_ / "call.err").wait();
  }
  Finished run_library() {
    return Process({"cs8sim", "--cell", kDemoCell, "--run", file("touchcal_abs")}, folder_ / "run.err")
        .wait();
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }

  Folder folder_;
  std::string library_ = file("touchcal_abs/touchcal_abs.dtx");
};

TEST_F(LibraryCommand, WritesNumbersThatCountOnTheArmOfTheCell) {
  const Finished written = write_library({"--flange-mm", "100", "--force"});
  EXPECT_EQ(written.exit_code, cell::kExitDone) << written.err;
  EXPECT_THAT(written.out, AllOf(HasSubstr("SIMULATED-TX90-0001"), HasSubstr("INSTALL.md, section 14")));
  const Finished ran = run_library();
  EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("touchcal_abs: as warm as at the calibration: ready"),
                             HasSubstr("no end set")));
}

TEST_F(LibraryCommand, WithAFlangeThatIsNotThereCountsNowhere) {
  ASSERT_EQ(write_library({"--flange-mm", "99.9", "--force"}).exit_code, cell::kExitDone);
  EXPECT_THAT(run_library().out, HasSubstr("this controller has another arm than the nominal one"));
}

TEST_F(LibraryCommand, NeverOverwritesUnasked) {
  const Finished refused = write_library({"--flange-mm", "100"});
  EXPECT_EQ(refused.exit_code, cell::kExitUsage) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("--force"));
}

TEST_F(LibraryCommand, WantsTheFlangeAndNothingElseToCorrect) {
  EXPECT_THAT(write_library({"--force"}).err, HasSubstr("--flange-mm"));
  EXPECT_THAT(write_library({"--flange-mm", "100", "--targets", "x.csv"}).err, HasSubstr("--targets"));
  EXPECT_EQ(write_library({"--flange-mm", "nan", "--force"}).exit_code, cell::kExitUsage);
}

TEST_F(LibraryCommand, OfAnArmWithoutASerialNumberOrWithoutACalibrationIsRefused) {
  std::ifstream exported(file("arm.json"));
  json arm = json::parse(exported);
  arm.erase("serial");
  std::ofstream(folder_ / "arm.json") << arm;
  const Finished nobodys = write_library({"--flange-mm", "100", "--force"});
  EXPECT_EQ(nobodys.exit_code, cell::kExitUsage) << nobodys.err;
  EXPECT_THAT(nobodys.err, HasSubstr("arm_serial"));
  std::filesystem::copy_file(kSource + "/config/arms/tx90.json", file("arm.json"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(write_library({"--flange-mm", "100", "--force"}).exit_code, cell::kExitUsage);
}

}  // namespace
}  // namespace touchcal::testing
