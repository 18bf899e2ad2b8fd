#include "service/setup/questions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "config/config_error.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

Question question_of(const SetupAnswers& answers, const std::string& pointer) {
  const auto all = setup_questions(answers);
  return *std::ranges::find(all, pointer, &Question::pointer);
}

SetupAnswers typed(const SetupAnswers& answers, const std::string& pointer, const std::string& text) {
  return with_answer(answers, question_of(answers, pointer), text);
}

std::string refused(const std::string& pointer, const std::string& text) {
  try {
    typed({}, pointer, text);
  } catch (const ConfigError& error) {
    return error.message();
  }
  return "taken";
}

TEST(SetupQuestions, TakeTheirPresentAnswerBack) {
  SetupAnswers answers;
  answers.tools = {{"gripper", {0.0, 0.0, 250.0}, {0.0, 0.0, 30.0}, ToolTipAnswers{.radius_mm = 4.0}}};
  answers.block.places = {{.name = "stand", .position_mm = {-300.0, -300.0, 200.0}}};
  answers.base = BasePlace{{-625.5, -120.0, 0.0}, {90.0, 0.0, 0.0}};
  std::set<std::string> pointers;
  for (const Question& question : setup_questions(answers)) {
    EXPECT_TRUE(pointers.insert(question.pointer).second) << question.pointer;
    const std::string present = present_answer(answers, question);
    EXPECT_EQ(setup_document(with_answer(answers, question, present)), setup_document(answers))
        << question.pointer;
  }
  EXPECT_GT(pointers.size(), 50U);
}

TEST(SetupQuestions, TakeNumbersUnitsAndNames) {
  EXPECT_EQ(typed({}, "/block/size_mm", "200, 100 120").block.size_mm, Eigen::Vector3d(200.0, 100.0, 120.0));
  EXPECT_EQ(typed({}, "/block/ground_plate", "no").block.ground_plate, false);
  EXPECT_EQ(typed({}, "/block/sides", "+x far side, -y top, -z right").block.sides.back().name, "far side");
  EXPECT_EQ(typed({}, "/arm", "urdf my.urdf base_link tool0").arm.tip_link, "tool0");
  EXPECT_EQ(typed({}, "/arm", "dh my.csv standard").arm.dh_convention, "standard");
  EXPECT_EQ(typed({}, "/base/position_mm", "-600 0 0").base->rotation_deg, Eigen::Vector3d(90.0, 0.0, 0.0));
  EXPECT_EQ(typed({}, "/block/certificate/number", "K 1").block.certificate.at("number"), "K 1");
  EXPECT_EQ(typed({}, "/park_joints_deg", "0 1 2 3 4 5").park_joints_deg->size(), 6U);
  EXPECT_EQ(typed({}, "/controller/port", "11001").controller.port, 11001);
}

TEST(SetupQuestions, AskForTipsOfToolsFurtherPlacesAndRadiiOfAMadeArmOnlyWhereTheyAreWanted) {
  SetupAnswers answers = typed({}, "/tools", "1");
  const std::size_t before = setup_questions(answers).size();
  answers = typed(answers, "/tools/0/tip/radius_mm", "4");
  EXPECT_EQ(answers.tools[0].tip->radius_mm, 4.0);
  EXPECT_EQ(setup_questions(answers).size(), before + 1) << "its deviation";
  EXPECT_FALSE(typed(answers, "/tools/0/tip/radius_mm", "-").tools[0].tip);
  answers = typed({}, "/block/places", "1");
  answers = typed(answers, "/block/places/0/name", "stand");
  EXPECT_EQ(answers.block.places[0].name, "stand");
  EXPECT_EQ(setup_questions(answers).size(), setup_questions({}).size() + 4);
  answers = typed({}, "/arm", "dh my.csv standard");
  EXPECT_EQ(setup_questions(answers).size(), setup_questions({}).size() + 1);
  EXPECT_EQ(typed(answers, "/arm/body_radii_mm", "80 60 60 45 40 35").arm.body_radii_mm->at(3), 45.0);
}

