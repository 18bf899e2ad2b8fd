#include "service/setup/questions.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>

#include "config/config_error.hpp"
#include "config/decimal_text.hpp"
#include "config/json_value.hpp"
#include "service/setup/internal/answer_json.hpp"

namespace cell {
namespace {

using TypedJson = nlohmann::ordered_json;
using Pointer = TypedJson::json_pointer;

constexpr const char* kTypedSource = "answer";
constexpr int kTypedCountMax = 50;

[[noreturn]] void refuse(const Question& question, const std::string& message) {
  throw ConfigError(kTypedSource, question.pointer, message);
}

std::vector<std::string> words_of(const std::string& text, bool also_commas) {
  std::string spaced = text;
  if (also_commas) std::ranges::replace(spaced, ',', ' ');
  std::istringstream stream(spaced);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double typed_number(const Question& question, const std::string& text) {
  if (!refuse_number(text).empty())
    refuse(question, "is " + in_quotes(text) + "; give a number" +
                         (question.unit.empty() ? std::string() : " in " + question.unit) + ", with a point");
  double value = 0.0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{})
    refuse(question, "is " + in_quotes(text) + ", which is beyond all numbers; give a smaller one");
  return value;
}

TypedJson typed_port(const Question& question, const std::string& text) {
  unsigned port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc{} || rest != end)
    refuse(question, "is " + in_quotes(text) + "; give a whole number from 1 to 65535");
  return port;
}

TypedJson typed_numbers(const Question& question, const std::string& typed, std::size_t count) {
  TypedJson numbers = TypedJson::array();
  for (const std::string& word : words_of(typed, true)) numbers.push_back(typed_number(question, word));
  if (numbers.size() != count)
    refuse(question, "has " + std::to_string(numbers.size()) + " numbers; give " + std::to_string(count) +
                         ", separated by spaces");
  return numbers;
}

TypedJson typed_sides(const Question& question, const std::string& typed) {
  TypedJson sides = TypedJson::array();
  std::istringstream stream(typed);
  for (std::string entry; std::getline(stream, entry, ',');) {
    const auto words = words_of(entry, false);
    if (words.empty()) refuse(question, "has an empty entry; give sides as '-x near, -y top'");
    std::string name;
    for (std::size_t i = 1; i < words.size(); ++i) name += (i == 1 ? "" : " ") + words[i];
    sides.push_back({{"side", words[0]}, {"name", name.empty() ? words[0] : name}});
  }
  return sides;
}

TypedJson typed_arm(const Question& question, const std::string& typed) {
  const auto words = words_of(typed, false);
  TypedJson arm = TypedJson::object();
  if (words.at(0) == "urdf") {
    if (words.size() != 4) refuse(question, "a URDF needs its file and two links; give 'urdf FILE BASE TIP'");
    arm["urdf"] = words[1];
    arm["base_link"] = words[2];
    arm["tip_link"] = words[3];
  } else if (words[0] == "dh") {
    if (words.size() < 2 || words.size() > 3)
      refuse(question, "give 'dh FILE', or 'dh FILE standard' (or modified)");
    arm["dh"] = words[1];
    if (words.size() == 3) arm["dh_convention"] = words[2];
  } else {
    arm["file"] = typed;
  }
  return arm;
}

/// A list that has grown has new entries.
TypedJson resized(const Question& question, TypedJson list, const std::string& typed) {
  const std::string refused = refuse_integer(typed);
  const int count = refused.empty() && typed.size() < 6 ? std::stoi(typed) : -1;
  if (count < 0 || count > kTypedCountMax)
    refuse(question,
           "is " + in_quotes(typed) + "; give a whole number from 0 to " + std::to_string(kTypedCountMax));
  while (list.size() > static_cast<std::size_t>(count)) list.erase(list.size() - 1);
  while (list.size() < static_cast<std::size_t>(count))
    list.push_back(new_list_entry(question.pointer, list.size()));
  return list;
}

/// The one that is there, or null.
TypedJson value_at(const TypedJson& document, const std::string& pointer) {
  const Pointer at(pointer);
  return document.contains(at) ? document.at(at) : TypedJson();
}

TypedJson typed_value(const Question& question, const TypedJson& present, const std::string& typed) {
  switch (question.kind) {
    case AnswerKind::kText:
    case AnswerKind::kMaybeText:
      return typed;
    case AnswerKind::kNumber:
    case AnswerKind::kMaybeNumber:
      return question.pointer == "/controller/port" ? typed_port(question, typed)
                                                    : TypedJson(typed_number(question, typed));
    case AnswerKind::kNumbers:
      return typed_numbers(question, typed, present.size());
    case AnswerKind::kMaybeNumbers:
      return typed_numbers(question, typed, question.pointer.starts_with("/base/") ? 3 : 6);
    case AnswerKind::kYesNo:
      if (typed != "yes" && typed != "no" && typed != "y" && typed != "n") refuse(question, "give yes or no");
      return typed.front() == 'y';
    case AnswerKind::kCount:
      return resized(question, present, typed);
    case AnswerKind::kSides:
      return typed_sides(question, typed);
    case AnswerKind::kArm:
      return typed_arm(question, typed);
  }
  return {};
}

bool may_be_none(const Question& question) {
  return question.kind == AnswerKind::kMaybeText || question.kind == AnswerKind::kMaybeNumber ||
         question.kind == AnswerKind::kMaybeNumbers;
}

/// Of the question whether a tool can touch the block itself.
constexpr std::string_view kTipRadius = "/tip/radius_mm";
std::string tip_of(const Question& question) {
  return question.pointer.substr(0, question.pointer.rfind('/'));
}

void set_none(const Question& question, TypedJson& document) {
  const bool is_text_of_certificate = question.pointer.starts_with("/block/certificate/");
  if (is_text_of_certificate) {
    document["block"]["certificate"].erase(question.pointer.substr(question.pointer.rfind('/') + 1));
  } else if (question.pointer.starts_with("/base/")) {
    document["base"] = nullptr;  // position and rotation are given together
  } else if (question.pointer.ends_with(kTipRadius)) {
    document[Pointer(tip_of(question))] = nullptr;
  } else {
    document[Pointer(question.pointer)] = nullptr;
  }
}

void set_value(const Question& question, TypedJson value, TypedJson& document) {
  if (question.pointer.starts_with("/base/") && document["base"].is_null()) {
    document["base"] = TypedJson::object();
    document["base"]["position_mm"] = {0, 0, 0};
    document["base"]["rotation_deg"] = {90, 0, 0};
  }
  if (question.pointer.ends_with(kTipRadius) && document[Pointer(tip_of(question))].is_null())
    document[Pointer(tip_of(question))] = TypedJson::object();
  document[Pointer(question.pointer)] = std::move(value);
}

double number_at(const TypedJson& document, const char* pointer) {
  return document.at(Pointer(pointer)).get<double>();
}

/// A box whose smallest corner is beyond its largest one moves that too; it is asked for next.
void keep_box_open(const Question& question, TypedJson& document) {
  constexpr double kOpenMm = 100.0;
  const std::string box = question.pointer.substr(0, question.pointer.rfind('/'));
  const TypedJson min = document.at(Pointer(question.pointer));
  TypedJson& max = document[Pointer(box + "/max_mm")];
  for (std::size_t i = 0; i < 3; ++i)
    if (max[i].get<double>() <= min[i].get<double>()) max[i] = min[i].get<double>() + kOpenMm;
}

/// Answers that are asked for later follow an earlier one where they could not stand beside it: it would be
/// refused for a default that nobody has given.
void let_others_follow(const Question& question, TypedJson& document) {
  if (question.pointer.ends_with("/min_mm")) keep_box_open(question, document);
  if (question.pointer == "/block/size_mm") {
    for (const char* along : {"/0", "/2"}) {
      const double size_mm = number_at(document, (question.pointer + along).c_str());
      TypedJson& plate = document[Pointer(std::string("/block/plate_mm") + along)];
      plate = fitting_plate_mm(plate.get<double>(), size_mm);
    }
  }
  if (question.pointer == "/probe/ball_radius_mm") {
    const double radius_mm = number_at(document, "/probe/ball_radius_mm");
    TypedJson& stem = document[Pointer("/probe/stem_radius_mm")];
    if (stem.get<double>() >= radius_mm) stem = kStemShare * radius_mm;
    TypedJson& length = document[Pointer("/probe/stem_length_mm")];
    length = std::max(length.get<double>(), 2.0 * radius_mm + 2.0);
  }
}

std::string joined(const TypedJson& numbers) {
  std::string text;
  for (const TypedJson& value : numbers)
    text += (text.empty() ? "" : " ") + plain_number(value.get<double>());
  return text;
}

std::string arm_words(const TypedJson& arm) {
  if (arm.contains("urdf"))
    return "urdf " + arm["urdf"].get<std::string>() + " " + arm["base_link"].get<std::string>() + " " +
           arm["tip_link"].get<std::string>();
  if (arm.contains("dh"))
    return "dh " + arm["dh"].get<std::string>() +
           (arm.contains("dh_convention") ? " " + arm["dh_convention"].get<std::string>() : "");
  return arm["file"].get<std::string>();
}

std::string sides_words(const TypedJson& sides) {
  std::string text;
  for (const TypedJson& side : sides)
    text +=
        (text.empty() ? "" : ", ") + side["side"].get<std::string>() + " " + side["name"].get<std::string>();
  return text;
}

}  // namespace

