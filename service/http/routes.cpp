#include "service/http/routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "service/acquisition/operation.hpp"
#include "service/http/json_view.hpp"
#include "service/http/plan_routes.hpp"
#include "service/http/request_body.hpp"
#include "service/http/result_routes.hpp"

namespace cell {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kIdempotencyKeyMax = 255;
constexpr int kRunsPageDefault = 50;
constexpr int kRunsPageMax = 200;
constexpr int kWaitSecondsMax = 60;

struct Call {
  const HttpRequest& request;
  Operation& operation;
  std::vector<std::string> segments;  // of the path, behind /api/v1

  [[nodiscard]] std::string_view segment(std::size_t index) const {
    return index < segments.size() ? std::string_view(segments[index]) : std::string_view();
  }
};

const char* title_of(unsigned status) {
  switch (status) {
    case 400:
      return "Bad request";
    case 401:
      return "Token needed";
    case 403:
      return "Not allowed";
    case 404:
      return "Not found";
    case 405:
      return "Method not allowed";
    case 409:
      return "Not in this state";
    case 413:
      return "Too large";
    case 415:
      return "Wrong content type";
    case 417:
      return "Expectation failed";
    case 421:
      return "Wrong host";
    case 422:
      return "Not possible";
    case 431:
      return "Header too large";
    case 501:
      return "Not supported";
    case 503:
      return "Busy";
    default:
      return "Internal error";
  }
}

template <class Integer>
std::optional<Integer> integer(std::string_view text) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

HttpResponse json_response(unsigned status, std::string body) {
  return {.status = status, .body = std::move(body)};
}

HttpResponse not_found(std::string detail) {
  return to_response({.status = 404, .kind = "not-found", .detail = std::move(detail)});
}

HttpResponse from_refusal(const Refusal& refusal, const Operation& operation) {
  Problem problem{.status = 409, .kind = "state", .detail = refusal.detail};
  switch (refusal.kind) {
    case Refusal::Kind::kState:
      break;
    case Refusal::Kind::kPreconditions:
      problem.kind = "preconditions";
      break;
    case Refusal::Kind::kUnknownRecipe:
      problem.status = 422;
      problem.kind = "unknown-recipe";
      problem.pointer = "/recipe";
      break;
    case Refusal::Kind::kOtherKey:
      problem.status = 422;
      problem.kind = "idempotency-key";
      break;
    case Refusal::Kind::kNotThisRun:
      problem.kind = "not-this-run";
      break;
  }
  for (const Unmet& unmet : refusal.unmet) problem.errors.emplace_back(unmet.code, unmet.detail);
  if (!refusal.unmet.empty()) {
    problem.detail += ": ";
    for (const Unmet& unmet : refusal.unmet)
      problem.detail += (&unmet == refusal.unmet.data() ? "" : "; ") + unmet.detail;
  }
  for (const Command command : operation.exits())
    problem.exits.emplace_back(command_name(command));
  return to_response(problem);
}

HttpResponse get_status(const Call& call) {
  const Status status = call.operation.status();
  const std::string etag = fmt::format("\"{}-{}\"", status.instance_id, status.sequence);
  const auto& known = call.request.if_none_match;
  if (known && (*known == "*" || known->find(etag) != std::string::npos)) {
    return {.status = 304, .headers = {{"ETag", etag}}};
  }
  HttpResponse response = json_response(200, status_document(status));
  response.headers = {{"ETag", etag}};
  return response;
}

HttpResponse get_runs(const Call& call) {
  const auto& query = call.request.query;
  int limit = kRunsPageDefault;
  std::optional<std::int64_t> before;
  if (const auto found = query.find("limit"); found != query.end()) {
    const auto wanted = integer<int>(found->second);
    if (!wanted || *wanted < 1 || *wanted > kRunsPageMax) {
      return to_response(
          {.kind = "query", .detail = fmt::format("limit takes a number from 1 to {}", kRunsPageMax)});
    }
    limit = *wanted;
  }
  if (const auto found = query.find("before"); found != query.end()) {
    before = integer<std::int64_t>(found->second);
    if (!before) return to_response({.kind = "query", .detail = "before takes the id of a run"});
  }
  auto runs = call.operation.store().runs(limit + 1, before);
  const bool more = runs.size() > static_cast<std::size_t>(limit);
  if (more) runs.pop_back();
  return json_response(200, runs_document(runs, more ? std::optional(runs.back().id) : std::nullopt));
}

HttpResponse get_of_run(const Call& call) {
  const auto id = integer<std::int64_t>(call.segment(1));
  const auto run = id ? call.operation.store().run(*id) : std::nullopt;
  if (!run)
    return not_found(fmt::format("there is no run '{}'; GET /api/v1/runs lists them", call.segment(1)));
  if (call.segments.size() == 2) return json_response(200, run_document(*run));
  if (call.segment(2) == "touches") {
    return json_response(200, touches_document(call.operation.cell(), call.operation.store().touches(*id)));
  }
  if (call.segment(2) == "arm") return get_arm(call.operation, *id);
  if (call.segment(2) == "plan") return get_plan(call.operation, *id);
  return get_result(call.operation, *id);
}

/// The recipe that a start's body names, itself or by a plan, or what is wrong with it.
std::variant<std::string, Problem> recipe_of(const Call& call) {
  constexpr std::array<std::string_view, 2> kKeys{"recipe", "plan_id"};
  auto named = named_text(call.request.body, kKeys);
  if (auto* problem = std::get_if<Problem>(&named)) return std::move(*problem);
  auto& [key, text] = std::get<NamedText>(named);
  if (key == "recipe") return std::move(text);
  if (const auto plan = call.operation.plan_with_id(text)) return plan->recipe;
  return Problem{.status = 404,
                 .kind = "unknown-plan",
                 .detail = fmt::format(
                     "there is no plan '{}' since the daemon began; POST /api/v1/plan makes it again", text),
                 .pointer = "/plan_id"};
}

HttpResponse post_runs(const Call& call) {
  const auto& key = call.request.idempotency_key;
  if (key && (key->empty() || key->size() > kIdempotencyKeyMax)) {
    return to_response(
        {.kind = "idempotency-key",
         .detail = fmt::format("an Idempotency-Key has 1 to {} characters", kIdempotencyKeyMax)});
  }
  const auto recipe = recipe_of(call);
  if (const auto* problem = std::get_if<Problem>(&recipe)) return to_response(*problem);
  const auto outcome =
      call.operation.start({.recipe = std::get<std::string>(recipe), .idempotency_key = key});
  if (const auto* refusal = std::get_if<Refusal>(&outcome)) return from_refusal(*refusal, call.operation);
  const std::int64_t id = std::get<Started>(outcome).run_id;
  HttpResponse response = json_response(201, run_document(call.operation.store().run(id).value()));
  response.headers = {{"Location", fmt::format("/api/v1/runs/{}", id)}};
  return response;
}

HttpResponse post_a_plan(const Call& call) { return post_plan(call.request, call.operation); }

HttpResponse give_command(const Call& call, Command command, std::optional<std::int64_t> run_id) {
  // A stop is taken whatever comes with it.
  if (command != Command::kStop && !call.request.body.empty() && call.request.body != "{}") {
    return to_response({.kind = "body", .detail = "this command takes no body", .pointer = ""});
  }
  if (const auto refusal = call.operation.command(command, run_id))
    return from_refusal(*refusal, call.operation);
  return json_response(202, status_document(call.operation.status()));
}

HttpResponse post_to_run(const Call& call, Command command) {
  const auto id = integer<std::int64_t>(call.segment(1));
  if (!id || !call.operation.store().run(*id))
    return not_found(fmt::format("there is no run '{}'", call.segment(1)));
  return give_command(call, command, id);
}

struct Route {
  std::string_view method;
  std::string_view path;  // behind /api/v1; * is any one segment
  HttpResponse (*handle)(const Call&);
};

template <Command kCommand>
HttpResponse run_command(const Call& call) {
  return post_to_run(call, kCommand);
}
template <Command kCommand>
HttpResponse cell_command(const Call& call) {
  return give_command(call, kCommand, std::nullopt);
}

constexpr std::array kRoutes{
    Route{"GET", "status", get_status},
    Route{"GET", "runs", get_runs},
    Route{"POST", "runs", post_runs},
    Route{"GET", "runs/*", get_of_run},
    Route{"GET", "runs/*/touches", get_of_run},
    Route{"GET", "runs/*/result", get_of_run},
    Route{"GET", "runs/*/arm", get_of_run},
    Route{"GET", "runs/*/plan", get_of_run},
    Route{"POST", "plan", post_a_plan},
    Route{"POST", "runs/*/pause", run_command<Command::kPause>},
    Route{"POST", "runs/*/resume", run_command<Command::kResume>},
    Route{"POST", "runs/*/abort", run_command<Command::kAbort>},
    Route{"POST", "cell/stop", cell_command<Command::kStop>},
    Route{"POST", "cell/acknowledge", cell_command<Command::kAcknowledge>},
    Route{"POST", "cell/clear", cell_command<Command::kClear>},
    Route{"POST", "cell/reset", cell_command<Command::kReset>},
};

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    const std::size_t end = path.find('/');
    segments.emplace_back(path.substr(0, end));
    path = end == std::string_view::npos ? std::string_view() : path.substr(end + 1);
  }
  return segments;
}

