#include "service/http/routes/api.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/digest.hpp"
#include "service/base/run_on.hpp"
#include "service/base/state_directory.hpp"
#include "service/base/utc_time.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/internal/desk.hpp"
#include "service/http/routes/internal/event_stream.hpp"
#include "service/http/routes/internal/people_desk.hpp"
#include "service/http/routes/internal/plan_routes.hpp"
#include "service/http/routes/internal/refusals.hpp"
#include "service/http/routes/internal/waiting.hpp"
#include "service/http/server/target.hpp"
#include "service/store/damaged_store.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Longest wait of a long poll; at most so many at once.
constexpr std::int64_t kWaitSecondsMax = 60;
constexpr std::size_t kLongPollsMax = 128;
/// Requests at a desk and queued for it. One more is told that the daemon is busy (503).
constexpr int kAtReaderMax = 64;
constexpr int kAtWorkerMax = 4;
constexpr int kAtArchiveMax = 16;
/// Commands that wait for the store. None of them may be a stop, a pause or an abort.
constexpr int kAtStoreMax = 16;
/// How much later a wrong token is answered whose network has guessed too often.
constexpr auto kWrongTokenDelay = 1s;

constexpr int kRetrySeconds = 2;  // what is waited for behind a full queue takes about so long

HttpResponse busy(std::string detail, int retry_after_s = kRetrySeconds) {
  return to_response({.status = 503,
                      .kind = ProblemKind::kBusy,
                      .detail = std::move(detail),
                      .retry_after_s = retry_after_s});
}

bool is_command(const HttpRequest& request) { return request.method != "GET"; }

/// What people do about themselves. It is recorded when it is known who they are.
bool is_of_person(const Admitted& admitted) {
  return admitted.route->dispatch == DispatchMode::kPeople && admitted.route->access == Access::kOpen;
}

