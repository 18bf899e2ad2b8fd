#include "service/documents/audit_document.hpp"

#include <algorithm>
#include <iterator>

#include "service/documents/internal/document_fields.hpp"

namespace cell {

namespace {

std::optional<std::string> if_named(const std::string& name) {
  return name.empty() ? std::nullopt : std::optional(name);
}

}  // namespace

AuditDocument audit_page(const std::vector<AuditEntry>& entries, std::optional<std::int64_t> next_before) {
  AuditDocument page;
  if (next_before) page.next_before = std::to_string(*next_before);
  std::ranges::transform(entries, std::back_inserter(page.rows), [](const AuditEntry& entry) {
    return AuditRow{.id = std::to_string(entry.id),
                    .at = entry.at,
                    .role = entry.who,
                    .token_name = if_named(entry.token_name),
                    .operator_name = if_named(entry.operator_name),
                    .remote = entry.remote,
                    .action = entry.action,
                    .outcome = entry.outcome,
                    .detail = entry.detail,
                    .hash = entry.hash};
  });
  return page;
}

std::string document_text(const AuditDocument& document) { return written(document); }

AuditDocument read_audit(std::string_view text) {
  return document_from<AuditDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
