#include "service/offline_programs/filter_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace cell {
namespace {

/// Values of one variable.
struct VariableCount {
  int corrected = 0, warned = 0, refused = 0;
};

std::map<std::string, VariableCount> counts_of(const FilteredData& data) {
  std::map<std::string, VariableCount> counts;
  for (const FilteredValue& value : data.values) {
    VariableCount& count = counts[value.variable];
    switch (value.status) {
      case CorrectionStatus::kOk:
        ++count.corrected;
        break;
      case CorrectionStatus::kWarned:
        ++count.corrected;
        ++count.warned;
        break;
      case CorrectionStatus::kRefused:
        ++count.refused;
        break;
    }
  }
  return counts;
}

std::string variable_lines(const FilteredData& data) {
  constexpr std::size_t kNameMin = 16;
  const auto counts = counts_of(data);
  std::size_t width = kNameMin;
  for (const auto& [name, count] : counts) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}{:>12}{:>10}{:>10}{:>15}\n", "variable", width, "corrected", "warned",
                                 "refused", "moved at most");
  for (const auto& [name, count] : counts)
    text += fmt::format("{:<{}}{:>12}{:>10}{:>10}{:>12.3f} mm\n", name, width, count.corrected, count.warned,
                        count.refused, data.filtered_variables.at(name));
  return text;
}

std::string value_lines(const FilteredData& data) {
  std::string text;
  for (const FilteredValue& value : data.values) {
    if (value.status == CorrectionStatus::kRefused)
      text +=
          fmt::format("line {}: {} refused and left as it was: {}\n", value.line, value.name, value.reason);
    if (value.status == CorrectionStatus::kWarned)
      text +=
          fmt::format("line {}: {} corrected, with a warning: {}\n", value.line, value.name, value.reason);
    if (!value.inserted.empty())
      text += fmt::format("line {}: {} has {} now, which was left out as 0\n", value.line, value.name,
                          fmt::join(value.inserted, ", "));
  }
  return text;
}

std::string program_lines(const ProgramWarnings& programs) {
  std::string text;
  for (const ProgramWarning& warning : programs.warnings)
    text += fmt::format("{}:{}: {} of {}: {}\n    {}\n    remedy: {}\n", warning.file, warning.line,
                        word_of(warning.kind), warning.point, warning.error, warning.code, warning.remedy);
  if (programs.is_cut) text += fmt::format("further ones are not told: more than {}\n", kProgramWarningsMax);
  for (const std::string& file : programs.unread) text += "not read: " + file + '\n';
  return text;
}

std::string block_of(const std::string& lines, const std::string& title) {
  return lines.empty() ? "" : '\n' + title + '\n' + lines;
}

}  // namespace

std::string filter_text(const FilteredData& data, const ProgramWarnings& programs) {
  std::string notes;
  for (const std::string& note : data.notes) notes += note + '\n';
  return variable_lines(data) + block_of(value_lines(data), "values") +
         block_of(program_lines(programs), "programs, which are not changed") + block_of(notes, "notes") +
         fmt::format("\noriginal {}\nresult   {}\n", data.mark.original_sha256, data.mark.result_sha256);
}

}  // namespace cell
