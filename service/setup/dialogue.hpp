#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/config_error.hpp"
#include "service/setup/answers.hpp"
#include "service/setup/questions.hpp"

namespace cell {

/// The questions one by one, as a step from line to line: a terminal only carries the lines. Words in place
/// of an answer: an empty line keeps the present one, `back` goes to the question before, `?` explains,
/// `done` keeps all that are left. No line ends the dialogue but the last answer.
class SetupDialogue {
 public:
  /// Looks at answers before they are taken; returns what is doubtful of them, and throws ConfigError where
  /// they make no cell.
  using Check = std::function<std::vector<std::string>(const SetupAnswers&)>;

  SetupDialogue(SetupAnswers answers, Check check);

  [[nodiscard]] bool is_over() const;
  /// What stands before the cursor: which question of how many, the question, its unit, the present answer.
  [[nodiscard]] std::string prompt() const;
  /// Takes a line without its end; returns what is to be printed, nothing or whole lines.
  std::string give(const std::string& line);
  /// All answers together make no cell: goes back to the question that the error is about. Returns what is
  /// to be printed.
  std::string refuse(const ConfigError& error);
  [[nodiscard]] const SetupAnswers& answers() const { return answers_; }

 private:
  std::string take(const std::string& typed);
  std::string keep_the_rest();

  SetupAnswers answers_;
  Check check_;
  std::vector<Question> questions_;
  std::size_t at_ = 0;
  std::vector<std::string> told_;  // remarks that were printed already
};

}  // namespace cell
