#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "service/setup/answers.hpp"

/// Answers as a form has them while somebody types: some are missing, some are none.
namespace cell {

/// Why an answer cannot be taken.
struct RefusedAnswer {
  std::string pointer;    // RFC 6901, of the answer; of a place in `file` where there is one
  std::string sentence;   // what is wrong
  std::string remedy;     // what to do; empty where the sentence says it
  std::string file = {};  // of the cell, which cannot be read; empty: the answer itself is refused
};

struct PartialAnswers {
  SetupAnswers answers;                // what was refused, or was not given, has its default
  std::vector<RefusedAnswer> refused;  // at most kRefusedAnswersMax, each answer once
  std::vector<std::string> guessed;    // pointers of questions that nobody has answered
};

inline constexpr std::size_t kRefusedAnswersMax = 50;

/// Takes of a document of schema touchcal/setup/1 what can be taken. ConfigError only where it is no JSON, no
/// object, or of another schema.
PartialAnswers read_partial_answers(const std::string& source, std::string_view text);

/// The message of a ConfigError in its two parts.
RefusedAnswer refused_answer(std::string pointer, const std::string& message);

}  // namespace cell
