#include "service/setup/partial_answers.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/strict_json.hpp"
#include "service/setup/internal/answer_json.hpp"
#include "service/setup/questions.hpp"

namespace cell {
namespace {

using AnswerPointer = Json::json_pointer;

constexpr std::string_view kLists[] = {"/keep_out_boxes", "/tools", "/block/places"};

/// What stands at a place as long as nobody has answered; nothing where that is not said.
std::optional<Json> default_at(const Json& defaults, const std::string& pointer) {
  for (const std::string_view list : kLists) {
    if (!pointer.starts_with(list) || pointer.size() <= list.size() + 1) continue;
    const std::size_t begin = list.size() + 1, end = std::min(pointer.find('/', begin), pointer.size());
    std::size_t index = 0;
    std::from_chars(pointer.data() + begin, pointer.data() + end, index);
    const Json entry = new_list_entry(std::string(list), index);
    const AnswerPointer rest(pointer.substr(end));
    return entry.contains(rest) ? std::optional(entry.at(rest)) : std::nullopt;
  }
  const AnswerPointer at(pointer);
  return defaults.contains(at) ? std::optional(defaults.at(at)) : std::nullopt;
}

/// An answer that may be left out: what is not said follows the others.
bool may_be_left_out(const AnswerPointer& at) {
  const AnswerPointer part = at.parent_pointer();
  return part.empty() || part == AnswerPointer("/block") || part == AnswerPointer("/probe") ||
         part == AnswerPointer("/limits");
}

/// Puts the default in place of what is refused, of the next larger part where that has none. What belongs to
/// no answer goes. Each call leaves less of the document that is not a default.
void mend(Json& document, const Json& defaults, std::string pointer) {
  for (; !pointer.empty(); pointer.resize(pointer.rfind('/'))) {
    const AnswerPointer at(pointer);
    const bool is_there = document.contains(at);
    if (is_there && may_be_left_out(at)) {
      document.at(at.parent_pointer()).erase(at.back());
      return;
    }
    if (const auto usual = default_at(defaults, pointer)) {
      if (is_there && document.at(at) == *usual) continue;
      document[at] = *usual;
      return;
    }
    if (is_there && document.at(at.parent_pointer()).is_object()) {
      document.at(at.parent_pointer()).erase(at.back());
      return;
    }
  }
  document = {{"schema", kSetupSchema}};
}

/// The answer or a part of it was refused before: what is said now is for what was put in its place.
bool is_told(const std::vector<RefusedAnswer>& refused, const std::string& pointer) {
  return std::ranges::any_of(refused, [&](const RefusedAnswer& told) {
    return told.pointer == pointer || told.pointer.starts_with(pointer + "/");
  });
}

/// Of what is null, these are found or taken from elsewhere; the others are just not known.
bool is_found_where_null(const std::string& pointer) {
  return pointer.starts_with("/base/") || pointer == "/park_joints_deg" || pointer == "/probe/length_mm" ||
         pointer == "/arm/body_radii_mm";
}

std::vector<std::string> guessed_of(const Json& given, const SetupAnswers& answers) {
  const Json whole = Json::parse(setup_document(answers));
  const auto value_at = [](const Json& document, const AnswerPointer& at) {
    return document.contains(at) ? document.at(at) : Json();
  };
  std::vector<std::string> guessed;
  for (const Question& question : setup_questions(answers)) {
    const AnswerPointer at(question.pointer);
    const bool is_null = value_at(whole, at).is_null();
    if (is_null ? is_found_where_null(question.pointer) : value_at(given, at).is_null())
      guessed.push_back(question.pointer);
  }
  return guessed;
}

}  // namespace

RefusedAnswer refused_answer(std::string pointer, const std::string& message) {
  bool is_quoted = false;
  for (std::size_t i = 0; i + 1 < message.size(); ++i) {
    if (message[i] == '"') is_quoted = !is_quoted;
    if (!is_quoted && message[i] == ';' && message[i + 1] == ' ')
      return {std::move(pointer), message.substr(0, i), message.substr(i + 2)};
  }
  return {std::move(pointer), message, ""};
}

PartialAnswers read_partial_answers(const std::string& source, std::string_view text) {
  const Json given(parse_strict_json(source, text, kConfigFileSizeMax));
  const Json defaults = Json::parse(setup_document({}));
  PartialAnswers partial;
  Json document = given;
  for (std::size_t tries = 0; tries < 2 * kRefusedAnswersMax; ++tries) {
    try {
      partial.answers = read_setup_answers(source, document.dump());
      partial.guessed = guessed_of(given, partial.answers);
      return partial;
    } catch (const ConfigError& error) {
      if (error.pointer().empty() || error.pointer() == "/schema") throw;
      if (!is_told(partial.refused, error.pointer())) {
        if (partial.refused.size() == kRefusedAnswersMax) break;
        partial.refused.push_back(refused_answer(error.pointer(), error.message()));
      }
      mend(document, defaults, error.pointer());
    }
  }
  partial.guessed = guessed_of(given, partial.answers);  // none of them can be taken as they are
  return partial;
}

}  // namespace cell
