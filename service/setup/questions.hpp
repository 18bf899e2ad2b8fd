#pragma once

#include <string>
#include <vector>

#include "service/setup/answers.hpp"

namespace cell {

/// What one answer is.
enum class AnswerKind {
  kText,
  kNumber,
  kNumbers,       // as many as there are now, by spaces or commas
  kMaybeText,     // - for none
  kMaybeNumber,   // - for unknown
  kMaybeNumbers,  // - for: as the arm's file has it, or searched
  kYesNo,
  kCount,  // of a list
  kSides,  // "-x near, -y top, ..."
  kArm     // a name, a path, "urdf FILE BASE TIP" or "dh FILE [standard|modified]"
};

struct Question {
  std::string pointer;  // of the answer in the document of schema touchcal/setup/1
  AnswerKind kind = AnswerKind::kText;
  std::string prompt;
  std::string unit;          // empty for none
  std::string explanation;   // what `?` says
  std::string section = {};  // what it is about: arm, block, probe, space, limits or tools
};

/// The questions in the order in which they are asked; how many there are of boxes and tools is in the
/// answers.
std::vector<Question> setup_questions(const SetupAnswers& answers);

/// The present answer as it would be typed.
std::string present_answer(const SetupAnswers& answers, const Question& question);

/// The answers with this one in them. ConfigError with the reason and the remedy where it is none.
SetupAnswers with_answer(const SetupAnswers& answers, const Question& question, const std::string& typed);

}  // namespace cell
