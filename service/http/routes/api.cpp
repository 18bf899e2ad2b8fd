#include "service/http/routes/api.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/digest.hpp"
#include "service/base/utc_time.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/internal/event_stream.hpp"
#include "service/http/routes/internal/plan_routes.hpp"
#include "service/http/server/target.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Longest wait of a long poll; at most so many at once.
constexpr std::int64_t kWaitSecondsMax = 60;
constexpr std::size_t kLongPollsMax = 128;
/// Requests on the worker and queued for it.
constexpr int kAtWorkMax = 4;
/// After so many wrong tokens from one address, each further answer is delayed.
constexpr int kWrongTokensFree = 5;
constexpr std::size_t kWrongAddressesMax = 1024;
/// After so long without another one they are forgotten.
constexpr auto kWrongTokensKept = 10min;
constexpr std::size_t kActionBytesMax = 200;

HttpResponse busy(std::string detail, const char* retry_after_s) {
  HttpResponse response =
      to_response({.status = 503, .kind = ProblemKind::kBusy, .detail = std::move(detail)});
  response.headers.emplace_back("Retry-After", retry_after_s);
  return response;
}

bool is_command(const HttpRequest& request) { return request.method != "GET"; }

/// The stored answer to a key, or its refusal; nothing for a new key. `must_go_on`: also where keys cannot be
/// looked up.
std::optional<HttpResponse> answer_to_key(AnswerStore& answers, const KeyedRequest& keyed,
                                          std::chrono::system_clock::time_point now, bool must_go_on) {
  KeyLookUp found;
  try {
    found = answers.take(keyed, format_utc(now - std::chrono::hours(AnswerStore::kKeptHours)));
  } catch (const std::exception& error) {
    spdlog::error("Idempotency-Keys cannot be looked up: {}", error.what());
    if (must_go_on) return std::nullopt;
    return to_response({.status = 503,
                        .kind = ProblemKind::kIdempotencyKey,
                        .detail = "earlier answers cannot be read; see the log"});
  }
  if (const auto* answer = std::get_if<StoredAnswer>(&found))
    return HttpResponse{.status = answer->status, .body = answer->body, .headers = answer->headers};
  if (std::holds_alternative<KeyReused>(found)) {
    return to_response({.status = 422,
                        .kind = ProblemKind::kIdempotencyKey,
                        .detail = "this Idempotency-Key was used with another request; take a new one"});
  }
  if (std::holds_alternative<KeyInProgress>(found)) {
    return to_response({.status = 409,
                        .kind = ProblemKind::kIdempotencyKey,
                        .detail = "the first request with this Idempotency-Key is still being answered"});
  }
  return std::nullopt;
}

}  // namespace

Api::Api(asio::any_io_executor executor, CellOperation& operation, Tokens tokens)
    : executor_(executor), services_(operation, std::move(tokens)) {
  services_.feed.follow([this](const Status& status) { services_.metrics.follow(status); });
}

Api::~Api() { worker_.join(); }

Services::Services(CellOperation& to_serve, Tokens to_ask_for)
    : operation(to_serve),
      tokens(std::move(to_ask_for)),
      feed(to_serve),
      answers(to_serve.store().database()),
      audit(to_serve.store().database()) {}

HttpResponse Api::refuse(const Problem& problem, const HttpRequest& request) {
  services_.metrics.count_request("", "", problem.status);
  HttpResponse response = to_response(problem);
  if (is_command(request)) write_audit(request, std::to_string(problem.status), false);
  return response;
}

