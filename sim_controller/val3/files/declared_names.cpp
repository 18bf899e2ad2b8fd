#include "sim_controller/val3/files/declared_names.hpp"

#include <algorithm>

#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/language/lexer.hpp"

namespace val3 {
namespace {

bool is_valid_name(std::string_view name) {
  const auto is_letter_of_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto is_digit_of_name = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && is_letter_of_name(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return is_letter_of_name(c) || is_digit_of_name(c); });
}

}  // namespace

bool DeclaredNames::add(std::string_view name, std::string_view what, int line, FileFindings& findings) {
  const std::string shown = "the name " + shown_word(name) + " of a " + std::string(what);
  if (!is_valid_name(name)) {
    findings.error(file_rules::kInvalidName, line, shown + " is none",
                   "a name has a letter, then letters, digits and _");
  } else if (is_keyword(name)) {
    findings.error(file_rules::kReservedName, line, shown + " is a keyword", "take another name");
  } else if (name.size() > kNameCharactersMax && language_.major < 8) {
    const bool is_old = language_.major < 7;
    findings.tell(is_old ? Severity::kError : Severity::kNote, file_rules::kNameTooLong, line,
                  shown + " has " + std::to_string(name.size()) + " characters; " +
                      (is_old ? "at most " : "the tools of s7 write at most ") +
                      std::to_string(kNameCharactersMax),
                  "take a shorter one");
  }
  const auto [first, is_new] = seen_.emplace(name, line);
  if (!is_new)
    findings.error(
        file_rules::kDuplicateName, line,
        shown + " is taken already" + (first->second > 0 ? ", in line " + std::to_string(first->second) : ""),
        "take another name");
  return is_new;
}

}  // namespace val3
