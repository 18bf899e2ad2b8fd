#include "service/documents/compensation_document.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "config/targets_file.hpp"
#include "service/documents/internal/document_fields.hpp"
#include "service/documents/internal/field_text.hpp"

namespace cell {

CompensationDocument CompensationDocument::head() const {
  return {.schema = schema, .model = model, .warmth = warmth, .touched = touched};
}

int CompensationDocument::count(calib::CompensationStatus status) const {
  return static_cast<int>(std::ranges::count(targets, status, &Target::status));
}

int CompensationDocument::count_inserted() const {
  return static_cast<int>(
      std::ranges::count_if(targets, [](const Target& target) { return target.inserted.value_or(false); }));
}

std::string document_text(const CompensationDocument& document) {
  // Target by target: as one JSON value 100,000 of them take a second and 100 MB.
  std::string text = written(document.head());
  constexpr std::string_view kEnd = "]}";  // `targets` is the last field
  text.resize(text.size() - kEnd.size());
  const std::size_t before = text.size();
  for (const CompensationDocument::Target& target : document.targets) {
    if (&target != document.targets.data()) text += ',';
    FieldText::append(target, text);
    if (&target == document.targets.data())
      text.reserve(before + (text.size() - before) * 5 / 4 * document.targets.size());
  }
  text += kEnd;
  return text;
}

std::string compensated_csv(const CompensationDocument& document) {
  std::string lines(kTargetsCsvHeader);
  lines += "\n";
  for (const CompensationDocument::Target& target : document.targets) {
    lines += target.name;
    for (std::size_t joint = 0; joint < calib::kJointCount; ++joint)
      lines += target.joints_deg ? fmt::format(",{:.9f}", (*target.joints_deg)[joint]) : ",";
    lines += "\n";
  }
  return lines;
}

CompensationDocument read_compensation(std::string_view text) {
  return document_from<CompensationDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
