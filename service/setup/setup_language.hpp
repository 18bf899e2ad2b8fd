#pragma once

#include <span>
#include <string_view>

#include "service/setup/questions.hpp"
#include "service/setup/scene_drawing.hpp"

namespace cell {

/// A question in a language. `pattern`: its pointer with # in place of the number of an entry; {} in the
/// prompt is that number as people count.
struct QuestionWords {
  std::string_view pattern;
  std::string_view prompt;
  std::string_view explanation;
};

/// The language in which a page asks what touchcal setup asks in English.
struct SetupLanguage {
  std::string_view tag;                      // as HTML's lang attribute has it
  std::span<const QuestionWords> questions;  // none of English, which setup_questions() speaks
  SceneTitles scene_titles;
};

extern const std::span<const QuestionWords> kQuestionsFr, kQuestionsDe;

const SetupLanguage& setup_english();

/// Of "en", "fr" or "de"; null for another language.
const SetupLanguage* setup_language(std::string_view tag);

/// The pattern of a question's pointer: /tools/#/name.
std::string question_pattern(std::string_view pointer);

/// Null where the language has no words for it.
const QuestionWords* question_words(const Question& question, const SetupLanguage& language);

/// The question in the language; as it is where that has no words for it.
Question in_language(Question question, const SetupLanguage& language);

}  // namespace cell
