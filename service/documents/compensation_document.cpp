#include "service/documents/compensation_document.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "config/targets_file.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {

int CompensationDocument::count(calib::CompensationStatus status) const {
  return static_cast<int>(std::ranges::count(targets, status, &Target::status));
}

int CompensationDocument::count_inserted() const {
  return static_cast<int>(
      std::ranges::count_if(targets, [](const Target& target) { return target.inserted.value_or(false); }));
}

std::string document_text(const CompensationDocument& document) { return written(document); }

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
