#include "service/setup/setup_language.hpp"

#include <gtest/gtest.h>

#include <set>

namespace cell {
namespace {

/// Of which every question is asked.
SetupAnswers asked_for_all() {
  SetupAnswers answers;
  answers.arm = {.file = "", .dh = "my.csv"};
  answers.block.places = {{.name = "stand"}, {.name = "shelf"}};
  answers.tools = {{.name = "gripper", .tip = ToolTipAnswers{}}};
  return answers;
}

const char* const kOtherTags[] = {"fr", "de"};

TEST(SetupLanguages, HaveWordsForEveryQuestionAndNoOthers) {
  std::set<std::string> asked;
  for (const Question& question : setup_questions(asked_for_all()))
    asked.insert(question_pattern(question.pointer));
  for (const char* tag : kOtherTags) {
    const SetupLanguage& language = *setup_language(tag);
    std::set<std::string> known;
    for (const QuestionWords& words : language.questions) known.emplace(words.pattern);
    EXPECT_EQ(known, asked) << tag;
    EXPECT_EQ(known.size(), language.questions.size()) << tag << ": one is there twice";
  }
}

TEST(SetupLanguages, ExplainWhatEnglishExplainsAndLeaveNothingInIt) {
  for (const char* tag : kOtherTags) {
    for (const Question& english : setup_questions(asked_for_all())) {
      const Question other = in_language(english, *setup_language(tag));
      EXPECT_EQ(other.pointer, english.pointer);
      EXPECT_NE(other.prompt, english.prompt) << tag << " " << english.pointer;
      EXPECT_EQ(other.explanation.empty(), english.explanation.empty()) << tag << " " << english.pointer;
      EXPECT_EQ(other.prompt.find("{}"), std::string::npos) << tag << " " << english.pointer;
    }
  }
}

TEST(SetupLanguages, CountAsPeopleDo) {
  const auto prompt = [](const std::string& pointer) {
    return in_language({.pointer = pointer}, *setup_language("fr")).prompt;
  };
  EXPECT_EQ(prompt("/tools/0/name"), "Outil 1 : son nom");
  EXPECT_EQ(prompt("/keep_out_boxes/11/name"), "Volume 12 à éviter : son nom");
  EXPECT_EQ(prompt("/block/places/0/name"), "Place 2 : son nom") << "the first one is where the block is";
}

TEST(SetupLanguages, AreThree) {
  EXPECT_EQ(setup_language("en"), &setup_english());
  for (const char* other : {"", "EN", "it", "en-GB"}) EXPECT_EQ(setup_language(other), nullptr) << other;
  EXPECT_EQ(question_pattern("/block/certificate/number"), "/block/certificate/number");
}

}  // namespace
}  // namespace cell