asio::awaitable<HttpResponse> Api::answer(const HttpRequest& request) {
  const auto outcome = admit(request, services_.tokens);
  if (const auto* refused = std::get_if<HttpResponse>(&outcome)) {
    if (is_command(request)) write_audit(request, std::to_string(refused->status), false);
    if (refused->status == 401) co_await delay_wrong_token(request);
    services_.metrics.count_request("", "", refused->status);
    co_return *refused;
  }
  const Admitted& admitted = std::get<Admitted>(outcome);
  if (request.authorization && role_of(request, services_.tokens) != Role::kWrongToken)
    wrong_tokens_.erase(request.remote);
  HttpResponse response;
  if (is_command(request)) {
    response = co_await execute_command(request, admitted);
  } else {
    response = co_await make_answer(request, admitted);
  }
  services_.metrics.count_request(admitted.route->method, admitted.route->path, response.status);
  co_return response;
}

std::unique_ptr<EventSource> Api::events(const HttpRequest& request) {
  const auto id = match(kRunEventsPath, request.path);
  const std::optional<std::int64_t> run_id =
      id ? std::optional(std::stoll(decode_segment(*id))) : std::nullopt;
  return std::make_unique<EventStream>(services_, run_id, request.last_event_id);
}

HeaderDecision Api::decide(const HttpRequest& header) const {
  const Role role = role_of(header, services_.tokens);
  HeaderDecision decision{.has_token = role == Role::kView || role == Role::kOperate};
  const auto outcome = admit(header, services_.tokens);
  if (const auto* admitted = std::get_if<Admitted>(&outcome)) {
    decision.takes_body = !is_stop(*admitted->route);
    decision.body_bytes_max = body_bytes_max(*admitted->route);
  }
  return decision;
}

bool Api::ignores_query(std::string_view method, std::string_view path) const {
  const Route* route = find_route(method, path);
  return route && is_stop(*route);
}

asio::awaitable<HttpResponse> Api::make_answer(const HttpRequest& request, const Admitted& admitted) {
  const DispatchMode dispatch = admitted.route->dispatch;
  if (dispatch == DispatchMode::kLongPoll) co_await wait_for_status(request, admitted);
  if (dispatch == DispatchMode::kPlanning) co_await wait_for_plan(request);
  if (dispatch == DispatchMode::kEvents && EventStream::open_count(services_) >= kEventStreamsMax)
    co_return busy("too many event streams are open; poll GET /api/v1/status", "15");
  if (dispatch != DispatchMode::kWorker) co_return handle(admitted, request, services_);
  HttpResponse response = co_await on_worker(request, admitted);
  co_return response;
}

/// A command: recorded before it is executed, its outcome afterwards.
asio::awaitable<HttpResponse> Api::execute_command(const HttpRequest& request, const Admitted& admitted) {
  HttpResponse response;
  if (is_stop(*admitted.route)) {
    response = handle(admitted, request, services_);
  } else if (!write_audit(request, "asked", true) && !halts_only(*admitted.route)) {
    response =
        to_response({.status = 503,
                     .kind = ProblemKind::kAudit,
                     .detail = "the command was refused because it cannot be recorded; free space on "
                               "the disk of the state directory. Stop, abort and pause are still executed"});
    co_return response;
  } else {
    response = co_await execute_command_once(request, admitted);
  }
  write_audit(request, std::to_string(response.status), false);
  co_return response;
}

/// With an Idempotency-Key a command is executed once; a refused one may be sent again with the same key.
asio::awaitable<HttpResponse> Api::execute_command_once(const HttpRequest& request,
                                                        const Admitted& admitted) {
  HttpResponse response;
  if (!request.idempotency_key) {
    response = co_await make_answer(request, admitted);
    co_return response;
  }
  const KeyedRequest keyed{.key = *request.idempotency_key,
                           .request = request.method + " " + request.path,
                           .body_digest = sha256_hex(request.body)};
  if (auto answered = answer_to_key(services_.answers, keyed, services_.operation.clocks().system(),
                                    halts_only(*admitted.route)))
    co_return *std::move(answered);
  response = co_await make_answer(request, admitted);
  if (response.status >= 300) {
    services_.answers.give_up(keyed);
    co_return response;
  }
  try {
    services_.answers.keep(
        keyed, {.status = response.status, .headers = response.headers, .body = response.body}, now_text());
  } catch (const std::exception& error) {
    services_.answers.give_up(keyed);
    spdlog::error("the answer to an Idempotency-Key could not be stored: {}", error.what());
  }
  co_return response;
}

