#include "service/documents/audit_document.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/store/audit_log.hpp"

namespace cell {
namespace {

constexpr int kAuditPageDefault = 100;
constexpr int kAuditPageMax = 500;
constexpr std::int64_t kAuditIdMax = std::int64_t{1} << 53;

HttpResponse get_audit(const Call& call) {
  const int limit = static_cast<int>(call.number("limit").value_or(kAuditPageDefault));
  auto entries = AuditLog(call.reads.store().database()).page(limit + 1, call.number("before"));
  const bool more = entries.size() > static_cast<std::size_t>(limit);
  if (more) entries.pop_back();
  return json_response(
      200, document_text(audit_page(entries, more ? std::optional(entries.back().id) : std::nullopt)));
}

}  // namespace

std::vector<Route> audit_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/audit",
       .summary = "The audit log, newest first, in pages: every command and refusal. It names people and "
                  "addresses, so that it needs the operate token, also on loopback",
       .access = Access::kOperate,
       .handle = get_audit,
       .answers = {{.schema = "Audit"}},
       .query = {{"limit", 1, kAuditPageMax, "rows on a page"},
                 {"before", 0, kAuditIdMax, "only rows before this id"}},
       .dispatch = DispatchMode::kStored},
  };
}

}  // namespace cell
