#include "service/setup/partial_answers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/config_error.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

PartialAnswers partial_of(const std::string& members) {
  return read_partial_answers("body", R"({"schema":"touchcal/setup/1")" + members + "}");
}

std::vector<std::string> refused_pointers(const PartialAnswers& partial) {
  std::vector<std::string> pointers;
  for (const RefusedAnswer& refused : partial.refused) {
    EXPECT_NE(refused.sentence, "") << refused.pointer;
    pointers.push_back(refused.pointer);
  }
  return pointers;
}

TEST(PartialAnswers, TakeWhatCanBeTakenAndNameEachOfTheOthersOnce) {
  const PartialAnswers partial = partial_of(
      R"(,"name":7,"nominal_miss_mm":500,"block":{"size_mm":[150,"x",100],"std_mm":0.004,"extra":1},
      "keep_out_boxes":[{"name":"table","min_mm":[0,0,0],"max_mm":[1,1,1]},{"name":"b","min_mm":[5,0,0],"max_mm":[1,1,1]}],
      "tools":[{"name":"gripper","position_mm":[0,0,100],"tip":{"radius_mm":-1}}])");
  EXPECT_THAT(refused_pointers(partial),
              ::testing::UnorderedElementsAre("/name", "/nominal_miss_mm", "/block/size_mm/1", "/block/extra",
                                              "/keep_out_boxes/1/max_mm", "/tools/0/tip/radius_mm"));
  EXPECT_EQ(partial.answers.block.std_mm, 0.004);
  EXPECT_EQ(partial.answers.block.size_mm, Eigen::Vector3d(150.0, 150.0, 100.0))
      << "the default in its place";
  ASSERT_EQ(partial.answers.keep_out_boxes.size(), 2U);
  EXPECT_EQ(partial.answers.keep_out_boxes[1].name, "b");
  EXPECT_EQ(partial.answers.tools.at(0).name, "gripper");
}

TEST(PartialAnswers, KeepTheOthersOfAPartWhoseAnswersDoNotAgree) {
  const PartialAnswers partial = partial_of(R"(,"block":{"size_mm":[350,100,150],"plate_mm":[400,20,400]})");
  EXPECT_THAT(refused_pointers(partial), ElementsAre("/block/plate_mm"));
  EXPECT_EQ(partial.answers.block.size_mm.x(), 350.0);
  EXPECT_EQ(partial.answers.block.plate_mm.x(), 600.0) << "as if nobody had said it";
}

TEST(PartialAnswers, TellWhatIsWrongAndWhatToDoApart) {
  const PartialAnswers partial = partial_of(R"(,"nominal_miss_mm":500)");
  EXPECT_EQ(partial.refused.at(0).sentence, "is 500");
  EXPECT_EQ(partial.refused.at(0).remedy, "give 0.1 to 100");
  const RefusedAnswer quoted = refused_answer("/a", R"(is "x; y"; give z)");
  EXPECT_EQ(quoted.sentence, R"(is "x; y")");
  EXPECT_EQ(quoted.remedy, "give z");
  EXPECT_EQ(refused_answer("/a", "is wrong").remedy, "");
}

TEST(PartialAnswers, OfAllThatIsWrongTheyEndWithTheDefaults) {
  // Each value in turn is of each wrong kind.
  const json whole = json::parse(setup_document({}));
  for (const auto& [key, unused] : whole.items()) {
    if (key == "schema") continue;
    for (const char* wrong : {"null", "true", "-1e5", "\"\"", "[]", "{}", "[[[]]]", "{\"a/b~\":{}}"}) {
      json document = whole;
      document[key] = json::parse(wrong);
      const PartialAnswers partial = read_partial_answers("body", document.dump());
      for (const std::string& pointer : refused_pointers(partial))
        EXPECT_THAT(pointer, ::testing::StartsWith("/" + key)) << wrong;
    }
  }
  std::string boxes;
  for (int i = 0; i < 50; ++i) boxes += std::string(i ? "," : "") + R"({"name":1,"min_mm":2,"max_mm":3})";
  EXPECT_EQ(partial_of(",\"keep_out_boxes\":[" + boxes + "]").refused.size(), kRefusedAnswersMax);
}

TEST(PartialAnswers, NameWhatNobodyHasAnswered) {
  const std::vector<std::string> guessed = partial_of(R"(,"name":"press","probe":{"ball_radius_mm":2},
      "park_joints_deg":null,"block":{"serial":null})")
                                               .guessed;
  EXPECT_THAT(guessed, Contains("/park_joints_deg")) << "it is searched";
  EXPECT_THAT(guessed, Contains("/base/position_mm")) << "as the arm's file has it";
  EXPECT_THAT(guessed, Contains("/probe/pretravel_mm"));
  EXPECT_THAT(guessed, Contains("/keep_out_boxes/0/min_mm"));
  for (const char* known : {"/name", "/probe/ball_radius_mm", "/block/serial", "/arm_serial"})
    EXPECT_THAT(guessed, Not(Contains(known))) << known;
  SetupAnswers answers;
  answers.base = BasePlace{};
  answers.park_joints_deg = {0, 0, 60, 0, 90, 0};
  answers.probe.length_mm = 219.0;
  EXPECT_THAT(read_partial_answers("body", setup_document(answers)).guessed, IsEmpty());
}

TEST(PartialAnswers, AreRefusedAsAWholeOnlyWhereTheyAreNoAnswersAtAll) {
  for (const char* none : {"", "[]", "7", "{", "{}", R"({"schema":"touchcal/cell/3"})", R"({"schema":7})",
                           R"({"schema":"touchcal/setup/1","name":NaN})",
                           R"({"schema":"touchcal/setup/1","name":"a","name":"b"})",
                           R"({"schema":"touchcal/setup/1","nominal_miss_mm":1e999})"}) {
    EXPECT_THROW(read_partial_answers("body", none), ConfigError) << none;
  }
}

}  // namespace
}  // namespace cell
