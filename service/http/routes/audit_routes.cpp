#include "service/http/routes/internal/audit_routes.hpp"

#include <spdlog/spdlog.h>

#include "service/documents/audit_document.hpp"
#include "service/http/routes/internal/start_body.hpp"
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

std::optional<std::int64_t> run_of(const HttpRequest& request) {
  const Route* route = find_route(request.method, request.path);
  if (!route || !route->path.starts_with("/api/v1/runs/{id}/")) return std::nullopt;
  return run_id_of(match(route->path, request.path).value_or(""));
}

}  // namespace

std::string operator_named_for(const HttpRequest& request, const RunStore& store) try {
  if (request.path == "/api/v1/runs") return operator_of_start(request);
  const auto id = run_of(request);
  const auto run = id ? store.run(*id) : std::nullopt;
  return run ? run->operator_name.value_or("") : "";
} catch (const std::exception& error) {
  spdlog::error("the operator of {} {} is not known: {}", request.method, request.path, error.what());
  return {};
}

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
