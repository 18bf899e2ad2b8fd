#include "service/setup/dialogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> nothing_doubtful(const SetupAnswers&) { return {}; }

TEST(SetupDialogue, KeepsAllDefaultsByEmptyLines) {
  SetupDialogue dialogue({}, nothing_doubtful);
  while (!dialogue.is_over()) EXPECT_EQ(dialogue.give(""), "");
  EXPECT_EQ(setup_document(dialogue.answers()), setup_document({}));
}

TEST(SetupDialogue, ShowsQuestionUnitAndPresentAnswer) {
  SetupDialogue dialogue({}, nothing_doubtful);
  while (dialogue.prompt().find("Pre-travel") == std::string::npos) dialogue.give("");
  EXPECT_THAT(dialogue.prompt(), HasSubstr("Pre-travel, mm [0.01]: "));
}

TEST(SetupDialogue, AsksAgainWithTheReasonAndExplains) {
  SetupDialogue dialogue({}, nothing_doubtful);
  dialogue.give("cell 7");
  dialogue.give("tx60\r");
  dialogue.give("");
  dialogue.give("");
  const std::string prompt = dialogue.prompt();
  EXPECT_THAT(dialogue.give("here"), HasSubstr("Not taken: is \"here\"; give a number in mm"));
  EXPECT_EQ(dialogue.prompt(), prompt);
  EXPECT_THAT(dialogue.give("?"), HasSubstr("touchcal locate finds it"));
  EXPECT_EQ(dialogue.prompt(), prompt);
  EXPECT_EQ(dialogue.answers().name, "cell 7");
  EXPECT_EQ(dialogue.answers().arm.file, "tx60");
}

TEST(SetupDialogue, GoesBackQuestionByQuestion) {
  SetupDialogue dialogue({}, nothing_doubtful);
  const std::string first = dialogue.prompt();
  EXPECT_THAT(dialogue.give("back"), HasSubstr("first question"));
  dialogue.give("one");
  dialogue.give("back");
  EXPECT_THAT(dialogue.prompt(), HasSubstr("[one]"));
  dialogue.give("two");
  EXPECT_EQ(dialogue.answers().name, "two");
}

TEST(SetupDialogue, KeepsAllThatAreLeftByOneWordUpToOneThatIsNotTaken) {
  SetupDialogue dialogue({}, nothing_doubtful);
  dialogue.give("one");
  EXPECT_EQ(dialogue.give("done"), "");
  EXPECT_TRUE(dialogue.is_over());
  SetupDialogue stuck({}, [](const SetupAnswers&) -> std::vector<std::string> {
    throw ConfigError("cell.json", "/speeds", "is too fast; go slower");
  });
  EXPECT_THAT(stuck.give("done"), HasSubstr("too fast"));
  EXPECT_FALSE(stuck.is_over());
}

TEST(SetupDialogue, GoesBackToTheQuestionThatAllAnswersTogetherAreRefusedFor) {
  SetupDialogue dialogue({}, nothing_doubtful);
  dialogue.give("done");
  EXPECT_THAT(
      dialogue.refuse(ConfigError("answers", "/park_joints_deg", "the elbow is in the table; raise it")),
      HasSubstr("Not written: answers: the elbow is in the table"));
  EXPECT_THAT(dialogue.prompt(), HasSubstr("Park posture"));
  dialogue.give("0 0 60 0 90 0");
  dialogue.give("done");
  EXPECT_TRUE(dialogue.is_over());
  dialogue.refuse(ConfigError("answers", "/base", "is in the wall; move it"));
  EXPECT_THAT(dialogue.prompt(), HasSubstr("Where the arm's base is"));
}

TEST(SetupDialogue, TakesNothingThatMakesNoCellAndTellsWhatIsDoubtfulOnce) {
  SetupDialogue dialogue({}, [](const SetupAnswers& answers) -> std::vector<std::string> {
    if (answers.name == "bad") throw ConfigError("cell.json", "/speeds", "is too fast; go slower");
    return {"the park posture is in the way"};
  });
  EXPECT_EQ(dialogue.give("bad"), "Not taken: cell.json: /speeds: is too fast; go slower\n");
  EXPECT_EQ(dialogue.answers().name, "cell");
  EXPECT_EQ(dialogue.give("good"), "Note: the park posture is in the way\n");
  EXPECT_THAT(dialogue.give(""), IsEmpty());
}

}  // namespace
}  // namespace cell
