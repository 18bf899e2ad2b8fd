#include "service/setup/answers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/config_error.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

SetupAnswers read(const std::string& more) {
  return read_setup_answers("answers", R"({"schema":"touchcal/setup/1")" + more + "}");
}

std::string refusal(const std::string& more) {
  try {
    read(more);
  } catch (const ConfigError& error) {
    return error.pointer() + ": " + error.message();
  }
  return "taken";
}

TEST(SetupAnswers, HaveTheShippedDemosDefaults) {
  const SetupAnswers answers = read("");
  EXPECT_EQ(answers.arm.file, "tx90");
  EXPECT_EQ(answers.block.sides.size(), 4U);
  EXPECT_TRUE(answers.block.ground_plate);
  EXPECT_EQ(answers.nominal_miss_mm, 12.0);
  EXPECT_FALSE(answers.base) << "as the arm's file has it";
}

TEST(SetupAnswers, AreWrittenAsTheyAreRead) {
  const SetupAnswers answers = read(
      R"(,"name":"press 3","arm":{"urdf":"ur.urdf","base_link":"base_link","tip_link":"tool0"},"arm_serial":"A-1",)"
      R"("base":{"position_mm":[-500,0,20],"rotation_deg":[90,0,5]},"park_joints_deg":[0,1,2,3,4,5],)"
      R"("block":{"temperature_c":null,"certificate":{"number":"7"},"sides":[{"side":"-y"},{"side":"+x","name":"far"},)"
      R"({"side":"-z","name":"door"}]},"keep_out_boxes":[],"tools":[{"name":"grip","position_mm":[0,0,200]}],)"
      R"("limits":{"tip_box_max_by_recipe_mm":{"quick":0.3}},"probe":{"length_mm":200},"controller":{"host":"cs8","port":11001})");
  const std::string written = setup_document(answers);
  EXPECT_EQ(setup_document(read_setup_answers("again", written)), written);
  const json document = json::parse(written);
  EXPECT_EQ(document["arm"]["tip_link"], "tool0");
  EXPECT_TRUE(document["block"]["temperature_c"].is_null());
  EXPECT_EQ(document["block"]["sides"][0]["side"], "-z") << "planes are numbered in this order";
  EXPECT_EQ(document["block"]["sides"][1]["name"], "-y") << "a side without a name is called as it is";
  EXPECT_FALSE(document["limits"]["from_plans"]);
}

TEST(SetupAnswers, ThatAreNoneAreRefusedWithPlaceAndRemedy) {
  EXPECT_THAT(refusal(R"(,"nominal_miss_mm":-1)"), HasSubstr("/nominal_miss_mm: "));
  EXPECT_THAT(refusal(R"(,"colour":"red")"), HasSubstr("colour"));
  EXPECT_THAT(refusal(R"(,"arm":{"file":"tx90","dh":"x.csv"})"), HasSubstr("give one of"));
  EXPECT_THAT(refusal(R"(,"arm":{"urdf":"x.urdf"})"), HasSubstr("base_link"));
  EXPECT_THAT(refusal(R"(,"arm":{"dh":"x.csv","dh_convention":"khalil"})"), HasSubstr("/arm/dh_convention"));
  EXPECT_THAT(refusal(R"(,"block":{"size_mm":[150,150]})"), HasSubstr("/block/size_mm"));
  EXPECT_THAT(refusal(R"(,"block":{"sides":[{"side":"y"}]})"),
              AllOf(HasSubstr("/block/sides/0/side"), HasSubstr("the top")));
  EXPECT_THAT(refusal(R"(,"block":{"sides":[{"side":"-x"},{"side":"-x"}]})"), HasSubstr("twice"));
  EXPECT_THAT(refusal(R"(,"block":{"sides":[{"side":"-x"},{"side":"+x"},{"side":"-y"}]})"),
              HasSubstr("three directions"));
  EXPECT_THAT(
      refusal(R"(,"block":{"ground_plate":false,"sides":[{"side":"-x"},{"side":"-z"},{"side":"-y"}]})"),
      HasSubstr("four faces"));
  EXPECT_THAT(refusal(R"(,"block":{"plate_mm":[200,20,400]})"), HasSubstr("no room"));
  EXPECT_THAT(refusal(R"(,"probe":{"stem_radius_mm":3})"), HasSubstr("touch first"));
  EXPECT_THAT(refusal(R"(,"probe":{"stem_length_mm":3})"), HasSubstr("stem_length_mm"));
  EXPECT_THAT(refusal(R"(,"workspace_box":{"name":"w","min_mm":[0,0,0],"max_mm":[1,0,1]})"),
              HasSubstr("/workspace_box/max_mm"));
  EXPECT_THAT(refusal(R"(,"tools":[{"name":"stylus","position_mm":[0,0,1]}])"), HasSubstr("/tools/0/name"));
  EXPECT_THAT(refusal(R"(,"default_recipe":"slow")"), HasSubstr("quick or best"));
  EXPECT_THAT(refusal(R"(,"limits":{"tip_box_max_by_recipe_mm":{"slow":1}})"),
              HasSubstr("by_recipe_mm/slow"));
  EXPECT_THAT(refusal(R"(,"controller":{"host":"cs8","port":0})"), HasSubstr("/controller/port"));
}

TEST(SetupAnswers, LetWhatNobodySaidFollowWhatWasSaid) {
  const auto read = [](const std::string& members) {
    return read_setup_answers("answers", R"({"schema":"touchcal/setup/1")" + members + "}");
  };
  const SetupAnswers large = read(R"(,"block":{"size_mm":[350,100,150]})");
  EXPECT_EQ(large.block.plate_mm, Eigen::Vector3d(600.0, 20.0, 400.0));
  EXPECT_EQ(read_setup_answers("again", setup_document(large)).block.plate_mm, large.block.plate_mm);
  const SetupAnswers small = read(R"(,"probe":{"ball_radius_mm":1})");
  EXPECT_DOUBLE_EQ(small.probe.stem_radius_mm, 0.6);
  const SetupAnswers big = read(R"(,"probe":{"ball_radius_mm":25})");
  EXPECT_DOUBLE_EQ(big.probe.stem_length_mm, 52.0);
  EXPECT_THAT(refusal(R"(,"block":{"size_mm":[350,100,150],"plate_mm":[400,20,400]})"),
              HasSubstr("/block/plate_mm: the ground plate has no room"));
  EXPECT_THAT(refusal(R"(,"probe":{"ball_radius_mm":1,"stem_radius_mm":1.5})"),
              HasSubstr("/probe/stem_radius_mm: the stem is as thick"));
  EXPECT_THAT(refusal(R"(,"probe":{"ball_radius_mm":0.1})"), HasSubstr("as thick")) << "no stem is thinner";
}

}  // namespace
}  // namespace cell
