#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/command_documents.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/openapi.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"

namespace cell {
namespace {

constexpr std::string_view kPrometheusText = "text/plain; version=0.0.4; charset=utf-8";

HttpResponse get_health(const Call&) { return json_response(200, R"({"status":"ok"})"); }

/// A state that has to be left first.
std::optional<Unmet> unmet_by_state(State state) {
  constexpr std::array kNotReady{State::kStopped, State::kStopping, State::kAborted, State::kAborting};
  if (std::ranges::find(kNotReady, state) == kNotReady.end()) return std::nullopt;
  return Unmet{"state", fmt::format("the cell is in {}", state_name(state))};
}

/// Without room to record it, a start is refused.
std::optional<Unmet> unmet_by_disk(const RunStore& store) {
  constexpr std::uintmax_t kRoomBytes = 1024 * 1024;
  const auto room_bytes = disk_room_bytes(store.database());
  if (!room_bytes)
    return Unmet{"store_not_writable", "the state directory is no longer there: a run could not be recorded"};
  if (*room_bytes >= kRoomBytes) return std::nullopt;
  return Unmet{"disk_full", "the disk of the state directory is full: a run could not be recorded"};
}

/// A cell is ready if it accepts a run now, or executes one.
Asked ask_readiness(const Call&, CellOperation& operation) {
  Asked asked{.unmet = operation.unmet_before_start()};
  if (auto one = unmet_by_state(operation.status().state)) asked.unmet.push_back(*std::move(one));
  return asked;
}

/// What keeps no run from starting: what a sink does not get is kept for it.
std::vector<std::string> remarks_of(const SinkStates& sinks) {
  std::vector<std::string> remarks;
  for (const SinkState& sink : sinks.all()) {
    if (sink.trouble)
      remarks.push_back(fmt::format("{}: {} facts behind: {}", sink.sink, sink.behind, *sink.trouble));
    else if (sink.behind >= kFarBehindFacts)
      remarks.push_back(fmt::format("{}: {} facts behind, and it takes them", sink.sink, sink.behind));
  }
  return remarks;
}

HttpResponse get_readiness(const Call& call) {
  auto unmet = call.asked.unmet;
  if (auto one = unmet_by_disk(call.reads.store())) unmet.push_back(*std::move(one));
  const std::vector<std::string> remarks = remarks_of(call.services.feed.sinks());
  if (unmet.empty()) return json_response(200, document_text(ReadyDocument{.remarks = remarks}));
  Problem problem{.status = 503, .kind = ProblemKind::kNotReady, .detail = "a run cannot start"};
  for (const std::string& remark : remarks) problem.detail += "; also, " + remark;
  for (const Unmet& one : unmet) problem.errors.emplace_back(one.code, one.detail);
  return to_response(problem);
}

HttpResponse get_metrics(const Call& call) {
  return {.content_type = std::string(kPrometheusText),
          .body = call.services.metrics.text(call.services.feed.status(), call.reads.now())};
}

HttpResponse get_openapi(const Call&) { return {.body = openapi_document()}; }

/// In the words of the tokens that are in files.
std::string_view what_may(Role role) {
  if (role == Role::kEngineer) return role_name(Role::kOperate);
  return role_name(role == Role::kOverSession ? Role::kWrongToken : role);
}

HttpResponse get_access(const Call& call) {
  return json_response(
      200, fmt::format(R"({{"role":"{}"}})", what_may(role_of(call.request, call.services.tokens))));
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
       .ask = ask_readiness,
       .answers = {{.schema = "Health"}},
       .dispatch = DispatchMode::kStored},
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
