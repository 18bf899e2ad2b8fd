#include "service/setup/check_document.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "service/setup/arm_source.hpp"
#include "service/setup/internal/answer_json.hpp"

namespace cell {
namespace {

struct KindOfAnswer {
  const char* name;
  bool is_optional;
};

KindOfAnswer kind_of_answer(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::kText:
      return {"text", false};
    case AnswerKind::kMaybeText:
      return {"text", true};
    case AnswerKind::kNumber:
      return {"number", false};
    case AnswerKind::kMaybeNumber:
      return {"number", true};
    case AnswerKind::kNumbers:
      return {"numbers", false};
    case AnswerKind::kMaybeNumbers:
      return {"numbers", true};
    case AnswerKind::kYesNo:
      return {"yes_no", false};
    case AnswerKind::kCount:
      return {"count", false};
    case AnswerKind::kSides:
      return {"sides", false};
    case AnswerKind::kArm:
      return {"arm", false};
  }
  return {"text", true};
}

/// How many numbers an answer has.
int number_count(const Question& question) {
  const bool is_of_joints =
      question.kind == AnswerKind::kMaybeNumbers && !question.pointer.starts_with("/base/");
  return is_of_joints ? 6 : 3;
}

/// What can be chosen, where that is a list.
Json choices_of(const Question& question, const std::filesystem::path& shipped_config) {
  Json choices = Json::array();
  if (question.kind == AnswerKind::kArm) {
    for (const std::string& name : shipped_arms(shipped_config)) choices.push_back(name);
  } else if (question.kind == AnswerKind::kSides) {
    for (const std::string_view side : kSideNames) choices.push_back(side);
  } else if (question.pointer == "/default_recipe") {
    for (const std::string_view recipe : kSetupRecipes) choices.push_back(recipe);
  }
  return choices;
}

Json questions_json(const PartialAnswers& partial, const std::filesystem::path& shipped_config,
                    const SetupLanguage& language) {
  const Json answers = Json::parse(setup_document(partial.answers));
  Json list = Json::array();
  for (const Question& english : setup_questions(partial.answers)) {
    const Question question = in_language(english, language);
    const auto [kind, is_optional] = kind_of_answer(question.kind);
    const bool is_list = question.kind == AnswerKind::kCount;
    const bool is_numbers =
        question.kind == AnswerKind::kNumbers || question.kind == AnswerKind::kMaybeNumbers;
    const bool is_guessed = std::ranges::find(partial.guessed, question.pointer) != partial.guessed.end();
    list.push_back(
        {{"pointer", question.pointer},
         {"section", question.section},
         {"kind", kind},
         {"optional", is_optional},
         {"count", is_numbers ? Json(number_count(question)) : Json()},
         {"prompt", question.prompt},
         {"unit", question.unit},
         {"explanation", question.explanation},
         {"choices", choices_of(question, shipped_config)},
         {"guessed", is_guessed},
         {"new_entry",
          is_list ? new_list_entry(question.pointer, answers.at(Json::json_pointer(question.pointer)).size())
                  : Json()}});
  }
  return list;
}

Json refused_json(const std::vector<RefusedAnswer>& refused) {
  Json list = Json::array();
  for (const RefusedAnswer& answer : refused)
    list.push_back({{"pointer", answer.pointer},
                    {"sentence", answer.sentence},
                    {"remedy", answer.remedy},
                    {"file", answer.file.empty() ? Json() : Json(answer.file)}});
  return list;
}

Json files_json(const CellFiles& files) {
  Json list = Json::array();
  for (const auto& [name, text] : files) list.push_back({{"name", name}, {"text", text}});
  return list;
}

}  // namespace

std::string setup_questions_document(const std::filesystem::path& shipped_config,
                                     const SetupLanguage& language) {
  const PartialAnswers nothing = read_partial_answers("", R"({"schema":"touchcal/setup/1"})");
  return text_of({{"schema", "touchcal/setup-questions/1"},
                  {"language", language.tag},
                  {"answers", Json::parse(setup_document(nothing.answers))},
                  {"questions", questions_json(nothing, shipped_config, language)}});
}

std::string setup_check_document(const SetupCheck& check, const std::filesystem::path& shipped_config,
                                 const SetupLanguage& language) {
  return text_of({{"schema", "touchcal/setup-check/1"},
                  {"passes", value_or_null(check.passes)},
                  {"refused", refused_json(check.refused)},
                  {"remarks", check.remarks},
                  {"files", files_json(check.files)},
                  {"scene_svg", check.scene_svg.empty() ? Json() : Json(check.scene_svg)},
                  {"answers", Json::parse(setup_document(check.partial.answers))},
                  {"questions", questions_json(check.partial, shipped_config, language)}});
}

}  // namespace cell
