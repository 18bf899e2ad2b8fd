#include "sim_controller/val3/files/file_findings.hpp"

#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {

void FileFindings::tell(Severity severity, std::string_view rule, int line, std::string what,
                        std::string remedy) {
  if (told_ > kFindingsPerFileMax) return;
  ++told_;
  Finding finding{.severity = severity, .rule = std::string(rule), .at = {.file = file_, .line = line}};
  if (told_ > kFindingsPerFileMax) {
    finding.severity = Severity::kError;
    finding.rule = syntax_rules::kTooManyFindings;
    finding.what = "more is wrong in this file than is told";
  } else {
    finding.what = std::move(what);
    finding.remedy = std::move(remedy);
  }
  all_.push_back(std::move(finding));
}

std::string shown_word(std::string_view word) {
  constexpr std::size_t kShownMax = 60;
  std::string result = "'";
  for (const char c : word.substr(0, kShownMax)) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 32 || byte == 127 ? '?' : c;
  }
  // A cut must not leave half a character.
  while (word.size() > kShownMax && (static_cast<unsigned char>(result.back()) & 0xC0U) == 0x80U)
    result.pop_back();
  if (word.size() > kShownMax && (static_cast<unsigned char>(result.back()) & 0x80U) != 0) result.pop_back();
  return result + (word.size() > kShownMax ? "...'" : "'");
}

}  // namespace val3