Json new_list_entry(const std::string& list, std::size_t index) {
  const bool is_tools = list == "/tools", is_places = list == "/block/places";
  Json entry = Json::object();
  entry["name"] = (is_tools ? "tool" : is_places ? "place" : "box") + std::to_string(index + 1);
  if (is_tools || is_places) {
    entry["position_mm"] = is_tools ? Json{0, 0, 200} : Json{0, -200, 0};
    entry["rotation_deg"] = {0, 0, 0};
  } else {
    entry["min_mm"] = {400, -1000, -600};
    entry["max_mm"] = {600, 60, 600};
  }
  return entry;
}

std::string present_answer(const SetupAnswers& answers, const Question& question) {
  const TypedJson value = value_at(TypedJson::parse(setup_document(answers)), question.pointer);
  if (value.is_null()) return "-";
  switch (question.kind) {
    case AnswerKind::kText:
    case AnswerKind::kMaybeText:
      return value.get<std::string>();
    case AnswerKind::kNumber:
    case AnswerKind::kMaybeNumber:
      return plain_number(value.get<double>());
    case AnswerKind::kNumbers:
    case AnswerKind::kMaybeNumbers:
      return joined(value);
    case AnswerKind::kYesNo:
      return value.get<bool>() ? "yes" : "no";
    case AnswerKind::kCount:
      return std::to_string(value.size());
    case AnswerKind::kSides:
      return sides_words(value);
    case AnswerKind::kArm:
      return arm_words(value);
  }
  return {};
}

SetupAnswers with_answer(const SetupAnswers& answers, const Question& question, const std::string& typed) {
  TypedJson document = TypedJson::parse(setup_document(answers));
  if (typed == "-" && may_be_none(question)) {
    set_none(question, document);
  } else {
    if (typed.empty()) refuse(question, "is empty; give an answer");
    set_value(question, typed_value(question, value_at(document, question.pointer), typed), document);
    let_others_follow(question, document);
  }
  return read_setup_answers(kTypedSource, document.dump(-1, ' ', false, TypedJson::error_handler_t::replace));
}

}  // namespace cell