bool matches(std::string_view pattern, const std::vector<std::string>& segments) {
  const std::vector<std::string> wanted = split(pattern);
  return std::ranges::equal(wanted, segments,
                            [](const auto& want, const auto& is) { return want == "*" || want == is; });
}

/// Nothing when the request may do what it asks.
std::optional<HttpResponse> refuse_access(const HttpRequest& request, const Tokens& tokens) {
  const bool changes = request.method != "GET";
  if (!changes && request.from_loopback) return std::nullopt;
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view sent =
      request.authorization ? std::string_view(*request.authorization) : std::string_view();
  const std::string_view token = sent.starts_with(kScheme) ? sent.substr(kScheme.size()) : std::string_view();
  if (same_token(tokens.operate, token)) return std::nullopt;
  if (same_token(tokens.view, token)) {
    if (!changes) return std::nullopt;
    return to_response({.status = 403, .kind = "role", .detail = "the view token may only read"});
  }
  HttpResponse response = to_response(
      {.status = 401,
       .kind = "token",
       .detail = fmt::format(
           "send 'Authorization: Bearer TOKEN'; the token stands in {} in the daemon's state directory",
           kOperateTokenFile)});
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"touchcal\"");
  return response;
}

/// A body must say that it is JSON: a web page elsewhere cannot send that without asking.
std::optional<HttpResponse> refuse_content_type(const HttpRequest& request) {
  if (request.body.empty()) return std::nullopt;
  const std::string_view type =
      request.content_type ? std::string_view(*request.content_type) : std::string_view();
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  if (std::ranges::equal(type.substr(0, type.find_first_of("; \t")), std::string_view("application/json"), {},
                         lower)) {
    return std::nullopt;
  }
  return to_response({.status = 415, .kind = "content-type", .detail = "a body must be application/json"});
}

}  // namespace