TEST(SetupQuestions, TakeAHyphenForWhatIsNotKnown) {
  SetupAnswers answers = typed({}, "/block/certificate/number", "K 1");
  EXPECT_TRUE(typed(answers, "/block/certificate/number", "-").block.certificate.empty());
  EXPECT_FALSE(typed({}, "/block/temperature_c", "-").block.temperature_c);
  EXPECT_NE(refused("/block/std_mm", "-"), "taken");
}

TEST(SetupQuestions, GrowAndShrinkWithTheListsTheyAskFor) {
  const SetupAnswers two = typed({}, "/keep_out_boxes", "2");
  EXPECT_EQ(two.keep_out_boxes.size(), 2U);
  EXPECT_EQ(setup_questions(two).size(), setup_questions({}).size() + 3);
  EXPECT_TRUE(typed(two, "/keep_out_boxes", "0").keep_out_boxes.empty());
}

TEST(SetupQuestions, LetWhatIsAskedLaterFollow) {
  EXPECT_EQ(typed({}, "/workspace_box/min_mm", "500 -500 0").workspace_box.max_mm.x(), 600.0);
  EXPECT_EQ(typed({}, "/block/size_mm", "500 100 120").block.plate_mm.x(), 750.0);
  EXPECT_LT(typed({}, "/probe/ball_radius_mm", "1").probe.stem_radius_mm, 1.0);
}

TEST(SetupQuestions, RefuseWhateverIsTypedByAReasonAndNothingElse) {
  SetupAnswers answers;
  answers.block.places = {{.name = "stand"}};
  answers.tools = {{"gripper", {0.0, 0.0, 250.0}, {0.0, 0.0, 30.0}}};
  const std::string odd[] = {"1e999",
                             "-1e999",
                             "1e-999",
                             "+11000",
                             "nan",
                             "inf",
                             "-inf",
                             "--1",
                             "1-",
                             "e",
                             "1e",
                             ".",
                             "99999999999999999999",
                             "0x1p3",
                             "1,",
                             ",",
                             "1 2 3 4 5 6 7",
                             "\xff",
                             "urdf a",
                             "dh",
                             "-x -x -x",
                             "{",
                             "\"",
                             "[1]",
                             "null",
                             "-0"};
  for (const Question& question : setup_questions(answers)) {
    for (const std::string& text : odd) {
      try {
        read_setup_answers("again", setup_document(with_answer(answers, question, text)));
      } catch (const ConfigError& error) {
        EXPECT_FALSE(error.message().empty()) << question.pointer << " " << text;
      } catch (const std::exception& error) {
        ADD_FAILURE() << question.pointer << " " << text << ": " << error.what();
      }
    }
  }
  EXPECT_THAT(refused("/nominal_miss_mm", "1e999"), HasSubstr("give a smaller one"));
  EXPECT_THAT(refused("/controller/port", "+11000"), HasSubstr("whole number from 1 to 65535"));
  EXPECT_THAT(refused("/controller/port", "70000"), HasSubstr("65535"));
}

TEST(SetupQuestions, RefuseWhatIsNoAnswer) {
  EXPECT_THAT(refused("/nominal_miss_mm", "12 mm"), HasSubstr("give a number in mm"));
  EXPECT_THAT(refused("/nominal_miss_mm", "0x10"), HasSubstr("give a number"));
  EXPECT_THAT(refused("/nominal_miss_mm", "1000"), HasSubstr("100"));
  EXPECT_THAT(refused("/block/size_mm", "1 2"), HasSubstr("give 3"));
  EXPECT_THAT(refused("/block/ground_plate", "perhaps"), HasSubstr("yes or no"));
  EXPECT_THAT(refused("/keep_out_boxes", "1.5"), HasSubstr("whole number"));
  EXPECT_THAT(refused("/keep_out_boxes", "1000000"), HasSubstr("whole number"));
  EXPECT_THAT(refused("/arm", "urdf my.urdf"), HasSubstr("urdf FILE BASE TIP"));
  EXPECT_THAT(refused("/block/sides", "up, -y"), HasSubstr("the top"));
  EXPECT_THAT(refused("/name", "\x01"), HasSubstr("control"));
}

}  // namespace
}  // namespace cell
