// touchcal plan: the document, the table, and what it says when there is no plan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class PlanCommand : public ::testing::Test {
 protected:
  Finished plan(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"touchcal", "plan", "--cell", cell_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(arguments, folder_ / "call.err").wait();
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  static std::string read(const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// Plans with a copy of the shipped files of which one is changed.
  void change(const std::string& name, const std::function<void(json&)>& change_it) {
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder_ / "config",
                          std::filesystem::copy_options::recursive);
    cell_ = file("config/cells/edf/cell.json");
    json document = json::parse(read(file("config/" + name)));
    change_it(document);
    std::ofstream(file("config/" + name)) << document;
  }

  static void expect_refused(const Finished& finished, int exit_code, const std::vector<std::string>& parts) {
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
    EXPECT_EQ(finished.out, "");
    const std::string first_line = finished.err.substr(0, finished.err.find('\n'));
    for (const std::string& part : parts) EXPECT_THAT(first_line, HasSubstr(part));
  }

  Folder folder_;
  std::string cell_ = cell_file("edf");
};

TEST_F(PlanCommand, PredictsTheArmWithTheStiffnessOfTheCommandLine) {
  const auto compliance_mm = [this](const char* stiffness) {
    const json document = json::parse(plan({"--recipe", kRecipe, "--json", "--stiffness", stiffness}).out);
    for (const json& source : document.at("limits").at("accuracy"))
      if (source.at("source") == "compliance") return source.at("workspace_box_rms_mm").get<double>();
    return 0.0;
  };
  EXPECT_LT(compliance_mm("on"), 0.5 * compliance_mm("off"));
  EXPECT_EQ(plan({"--stiffness", "maybe"}).exit_code, cell::kExitUsage);
}

TEST_F(PlanCommand, GivesOneDocumentAndWritesTheSameToAFile) {
  const Finished finished = plan({"--recipe", kRecipe, "--json", "--out", file("plan.json")});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  EXPECT_EQ(finished.err, "") << "no progress where nobody looks";
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("schema"), "touchcal/plan/1");
  EXPECT_EQ(document.at("touches").size(), static_cast<std::size_t>(kTouchCount));
  EXPECT_EQ(document.at("identifiable_count"), kRank);
  EXPECT_EQ(json::parse(read(file("plan.json"))), document);
  expect_refused(plan({"--recipe", kRecipe, "--json", "--out", file("plan.json")}), cell::kExitUsage,
                 {"--force"});
}

TEST_F(PlanCommand, ShowsPeopleWhatIsPredictedAndWhatLimitsIt) {
  const Finished finished = plan({"--recipe", "quick", "--fit", "32"});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  for (const char* part : {"condition number", "workspace box", "joint ranges", "standard uncertainty",
                           "what limits it", "touch_noise"})
    EXPECT_THAT(finished.out, HasSubstr(part));
}

TEST_F(PlanCommand, OptionsThatMakeNoSenseAreWrongUsage) {
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--fit", "0"},
                                             {"--fit", "3"},
                                             {"--fit", "many"},
                                             {"--criterion", "beauty"},
                                             {"--accuracy", "0"},
                                             {"--accuracy", "-0.1"},
                                             {"--accuracy", "nan"},
                                             {"--workspace-box", "0,0,0,inf,inf,inf"},
                                             {"--place-min", "0,0,0"},
                                             {"--place", "--place-max", "1,1,1"},
                                             {"--place", "--place-min", "2,1,1", "--place-max", "1,1,1"},
                                             {"--place", "--place-min", "1,1,1", "--place-max", "1,1"},
                                             {"--workspace-box", "1,2,3"},
                                             {"--workspace-box", "0,0,0,1,1,-1"},
                                             {"--out", "-"}}) {
    const Finished finished = plan(options);
    EXPECT_EQ(finished.exit_code, cell::kExitUsage) << options[0] << ' ' << options[1] << finished.err;
    EXPECT_NE(finished.err, "");
    EXPECT_EQ(finished.out, "");
  }
}

