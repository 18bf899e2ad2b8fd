#include "service/setup/setup_language.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace cell {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The number of the entry as people count; the block's first place is none of the list.
std::string entry_number(const std::string& pointer) {
  const auto first = std::ranges::find_if(pointer, is_digit);
  if (first == pointer.end()) return {};
  std::size_t index = 0;
  std::from_chars(&*first, pointer.data() + pointer.size(), index);
  return std::to_string(index + (pointer.starts_with("/block/places/") ? 2 : 1));
}

}  // namespace

const SetupLanguage& setup_english() {
  static const SetupLanguage kEnglish{.tag = "en", .questions = {}, .scene_titles = kSceneTitles};
  return kEnglish;
}

const SetupLanguage* setup_language(std::string_view tag) {
  static const SetupLanguage kFrench{.tag = "fr",
                                     .questions = kQuestionsFr,
                                     .scene_titles = {"vue selon z", "vue de dessus", "vue selon x"}};
  static const SetupLanguage kGerman{.tag = "de",
                                     .questions = kQuestionsDe,
                                     .scene_titles = {"Blick längs z", "Blick von oben", "Blick längs x"}};
  for (const SetupLanguage* language : {&setup_english(), &kFrench, &kGerman})
    if (language->tag == tag) return language;
  return nullptr;
}

std::string question_pattern(std::string_view pointer) {
  std::string pattern;
  for (std::size_t begin = 0; begin < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', begin + 1), pointer.size());
    const std::string_view step = pointer.substr(begin, end - begin);
    const bool is_entry = step.size() > 1 && std::ranges::all_of(step.substr(1), is_digit);
    pattern += is_entry ? "/#" : step;
    begin = end;
  }
  return pattern;
}

const QuestionWords* question_words(const Question& question, const SetupLanguage& language) {
  const auto found =
      std::ranges::find(language.questions, question_pattern(question.pointer), &QuestionWords::pattern);
  return found == language.questions.end() ? nullptr : &*found;
}

Question in_language(Question question, const SetupLanguage& language) {
  const QuestionWords* words = question_words(question, language);
  if (words == nullptr) return question;
  question.prompt = words->prompt;
  question.explanation = words->explanation;
  if (const std::size_t number = question.prompt.find("{}"); number != std::string::npos)
    question.prompt.replace(number, 2, entry_number(question.pointer));
  return question;
}

}  // namespace cell