/// The stored answer to a key, or its refusal; nothing for a new key.
std::optional<HttpResponse> answer_to_key(Services& services, const KeyedRequest& keyed) {
  const auto now = services.operation.clocks().system();
  KeyLookUp found;
  try {
    found = services.answers.take(keyed, format_utc(now - std::chrono::hours(AnswerStore::kKeptHours)));
  } catch (const DamagedStore& damage) {
    spdlog::error("Idempotency-Keys cannot be looked up: {}", damage.what());
    services.metrics.count_internal_error();
    return to_response({.status = 503, .kind = ProblemKind::kDamaged, .detail = damage.what()});
  } catch (const std::exception& error) {
    spdlog::error("Idempotency-Keys cannot be looked up: {}", error.what());
    return to_response({.status = 503,
                        .kind = ProblemKind::kIdempotencyKey,
                        .detail = "earlier answers cannot be read; see the log",
                        .retry_after_s = kRetrySeconds});
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

Api::Api(asio::any_io_executor executor, ApiThreads threads, CellOperation& operation, Tokens tokens)
    : executor_(executor),
      threads_(std::move(threads)),
      services_(operation, std::move(tokens), operation.store().file()),
      audit_(threads_.store, services_),
      reads_of_store_(operation, operation.store().file()),
      reader_(std::make_unique<Desk>(threads_.reader, operation, kAtReaderMax,
                                     "other runs are being read; ask again")),
      worker_(std::make_unique<Desk>(threads_.worker, operation, kAtWorkerMax,
                                     "other documents are being identified; ask again")),
      secrets_(std::make_unique<Desk>(threads_.worker, operation, HashPlaces::kMost, "")),
      archive_(std::make_unique<Desk>(boost::asio::any_io_executor(), operation, kAtArchiveMax,
                                      "others wait for the archive; ask again")),
      people_(std::make_unique<PeopleDesk>(secrets_->executor, threads_.store, services_,
                                           [this](const UserBook& book) { take_users(book); })) {
  take_users(services_.users.book());
  services_.feed.follow([this](const Status& status) { services_.metrics.follow(status); }, executor);
}

Api::Api(asio::any_io_executor executor, CellOperation& operation, Tokens tokens)
    : Api(executor, {.operation = executor, .store = executor}, operation, std::move(tokens)) {}

Api::~Api() = default;

void Api::end_desks() {
  for (Desk* desk : {reader_.get(), worker_.get(), secrets_.get(), archive_.get()}) desk->end();
}

Services::Services(CellOperation& to_serve, Tokens to_ask_for,
                   const std::optional<std::filesystem::path>& store_file)
    : operation(to_serve),
      tokens(std::move(to_ask_for)),
      feed(to_serve),
      reads(store_file ? Reads(to_serve, *store_file) : Reads(to_serve)),
      answers(to_serve.store().database()),
      audit(to_serve.store().database()),
      models(to_serve.store().database()),
      imports(to_serve.store().database()),
      users(store_file ? std::optional(store_file->parent_path() / kUserFile) : std::nullopt) {}

HttpResponse Api::refuse(const Problem& problem, const HttpRequest& request) {
  services_.metrics.count_request("", "", problem.status);
  HttpResponse response = to_response(problem);
  if (is_command(request))
    audit_.record(request, caller_of(request, services_.tokens), nullptr, problem.status);
  return response;
}

asio::awaitable<HttpResponse> Api::answer(const HttpRequest& request) {
  const Caller caller = caller_of(request, services_.tokens);  // they may be others at its end
  const auto outcome = admit(request, services_.tokens);
  if (const auto* refused = std::get_if<HttpResponse>(&outcome)) {
    if (is_command(request)) audit_.record(request, caller, nullptr, refused->status);
    if (refused->status == 401 && request.authorization) co_await delay_guess(request);
    services_.metrics.count_request("", "", refused->status);
    co_return *refused;
  }
  const Admitted& admitted = std::get<Admitted>(outcome);
  HttpResponse response;
  if (is_of_person(admitted)) {
    PersonAnswer answered = co_await people_->answer(request, *admitted.route, admitted.id);
    audit_.record(request, answered.caller, nullptr, answered.response.status, true);
    if (answered.response.status == 401) co_await delay_guess(request);
    response = std::move(answered.response);
  } else if (is_command(request) && !admitted.route->asks_only) {
    response = co_await execute_command(request, caller, admitted);
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
  return std::make_unique<EventStream>(services_, run_id, request,
                                       [this](std::int64_t of) { return read_run(of); });
}

HeaderDecision Api::decide(const HttpRequest& header) const {
  HeaderDecision decision{.token = token_rank(role_of(header, services_.tokens))};
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
  if (dispatch == DispatchMode::kLongPoll) {
    co_await wait_for_status(request);
    // Its token may have been withdrawn meanwhile.
    if (auto refused = refuse_access(request, admitted.route->access, services_.tokens)) co_return *refused;
  }
  if (dispatch == DispatchMode::kPlanning)
    co_await asio::co_spawn(threads_.operation, wait_for_plan(request), asio::use_awaitable);
  if (dispatch == DispatchMode::kEvents && EventStream::open_count(services_) >= kEventStreamsMax)
    co_return busy("too many event streams are open; poll GET /api/v1/status", 15);
  if (dispatch == DispatchMode::kWritten) {
    HttpResponse response = co_await run_on(threads_.store, [&] {
      const Asked nothing;
      reads_of_store_.update();
      return handle(admitted, request, services_, reads_of_store_, nothing);
    });
    co_return response;
  }
  const Asked asked = co_await ask(request, admitted);
  if (Desk* desk = desk_for(admitted, asked)) {
    HttpResponse response = co_await at_desk(*desk, request, admitted, asked);
    co_return response;
  }
  services_.reads.update();
  co_return handle(admitted, request, services_, services_.reads, asked);
}

/// What the operation says to it, and the start that may follow.
asio::awaitable<Asked> Api::ask(const HttpRequest& request, const Admitted& admitted) {
  Asked asked;
  if (admitted.route->ask)
    asked = co_await run_on(threads_.operation, [&] { return ask_operation(admitted, request, services_); });
  if (asked.to_start)
    asked = co_await asio::co_spawn(threads_.operation, answer_start(services_.operation, *asked.to_start),
                                    asio::use_awaitable);
  if (asked.is_storing)
    co_await asio::co_spawn(threads_.operation, services_.operation.touch_stored(), asio::use_awaitable);
  co_return asked;
}

/// Where a request is answered whose answer needs the disk: one that hangs must not hold the thread that
/// serves, and with it a stop. Null: here.
Api::Desk* Api::desk_for(const Admitted& admitted, const Asked& asked) {
  const DispatchMode dispatch = admitted.route->dispatch;
  if (dispatch == DispatchMode::kWorker) return worker_.get();
  if (dispatch == DispatchMode::kArchive) return archive_.get();
  const bool is_of_one_run = dispatch == DispatchMode::kEvents && !admitted.id.empty();
  const bool reads_store = dispatch == DispatchMode::kStored || is_of_one_run || asked.needs_store;
  return reads_store ? reader_.get() : nullptr;
}

/// A command: recorded before it is executed, its outcome afterwards. One that halts is recorded afterwards
/// only: it never waits for the database to record it. What a person may is taken from them also where that
/// cannot be recorded; of a body with a secret no digest is kept, and no answer to a key.
asio::awaitable<HttpResponse> Api::execute_command(const HttpRequest& request, const Caller& caller,
                                                   const Admitted& admitted) {
  HttpResponse response;
  const bool halts = halts_only(*admitted.route);
  if (is_stop(*admitted.route)) {
    response = co_await make_answer(request, admitted);
  } else {
    if (!halts && at_store_ >= kAtStoreMax) co_return busy("the disk does not answer; ask again");
    const Waiting waiting(at_store_);
    bool is_recorded = halts;
    if (!is_recorded) is_recorded = co_await audit_.record_asked(request, caller, admitted.start.get());
    if (admitted.route->dispatch == DispatchMode::kPeople) {
      PersonAnswer answered = co_await people_->answer(request, *admitted.route, admitted.id, is_recorded);
      response = std::move(answered.response);
    } else if (!is_recorded) {
      co_return to_response(not_recorded());
    } else {
      response = co_await execute_command_once(request, admitted);
    }
  }
  audit_.record(request, caller, admitted.start.get(), response.status, halts && !is_stop(*admitted.route));
  co_return response;
}

/// With an Idempotency-Key a command is executed once; a refused one may be sent again with the same key.
asio::awaitable<HttpResponse> Api::execute_command_once(const HttpRequest& request,
                                                        const Admitted& admitted) {
  HttpResponse response;
  // What halts does the same each time, and waits for no disk.
  if (!request.idempotency_key || halts_only(*admitted.route)) {
    response = co_await make_answer(request, admitted);
    co_return response;
  }
  const KeyedRequest keyed{.key = *request.idempotency_key,
                           .request = request.method + " " + request.path,
                           .body_digest = sha256_hex(request.body)};
  auto answered = co_await run_on(threads_.store, [&] { return answer_to_key(services_, keyed); });
  if (answered) co_return *std::move(answered);
  response = co_await make_answer(request, admitted);
  co_await run_on(threads_.store, [&] {
    if (response.status >= 300) {
      services_.answers.give_up(keyed);
      return;
    }
    try {
      services_.answers.keep(
          keyed, {.status = response.status, .headers = response.headers, .body = response.body}, now_text());
    } catch (const std::exception& error) {
      services_.answers.give_up(keyed);
      spdlog::error("the answer to an Idempotency-Key could not be stored: {}", error.what());
    }
  });
  co_return response;
}

std::string Api::now_text() const { return format_utc(services_.operation.clocks().system()); }

/// Of a wrong token or secret, whoever's: there are many names to try.
asio::awaitable<void> Api::delay_guess(const HttpRequest& request) {
  if (!wrong_tokens_.is_too_often(request.remote, services_.operation.clocks().steady())) co_return;
  asio::steady_timer timer(executor_, kWrongTokenDelay);
  co_await timer.async_wait(asio::use_awaitable);
}

asio::awaitable<void> Api::wait_for_status(const HttpRequest& request) {
  if (request.query.empty()) co_return;
  const Asked nothing;
  const Call call{request, services_, "", services_.reads, nothing};
  const auto wait_s = call.number("wait_s");
  const auto after = call.number("after");
  if (!wait_s || !after || services_.feed.waiting_count() >= kLongPollsMax) co_return;
  const auto sequence = static_cast<std::uint64_t>(*after);
  const auto end =
      services_.operation.clocks().steady() + std::chrono::seconds(std::min(*wait_s, kWaitSecondsMax));
  for (;;) {
    const auto left = end - services_.operation.clocks().steady();
    if (services_.feed.newest().sequence != sequence || left <= std::chrono::seconds::zero()) co_return;
    co_await services_.feed.wait(sequence, std::chrono::ceil<std::chrono::milliseconds>(left));
    // Woken without a change: tokens have changed, this one's perhaps.
    if (refuse_access(request, Access::kView, services_.tokens)) co_return;
  }
}

/// On the operation's thread.
asio::awaitable<void> Api::wait_for_plan(const HttpRequest& request) {
  const auto recipe = recipe_to_plan(request, services_.operation);
  if (!recipe) co_return;
  // Another request may wait for the same plan, which is made once.
  asio::steady_timer timer(co_await asio::this_coro::executor);
  while (services_.operation.is_planning()) {
    timer.expires_after(50ms);
    co_await timer.async_wait(asio::use_awaitable);
  }
  co_await services_.operation.plan_recipe(*recipe);
}

/// A copy of the run under way if the request is about its result; its document is made elsewhere.
asio::awaitable<std::shared_ptr<const ActiveRun>> Api::live_run(const Admitted& admitted) {
  std::shared_ptr<const ActiveRun> copy;
  const auto run_id = services_.feed.newest().run_id;
  if (!admitted.route->tells_result || !run_id || admitted.id != std::to_string(*run_id)) co_return copy;
  copy = co_await run_on(threads_.operation, [&] {
    const ActiveRun* run = services_.operation.active_run();
    return run ? std::make_shared<const ActiveRun>(*run) : nullptr;
  });
  co_return copy;
}

asio::awaitable<HttpResponse> Api::at_desk(Desk& desk, const HttpRequest& request, const Admitted& admitted,
                                           const Asked& asked) {
  if (desk.waiting >= desk.waiting_max) co_return busy(desk.when_full);
  const Waiting waiting(desk.waiting);
  const std::shared_ptr<const ActiveRun> live = co_await live_run(admitted);
  HttpResponse response = co_await run_on(desk.executor, [&] {
    desk.reads.update(live);
    return handle(admitted, request, services_, desk.reads, asked);
  });
  co_return response;
}

/// Not bounded by what waits at the desk: kEventStreamsMax bounds it.
asio::awaitable<std::optional<StoredRun>> Api::read_run(std::int64_t id) {
  auto run = co_await run_on(reader_->executor, [&] { return reader_->reads.store().run(id); });
  co_return run;
}

}  // namespace cell
