#include <spdlog/fmt/fmt.h>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/openapi.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

constexpr std::string_view kPrometheusText = "text/plain; version=0.0.4; charset=utf-8";

HttpResponse get_health(const Call&) { return json_response(200, R"({"status":"ok"})"); }

/// A cell is ready if it accepts a run now, or executes one.
HttpResponse get_readiness(const Call& call) {
  const auto unmet = call.operation.unmet_preconditions();
  if (unmet.empty()) return json_response(200, R"({"status":"ready"})");
  Problem problem{.status = 503, .kind = ProblemKind::kNotReady, .detail = "a run cannot start"};
  for (const Unmet& one : unmet) problem.errors.emplace_back(one.code, one.detail);
  return to_response(problem);
}

HttpResponse get_metrics(const Call& call) {
  return {.content_type = std::string(kPrometheusText),
          .body = call.services.metrics.text(call.operation.status())};
}

HttpResponse get_openapi(const Call&) { return {.body = openapi_document()}; }

HttpResponse get_access(const Call& call) {
  return json_response(
      200, fmt::format(R"({{"role":"{}"}})", role_name(role_of(call.request, call.services.tokens))));
}

}  // namespace

std::vector<Route> service_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/access",
       .summary = "What the request's token may do",
       .handle = get_access,
       .answers = {{.schema = "Access"}}},
      {.method = "GET",
       .path = "/healthz",
       .summary = "The daemon answers",
       .access = Access::kOpen,
       .handle = get_health,
       .answers = {{.schema = "Health"}}},
      {.method = "GET",
       .path = "/readyz",
       .summary = "A run can start now; else 503 with the unmet preconditions",
       .handle = get_readiness,
       .answers = {{.schema = "Health"}}},
      {.method = "GET",
       .path = "/metrics",
       .summary = "Figures for Prometheus",
       .handle = get_metrics,
       .answers = {{.content_type = kPrometheusText}}},
      {.method = "GET",
       .path = "/openapi.json",
       .summary = "This description",
       .handle = get_openapi,
       .answers = {{.schema = "OpenApi"}}},
  };
}

}  // namespace cell