HttpResponse to_response(const Problem& problem) {
  Json document{{"type", fmt::format("urn:touchcal:problem:{}", problem.kind)},
                {"title", title_of(problem.status)},
                {"status", problem.status},
                {"detail", problem.detail}};
  if (problem.pointer) document["pointer"] = *problem.pointer;
  for (const auto& [code, detail] : problem.errors)
    document["errors"].push_back({{"code", code}, {"detail", detail}});
  if (!problem.exits.empty()) document["exits"] = problem.exits;
  return {.status = problem.status,
          .content_type = "application/problem+json",
          .body = document.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

std::optional<LongPoll> long_poll(const HttpRequest& request) {
  const auto wait = request.query.find("wait_s");
  const auto after = request.query.find("after");
  if (request.method != "GET" || request.path != "/api/v1/status" || wait == request.query.end() ||
      after == request.query.end()) {
    return std::nullopt;
  }
  const auto seconds = integer<int>(wait->second);
  const auto sequence = integer<std::uint64_t>(after->second);
  if (!seconds || !sequence || *seconds < 0) return std::nullopt;
  return LongPoll{*sequence, std::chrono::seconds(std::min(*seconds, kWaitSecondsMax))};
}

std::optional<std::string> recipe_to_plan(const HttpRequest& request, const Operation& operation,
                                          const Tokens& tokens) {
  if (request.method != "POST" || request.path != "/api/v1/plan" || operation.is_planning() ||
      refuse_access(request, tokens) || refuse_content_type(request)) {
    return std::nullopt;
  }
  constexpr std::array<std::string_view, 1> kKeys{"recipe"};
  const auto named = named_text(request.body, kKeys);
  const auto* recipe = std::get_if<NamedText>(&named);
  if (!recipe || !operation.cell().recipes.contains(recipe->text) || operation.planned(recipe->text))
    return std::nullopt;
  return recipe->text;
}

std::vector<RouteName> route_names() {
  std::vector<RouteName> names;
  for (const Route& known : kRoutes) names.push_back({known.method, known.path});
  return names;
}

HttpResponse route(const HttpRequest& request, Operation& operation, const Tokens& tokens) {
  if (request.path == "/healthz" && request.method == "GET") return json_response(200, R"({"status":"ok"})");

  constexpr std::string_view kPrefix = "/api/v1/";
  std::string allowed;
  if (request.path.starts_with(kPrefix)) {
    const std::vector<std::string> segments = split(std::string_view(request.path).substr(kPrefix.size()));
    for (const Route& candidate : kRoutes) {
      if (!matches(candidate.path, segments)) continue;
      if (candidate.method != request.method) {
        allowed += (allowed.empty() ? "" : ", ") + std::string(candidate.method);
        continue;
      }
      if (auto refused = refuse_access(request, tokens)) return *refused;
      if (auto refused = refuse_content_type(request); refused && candidate.path != "cell/stop")
        return *refused;
      return candidate.handle({request, operation, segments});
    }
  }
  if (allowed.empty() && request.path == "/healthz") allowed = "GET";
  if (allowed.empty()) return not_found(fmt::format("there is nothing at {}", request.path));
  HttpResponse response =
      to_response({.status = 405, .kind = "method", .detail = "this path takes " + allowed});
  response.headers.emplace_back("Allow", allowed);
  return response;
}

}  // namespace cell
