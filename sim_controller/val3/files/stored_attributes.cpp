#include "sim_controller/val3/files/stored_attributes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "sim_controller/val3/files/elements.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/folder_names.hpp"
#include "sim_controller/val3/language/lexer.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

enum class StoredAs { kNumber, kTruth, kText, kLink, kFather, kBlend, kShoulder, kElbow, kWrist };

struct StoredName {
  std::string_view name;
  StoredAs as;
};

using enum StoredAs;
constexpr StoredName kStoredNum[] = {{"value", kNumber}};
constexpr StoredName kStoredBool[] = {{"value", kTruth}};
constexpr StoredName kStoredString[] = {{"value", kText}};
constexpr StoredName kStoredLink[] = {{"link", kLink}};
constexpr StoredName kStoredJoint[] = {{"j1", kNumber}, {"j2", kNumber}, {"j3", kNumber},
                                       {"j4", kNumber}, {"j5", kNumber}, {"j6", kNumber}};
constexpr StoredName kStoredConfig[] = {{"shoulder", kShoulder}, {"elbow", kElbow}, {"wrist", kWrist}};
/// A transformation, and what makes it a frame, a point and a tool: each has the first ones of these.
constexpr StoredName kStoredTrsf[] = {{"x", kNumber},  {"y", kNumber},  {"z", kNumber},       {"rx", kNumber},
                                      {"ry", kNumber}, {"rz", kNumber}, {"fatherId", kFather}};
constexpr StoredName kStoredPoint[] = {
    {"x", kNumber},  {"y", kNumber},        {"z", kNumber},          {"rx", kNumber},   {"ry", kNumber},
    {"rz", kNumber}, {"fatherId", kFather}, {"shoulder", kShoulder}, {"elbow", kElbow}, {"wrist", kWrist}};
constexpr StoredName kStoredTool[] = {
    {"x", kNumber},  {"y", kNumber},        {"z", kNumber},    {"rx", kNumber},     {"ry", kNumber},
    {"rz", kNumber}, {"fatherId", kFather}, {"ioLink", kLink}, {"ioOpen", kNumber}, {"ioClose", kNumber}};
constexpr StoredName kStoredMdesc[] = {{"accel", kNumber}, {"vel", kNumber},  {"decel", kNumber},
                                       {"tmax", kNumber},  {"rmax", kNumber}, {"blend", kBlend},
                                       {"leave", kNumber}, {"reach", kNumber}};

std::span<const StoredName> stored_names(Kind kind) {
  switch (kind) {
    case Kind::kNum:
      return kStoredNum;
    case Kind::kBool:
      return kStoredBool;
    case Kind::kString:
      return kStoredString;
    case Kind::kDio:
    case Kind::kAio:
    case Kind::kSio:
      return kStoredLink;
    case Kind::kTrsf:
      return std::span(kStoredTrsf).first(6);
    case Kind::kFrame:
      return kStoredTrsf;
    case Kind::kTool:
      return kStoredTool;
    case Kind::kMdesc:
      return kStoredMdesc;
    case Kind::kJoint:
      return kStoredJoint;
    case Kind::kJointRs:
      return std::span(kStoredJoint).first(4);
    case Kind::kPoint:
      return kStoredPoint;
    case Kind::kPointRs:
      return std::span(kStoredPoint).first(8);
    case Kind::kConfig:
      return kStoredConfig;
    case Kind::kConfigRs:
      return std::span(kStoredConfig).first(1);
    default:
      return {};
  }
}

/// The word as s7 writes it; empty when it is none. s5 and s6 leave out the letter of the axis.
std::string word_of(StoredAs as, std::string_view text) {
  const std::string word = in_lower_case(text);
  const auto among = [&word](std::initializer_list<std::string_view> words,
                             std::string_view letter) -> std::string {
    for (const std::string_view one : words)
      if (word == one || (!letter.empty() && std::string(letter) + word == one)) return std::string(one);
    return {};
  };
  switch (as) {
    case kTruth:
      return word == "1" ? "true" : word == "0" ? "false" : among({"true", "false"}, "");
    case kBlend:
      return among({"off", "joint", "cartesian"}, "");
    case kShoulder:
      return among({"righty", "lefty", "ssame", "sfree"}, "s");
    case kElbow:
      return among({"epositive", "enegative", "esame", "efree"}, "e");
    case kWrist:
      return among({"wpositive", "wnegative", "wsame", "wfree"}, "w");
    default:
      return std::string(text);
  }
}

std::string_view wanted(StoredAs as) {
  switch (as) {
    case kNumber:
      return "write a number";
    case kTruth:
      return "write true or false";
    case kFather:
      return "write name[index]";
    case kBlend:
      return "write off, joint or cartesian";
    case kShoulder:
      return "write righty, lefty, ssame or sfree";
    case kElbow:
      return "write epositive, enegative, esame or efree";
    case kWrist:
      return "write wpositive, wnegative, wsame or wfree";
    default:
      return "";
  }
}

bool is_of_form(StoredAs as, const std::string& value) {
  if (as == kNumber) return number_in(value).has_value();
  if (as == kFather) return father_in(value).has_value();
  return as == kText || as == kLink || !value.empty();
}

}  // namespace

std::optional<double> number_in(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<StoredFather> father_in(std::string_view text) {
  constexpr std::size_t kIndexMax = 1'000'000'000;
  StoredFather father;
  if (text.ends_with(']')) {
    const std::size_t open = text.find('[');
    if (open == std::string_view::npos) return std::nullopt;
    const auto index = whole_number(text.substr(open + 1, text.size() - open - 2), kIndexMax);
    if (!index) return std::nullopt;
    father.index = *index;
    text = text.substr(0, open);
  }
  if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    father.alias = text.substr(0, colon);
    text.remove_prefix(colon + 1);
  }
  father.name = text;
  if (father.name.empty()) return std::nullopt;
  return father;
}

Attributes checked_attributes(Kind kind, const Attributes& stored, int line, FileFindings& findings) {
  if (kind == Kind::kScreen) return stored;  // a user page: nothing here reads it
  Attributes result;
  const auto names = stored_names(kind);
  for (const auto& [name, text] : stored) {
    const auto known = std::ranges::find(names, name, &StoredName::name);
    if (known == names.end()) {
      findings.error(file_rules::kUnknownAttribute, line,
                     "a " + std::string(name_of(kind)) + " has no attribute " + shown_word(name),
                     "remove it");
      continue;
    }
    // As s6 writes a point without a father and an input without a target.
    if (text.empty() && (known->as == kFather || known->as == kLink)) continue;
    std::string value = word_of(known->as, text);
    if (!is_of_form(known->as, value)) {
      findings.error(file_rules::kBadValue, line, name + " is " + shown_word(text),
                     std::string(wanted(known->as)));
      continue;
    }
    if (known->as == kText && value.size() > kTextBytesMax)
      findings.warning(syntax_rules::kStringTooLong, line,
                       "a text of " + std::to_string(value.size()) + " bytes; a string holds " +
                           std::to_string(kTextBytesMax));
    result.emplace(name, std::move(value));
  }
  return result;
}

}  // namespace val3