std::string Api::now_text() const { return format_utc(services_.operation.clocks().system()); }

bool Api::write_audit(const HttpRequest& request, const std::string& outcome, bool at_once) {
  const Role role = role_of(request, services_.tokens);
  const AuditEntry entry{.at = now_text(),
                         .who = std::string(role_name(role)),
                         .remote = request.remote,
                         .action = (request.method + " " + request.path).substr(0, kActionBytesMax),
                         .outcome = outcome};
  try {
    append_audit(entry, role, at_once);
    return true;
  } catch (const std::exception& error) {
    spdlog::error("{} {} could not be recorded: {}", entry.action, outcome, error.what());
    return false;
  }
}

/// Strangers have a place and a rate of their own.
void Api::append_audit(const AuditEntry& entry, Role role, bool at_once) {
  if (role == Role::kNone || role == Role::kWrongToken) {
    const auto left_out = stranger_rate_.admit(services_.operation.clocks().steady());
    if (!left_out) return;
    AuditEntry counted = entry;
    if (*left_out > 0) counted.detail = std::to_string(*left_out) + " more before it were not recorded";
    services_.audit.append_of_stranger(counted);
  } else if (at_once) {
    services_.audit.append_command(entry);
  } else {
    services_.audit.append_refusal(entry);
  }
}

asio::awaitable<void> Api::delay_wrong_token(const HttpRequest& request) {
  if (!request.authorization) co_return;
  if (wrong_tokens_.size() >= kWrongAddressesMax) wrong_tokens_.clear();
  WrongTokens& wrong = wrong_tokens_[request.remote];
  const auto now = services_.operation.clocks().steady();
  if (now - wrong.latest > kWrongTokensKept) wrong.count = 0;
  wrong.latest = now;
  if (++wrong.count <= kWrongTokensFree) co_return;
  asio::steady_timer timer(executor_, 1s);
  co_await timer.async_wait(asio::use_awaitable);
}

asio::awaitable<void> Api::wait_for_status(const HttpRequest& request, const Admitted& admitted) {
  if (request.query.empty()) co_return;
  const Call call{request, services_, services_.operation, admitted.id, services_.operation.cell()};
  const auto wait_s = call.number("wait_s");
  const auto after = call.number("after");
  if (!wait_s || !after || services_.feed.waiting_count() >= kLongPollsMax) co_return;
  co_await services_.feed.wait(static_cast<std::uint64_t>(*after),
                               std::chrono::seconds(std::min(*wait_s, kWaitSecondsMax)));
}

asio::awaitable<void> Api::wait_for_plan(const HttpRequest& request) {
  const auto recipe = recipe_to_plan(request, services_.operation);
  if (!recipe) co_return;
  // Another request may wait for the same plan, which is made once.
  asio::steady_timer timer(executor_);
  while (services_.operation.is_planning()) {
    timer.expires_after(50ms);
    co_await timer.async_wait(asio::use_awaitable);
  }
  co_await services_.operation.plan_recipe(*recipe);
}

asio::awaitable<HttpResponse> Api::on_worker(const HttpRequest& request, const Admitted& admitted) {
  if (at_work_ >= kAtWorkMax) co_return busy("other documents are being identified; ask again", "2");
  ++at_work_;
  const Cell cell = services_.operation.cell();
  co_await asio::post(asio::bind_executor(worker_.get_executor(), asio::use_awaitable));
  HttpResponse response = handle(admitted, request, services_, cell);
  co_await asio::post(asio::bind_executor(executor_, asio::use_awaitable));
  --at_work_;
  co_return response;
}

}  // namespace cell