TEST_F(PlanCommand, FilesThatAreWrongAreToldAsElsewhere) {
  expect_refused(plan({"--recipe", "edf-99"}), cell::kExitBadInput, {"edf-99"});
  cell_ = file("none.json");
  expect_refused(plan(), cell::kExitBadInput, {"none.json"});
}

TEST_F(PlanCommand, ABlockOutOfReachIsRefused) {
  change("cells/edf/cell.json", [](json& cell) {
    cell["frames"] = {{{"j", 0}, {"theta_deg", 0}, {"r_mm", 3149.6}}};
    for (const char* corner : {"min_mm", "max_mm"}) {
      json& z_mm = cell["workspace_box"][corner][2];
      z_mm = z_mm.get<double>() + 3000.0;
    }
  });
  expect_refused(plan(), cell::kExitRefused, {"plane 1", "0 of", "out of reach", "--place"});
}

TEST_F(PlanCommand, AnArmThatSlidesIsRefusedByItsJoint) {
  change("arms/tx90.json", [](json& arm) {
    arm["frames"][3]["joint_type"] = "prismatic";
    arm.erase("gravity");
    arm.erase("gears");
  });
  expect_refused(plan(), cell::kExitBadInput,
                 {"/arm", "joint 3 of \"tx90\" is prismatic", "planned", "touchcal identify"});
}

TEST_F(PlanCommand, AFaceThatNoPostureReachesIsRefused) {
  change("cells/edf/cell.json", [](json& cell) {
    cell["keep_out_boxes"].push_back(
        {{"name", "fence"}, {"min_mm", {-100, -300, -100}}, {"max_mm", {-80, 20, 100}}});
  });
  expect_refused(plan(), cell::kExitRefused, {"plane 2", "0 of", "fence"});
}

TEST_F(PlanCommand, AWorkspaceBoxOutOfTheArmsRangeIsRefused) {
  expect_refused(plan({"--workspace-box", "5000,0,0,5600,500,500"}), cell::kExitRefused,
                 {"workspace box", "out of the arm's range", "mm off"});
}

TEST_F(PlanCommand, AnAccuracyThatCannotBeHadNamesTheBestAndWhatItIsMadeOf) {
  expect_refused(plan({"--recipe", "quick", "--accuracy", "0.001"}), cell::kExitRefused,
                 {"0.001 mm", "40 touches", "the best is", "touch_noise", "--fit"});
}

TEST_F(PlanCommand, AFinerAccuracyTakesMoreTouches) {
  const auto fitted = [&](const std::string& accuracy_mm) {
    const Finished finished = plan({"--recipe", "quick", "--accuracy", accuracy_mm, "--fit", "80", "--json"});
    EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
    const json touches = json::parse(finished.out).at("touches");
    return std::ranges::count_if(touches, [](const json& touch) { return touch.at("role") == "fit"; });
  };
  const auto rough = fitted("0.4"), fine = fitted("0.22");
  EXPECT_GE(rough, kRank);
  EXPECT_GT(fine, rough);
  EXPECT_LE(fine, 80);
}

TEST_F(PlanCommand, PlacesOfTheBlockAreRanked) {
  const Finished finished = plan({"--recipe", "edf-25", "--place", "--place-min", "-50,0,-50", "--place-max",
                                  "1500,0,50", "--places", "2", "--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("schema"), "touchcal/places/1");
  const json& places = document.at("places");
  ASSERT_EQ(places.size(), 3u) << "two and the present one";
  EXPECT_TRUE(places[0].at("feasible").get<bool>());
  for (const json& place : places) EXPECT_EQ(place.at("frames").size(), 2u);
}

TEST_F(PlanCommand, TouchesThatCannotShowAllParametersAreRefused) {
  expect_refused(plan({"--recipe", "quick", "--fit", "8"}), cell::kExitRefused, {"25"});
}

}  // namespace
}  // namespace touchcal::testing
