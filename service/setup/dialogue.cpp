#include "service/setup/dialogue.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace cell {
namespace {

std::string without_spaces_around(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Of JSON pointers: it is that place, or a part of it.
bool is_within(const std::string& pointer, const std::string& place) {
  return pointer.starts_with(place) &&
         (pointer.size() == place.size() || place.empty() || pointer[place.size()] == '/');
}

}  // namespace

SetupDialogue::SetupDialogue(SetupAnswers answers, Check check)
    : answers_(std::move(answers)), check_(std::move(check)), questions_(setup_questions(answers_)) {}

bool SetupDialogue::is_over() const { return at_ == questions_.size(); }

std::string SetupDialogue::prompt() const {
  const Question& question = questions_.at(at_);
  const std::string unit = question.unit.empty() ? "" : ", " + question.unit;
  return fmt::format("{}/{} {}{} [{}]: ", at_ + 1, questions_.size(), question.prompt, unit,
                     present_answer(answers_, question));
}

std::string SetupDialogue::give(const std::string& line) {
  const std::string typed = without_spaces_around(line);
  const Question& question = questions_.at(at_);
  if (typed == "?") {
    const std::string words =
        question.explanation.empty() ? "Enter keeps what is in brackets." : question.explanation;
    return words + "\n";
  }
  if (typed == "back") {
    if (at_ == 0) return "This is the first question.\n";
    --at_;
    return {};
  }
  if (typed == "done") return keep_the_rest();
  return take(typed);
}

std::string SetupDialogue::keep_the_rest() {
  std::string text;
  for (std::size_t before = at_; !is_over(); before = at_) {
    text += take("");
    if (at_ == before) break;  // not taken, and the text says why
  }
  return text;
}

std::string SetupDialogue::refuse(const ConfigError& error) {
  const auto meant = std::ranges::find_if(questions_, [&](const Question& question) {
    return is_within(error.pointer(), question.pointer) || is_within(question.pointer, error.pointer());
  });
  at_ = meant == questions_.end() ? 0 : static_cast<std::size_t>(meant - questions_.begin());
  return fmt::format(
      "Not written: {}: {}\nCorrect this or an answer before it (back); done keeps the others.\n",
      error.source(), error.message());
}

std::string SetupDialogue::take(const std::string& typed) {
  const Question& question = questions_.at(at_);
  std::vector<std::string> remarks;
  SetupAnswers wanted = answers_;
  try {
    if (!typed.empty()) wanted = with_answer(answers_, question, typed);
    remarks = check_(wanted);
  } catch (const ConfigError& error) {
    // Of another answer than this one, which the new one does not agree with, the place says more.
    const bool is_of_this = error.pointer().starts_with(question.pointer);
    return fmt::format("Not taken: {}{}\n", is_of_this ? "" : error.source() + ": " + error.pointer() + ": ",
                       error.message());
  }
  answers_ = std::move(wanted);
  questions_ = setup_questions(answers_);
  ++at_;
  std::string text;
  for (const std::string& remark : remarks)
    if (std::ranges::find(told_, remark) == told_.end()) text += "Note: " + remark + "\n";
  told_ = std::move(remarks);
  return text;
}

}  // namespace cell
