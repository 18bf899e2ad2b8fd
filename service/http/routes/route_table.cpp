#include "service/http/routes/route_table.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/internal/start_body.hpp"
#include "service/http/routes/services.hpp"
#include "service/http/server/target.hpp"
#include "service/store/damaged_store.hpp"

namespace cell {
namespace {

/// The user whose session a request is of; empty for a token of a file.
std::string signed_in(const HttpRequest& request, const Tokens& tokens) {
  const Caller caller = caller_of(request, tokens);
  return caller.is_user ? caller.token_name : std::string();
}

std::vector<Route> all_routes() {
  std::vector<Route> all;
  for (const auto topic :
       {service_routes, status_routes, run_routes, run_file_routes, command_routes, plan_routes,
        compensation_routes, cell_routes, audit_routes, model_routes, check_routes, comparison_routes,
        page_routes, user_routes, setup_routes, fleet_routes}) {
    std::ranges::move(topic(), std::back_inserter(all));
  }
  return all;
}

std::optional<std::int64_t> integer(std::string_view text) {
  std::int64_t value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Unknown query parameters are refused: most likely they are mistakes.
std::optional<HttpResponse> refuse_query(const Route& route, const Query& query) {
  for (const auto& [name, value] : query) {
    const auto known = std::ranges::find(route.query, std::string_view(name), &QueryParameter::name);
    std::string detail;
    if (known == route.query.end()) {
      detail =
          route.query.empty() ? "this path has no query parameters" : "this path has no such query parameter";
    } else if (query.count(name) > 1) {
      detail = fmt::format("{} is given twice", name);
    } else if (const auto number = integer(value);
               !known->is_text && (!number || *number < known->minimum || *number > known->maximum)) {
      detail = fmt::format("{} must be a whole number from {} to {}", name, known->minimum, known->maximum);
    }
    if (!detail.empty())
      return to_response({.kind = ProblemKind::kQuery, .detail = std::move(detail), .parameter = name});
  }
  return std::nullopt;
}

std::optional<HttpResponse> refuse_body(const Route& route, const HttpRequest& request) {
  if (request.body.size() > body_bytes_max(route))
    return to_response({.status = 413, .kind = ProblemKind::kTooLarge, .detail = "the body is too large"});
  if (auto refused = refuse_content_type(request)) return refused;
  if (!route.body_schema.empty() || request.body.empty() || request.body == "{}") return std::nullopt;
  return to_response({.kind = ProblemKind::kBody, .detail = "this path takes no body", .pointer = ""});
}

std::optional<HttpResponse> refuse_key(const HttpRequest& request) {
  constexpr std::size_t kKeyMax = 255;
  const auto& key = request.idempotency_key;
  if (!key || (!key->empty() && key->size() <= kKeyMax)) return std::nullopt;
  return to_response({.kind = ProblemKind::kIdempotencyKey,
                      .detail = fmt::format("an Idempotency-Key has 1 to {} characters", kKeyMax)});
}

}  // namespace

std::span<const Route> routes() {
  static const std::vector<Route> all = all_routes();
  return all;
}

std::size_t body_bytes_max(const Route& route) {
  return route.body_schema.empty() ? kEmptyBodyBytesMax : route.body_bytes_max;
}

bool is_stop(const Route& route) { return route.path == "/api/v1/cell/stop"; }

bool halts_only(const Route& route) {
  return is_stop(route) || route.path.ends_with("/abort") || route.path.ends_with("/pause");
}

std::optional<std::string_view> match(std::string_view pattern, std::string_view path) {
  constexpr std::string_view kId = "{id}";
  const std::size_t before = pattern.find(kId);
  if (before == std::string_view::npos)
    return pattern == path ? std::optional(std::string_view()) : std::nullopt;
  const std::string_view behind = pattern.substr(before + kId.size());
  if (!path.starts_with(pattern.substr(0, before))) return std::nullopt;
  const std::string_view rest = path.substr(before);
  const std::string_view id = rest.substr(0, rest.find('/'));
  if (id.empty() || rest.substr(id.size()) != behind) return std::nullopt;
  return id;
}

const Route* find_route(std::string_view method, std::string_view path) {
  for (const Route& candidate : routes()) {
    if (candidate.method == method && match(candidate.path, path)) return &candidate;
  }
  return nullptr;
}

std::variant<Admitted, HttpResponse> admit(const HttpRequest& request, const Tokens& tokens) {
  std::string allowed;
  for (const Route& candidate : routes()) {
    const auto id = match(candidate.path, request.path);
    if (!id) continue;
    if (candidate.method != request.method) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(candidate.method);
      continue;
    }
    if (auto refused = refuse_access(request, candidate.access, tokens)) return *std::move(refused);
    if (is_stop(candidate)) return Admitted{&candidate, decode_segment(*id)};
    if (decode_segment(*id).size() > kIdBytesMax)
      return not_found(fmt::format("an id has at most {} bytes", kIdBytesMax));
    if (auto refused = refuse_query(candidate, request.query)) return *std::move(refused);
    if (auto refused = refuse_body(candidate, request)) return *std::move(refused);
    if (auto refused = refuse_key(request)) return *std::move(refused);
    const bool has_operator = candidate.starts_run || candidate.names_operator;
    return Admitted{&candidate, decode_segment(*id),
                    has_operator ? parse_start(request.body, signed_in(request, tokens)) : nullptr};
  }
  if (allowed.empty()) return not_found(fmt::format("there is nothing at {}", request.path));
  HttpResponse response =
      to_response({.status = 405, .kind = ProblemKind::kMethod, .detail = "this path takes " + allowed});
  response.headers.emplace_back("Allow", allowed);
  return response;
}

Asked ask_operation(const Admitted& admitted, const HttpRequest& request, Services& services) {
  if (!admitted.route->ask) return {};
  const Asked nothing;
  try {
    return admitted.route->ask(
        {request, services, admitted.id, services.reads, nothing, admitted.start.get()}, services.operation);
  } catch (const std::exception& error) {
    spdlog::error("{} {} failed: {}", request.method, request.path, error.what());
    return {.failed = true};
  }
}

HttpResponse handle(const Admitted& admitted, const HttpRequest& request, Services& services,
                    const Reads& reads, const Asked& asked) {
  const Problem internal{
      .status = 500, .kind = ProblemKind::kInternal, .detail = "internal error; see the log of the daemon"};
  if (asked.failed) return to_response(internal);
  try {
    return admitted.route->handle({request, services, admitted.id, reads, asked, admitted.start.get()});
  } catch (const DamagedStore& damage) {
    spdlog::error("{} {}: {}", request.method, request.path, damage.what());
    services.metrics.count_internal_error();
    return to_response({.status = 503, .kind = ProblemKind::kDamaged, .detail = damage.what()});
  } catch (const std::exception& error) {
    spdlog::error("{} {} failed: {}", request.method, request.path, error.what());
    return to_response(internal);
  }
}

boost::asio::awaitable<Asked> answer_start(CellOperation& operation, StartRequest request) {
  auto outcome = co_await operation.start(std::move(request));
  Asked asked;
  if (auto* refusal = std::get_if<CommandRefusal>(&outcome)) {
    asked.refusal = std::move(*refusal);
    asked.exits = operation.exits();
  } else {
    asked.started = std::get<Started>(std::move(outcome));
  }
  co_return asked;
}

boost::asio::awaitable<HttpResponse> route(HttpRequest request, CellOperation& operation, Tokens tokens) {
  Services services(operation, std::move(tokens));
  const auto outcome = admit(request, services.tokens);
  if (const auto* refused = std::get_if<HttpResponse>(&outcome)) co_return *refused;
  const Admitted& admitted = std::get<Admitted>(outcome);
  Asked asked = ask_operation(admitted, request, services);
  if (asked.to_start) asked = co_await answer_start(operation, *asked.to_start);
  if (asked.is_storing) co_await operation.touch_stored();
  services.reads.update();
  co_return handle(admitted, request, services, services.reads, asked);
}

std::optional<std::int64_t> Call::number(std::string_view name) const {
  const auto found = request.query.find(std::string(name));
  return found == request.query.end() ? std::nullopt : integer(found->second);
}

std::optional<std::string> Call::text(std::string_view name) const {
  const auto found = request.query.find(std::string(name));
  return found == request.query.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::int64_t> run_id_of(std::string_view segment) { return integer(segment); }

std::optional<std::int64_t> Call::run_id() const { return run_id_of(id); }

HttpResponse json_response(unsigned status, std::string body) {
  return {.status = status, .body = std::move(body)};
}

HttpResponse not_found(std::string detail) {
  return to_response({.status = 404, .kind = ProblemKind::kNotFound, .detail = std::move(detail)});
}

}  // namespace cell
