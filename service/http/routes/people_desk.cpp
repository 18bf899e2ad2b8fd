#include "service/http/routes/internal/people_desk.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>
#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/digest.hpp"
#include "service/base/run_on.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/people_document.hpp"
#include "service/http/auth/secret_hash.hpp"
#include "service/http/auth/token_file.hpp"
#include "service/http/auth/wrong_tokens.hpp"
#include "service/http/routes/internal/people_body.hpp"
#include "service/http/routes/internal/refusals.hpp"
#include "service/http/routes/internal/user_routes.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

constexpr int kHashSeconds = 2;  // what is hashed before one more takes about so long

Problem wrong_secret() {
  return {.status = 401, .kind = ProblemKind::kSignIn, .detail = "the name or the secret is wrong"};
}

Problem too_often(std::string_view what, std::chrono::steady_clock::duration wait) {
  const auto seconds = static_cast<int>(std::chrono::ceil<std::chrono::seconds>(wait).count());
  return {.status = 429,
          .kind = ProblemKind::kSignIn,
          .detail = fmt::format("too many {}; try again in {} s", what, seconds),
          .retry_after_s = seconds};
}

Problem hashing_busy() {
  return {.status = 503,
          .kind = ProblemKind::kBusy,
          .detail = "others are signing in; try again",
          .retry_after_s = kHashSeconds};
}

Problem no_memory() {
  spdlog::error("a secret could not be hashed: {} MiB of memory were refused", kHashMemoryBytes >> 20);
  return {.status = 503,
          .kind = ProblemKind::kBusy,
          .detail = fmt::format("there is no memory for it now, {} MiB; try again. Where that goes on, free "
                                "memory of the machine, or raise the daemon's limit of address space",
                                kHashMemoryBytes >> 20),
          .retry_after_s = kHashSeconds};
}

/// It is written as soon as the disk takes it (UserKeeper::keep()): there is nothing to be sent again.
Problem not_kept() {
  return {.status = 503,
          .kind = ProblemKind::kNotKept,
          .detail =
              "it counts from now on, but the disk did not take it: free space on the disk of the state "
              "directory. The daemon writes it then by itself; if it is restarted before, it does not "
              "count any more"};
}

Problem not_written(const std::exception& error) {
  spdlog::error("users and sessions cannot be written: {}", error.what());
  return {.status = 503,
          .kind = ProblemKind::kAudit,
          .detail =
              "it cannot be written down, so that nothing was changed; free space on the disk of the "
              "state directory",
          .retry_after_s = kHashSeconds};
}

/// Whether who sends a request still may say who the users are, when it comes to that: it has waited for a
/// hash and the disk. `digest`: of its token.
bool is_still_engineer(const UserBook& book, const Caller& caller, const std::string& digest) {
  if (!caller.is_user) return true;
  const auto session = std::ranges::find(book.sessions, digest, &Session::token_digest);
  return session != book.sessions.end() && session->role == UserRole::kEngineer;
}

/// Whether the secret with this hash is the user's still.
bool is_still_theirs(const UserBook& book, const std::string& name, const std::string& hash) {
  const User* user = find_user(book, name);
  return user && user->secret_hash == hash;
}

Problem not_any_more() {
  return {.status = 401, .kind = ProblemKind::kSignIn, .detail = "the session has ended; sign in again"};
}

/// Refusals of who wants to change their own secret.
Problem only_who_is_signed_in(const Caller& caller) {
  return {.status = caller.may_operate() || caller.role == Role::kView ? 409U : 401U,
          .kind = ProblemKind::kSignIn,
          .detail = "only who is signed in has a secret to change; sign in"};
}

/// What becomes of a user who is to be put.
enum class PutOutcome { kDone, kEnded, kGone, kFull, kUnrecorded };

struct PutRequest {
  User user;
  bool keeps_secret = false;
  bool is_recorded = true;
};

/// On the store's thread. A role that is not raised, of somebody who is there, gives nothing: also with
/// another secret, which is of the same person.
PutOutcome put_into(UserBook& book, PutRequest asked, Effect& effect) {
  const User* there = find_user(book, asked.user.name);
  if (asked.keeps_secret && !there) return PutOutcome::kGone;  // somebody removed them meanwhile
  effect = there && asked.user.role <= there->role ? Effect::kTakes : Effect::kGives;
  // Nor does anybody get a secret unrecorded, with which another may act as they.
  if (!asked.is_recorded && (effect == Effect::kGives || !asked.keeps_secret)) return PutOutcome::kUnrecorded;
  if (asked.keeps_secret) asked.user.secret_hash = there->secret_hash;
  return put_user(book, std::move(asked.user)) ? PutOutcome::kDone : PutOutcome::kFull;
}

std::optional<Problem> why_not_put(PutOutcome outcome, const std::string& name) {
  switch (outcome) {
    case PutOutcome::kDone:
      return std::nullopt;
    case PutOutcome::kEnded:
      return not_any_more();
    case PutOutcome::kGone:
      return no_user(name);
    case PutOutcome::kFull:
      return Problem{.status = 409,
                     .kind = ProblemKind::kState,
                     .detail = fmt::format("there are {} users, and no more fit; remove one", kUsersMax)};
    case PutOutcome::kUnrecorded:
      return not_recorded();
  }
  return std::nullopt;
}

}  // namespace

PeopleDesk::PeopleDesk(asio::any_io_executor hashing, asio::any_io_executor store, Services& services,
                       std::function<void(const UserBook&)> take)
    : hashing_(std::move(hashing)), store_(std::move(store)), services_(services), take_(std::move(take)) {}

asio::awaitable<PersonAnswer> PeopleDesk::answer(const HttpRequest& request, const Route& route,
                                                 std::string_view id, bool is_recorded) {
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  try {
    answer = co_await answer_by_path(request, route, id, is_recorded);
  } catch (const std::exception& error) {
    spdlog::error("{} {} failed: {}", request.method, request.path, error.what());
    answer.response = to_response({.status = 500,
                                   .kind = ProblemKind::kInternal,
                                   .detail = "internal error; see the log of the daemon"});
  }
  co_return answer;
}

asio::awaitable<PersonAnswer> PeopleDesk::answer_by_path(const HttpRequest& request, const Route& route,
                                                         std::string_view id, bool is_recorded) {
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  if (route.path == kSignInPath) {
    answer = co_await sign_in(request);
  } else if (route.path == kSignOutPath) {
    answer = co_await sign_out(request);
  } else if (route.path == kOwnSecretPath) {
    answer = co_await change_own_secret(request);
  } else if (route.path == kUsersPath) {
    answer.response = co_await put(request, is_recorded);
  } else {
    answer.response = co_await remove(request, std::string(id));
  }
  co_return answer;
}

Caller PeopleDesk::caller(const HttpRequest& request) const { return caller_of(request, services_.tokens); }

asio::awaitable<PersonAnswer> PeopleDesk::sign_in(const HttpRequest& request) {
  const auto body = read_sign_in(request.body);
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  if (const auto* problem = std::get_if<Problem>(&body)) {
    answer.response = to_response(*problem);
    co_return answer;
  }
  const SignInBody& asked = std::get<SignInBody>(body);
  // A name that nobody has may be a secret in the wrong field: it is not recorded.
  if (find_user(services_.user_book, asked.name))
    answer.caller = {.role = Role::kWrongToken, .token_name = asked.name};
  std::string hash;
  auto refused = co_await why_not_theirs(request, {.name = asked.name, .secret = asked.secret}, hash);
  const std::string token = random_hex(kTokenBytes);
  const std::string digest = sha256_hex(token);
  if (!refused) {
    const auto now = services_.operation.clocks().system();
    refused = co_await write([&](UserBook& book) {
      if (is_still_theirs(book, asked.name, hash)) begin_session(book, asked.name, digest, now);
      return Effect::kGives;
    });
  }
  const auto& sessions = services_.user_book.sessions;
  const auto session = std::ranges::find(sessions, digest, &Session::token_digest);
  if (!refused && session == sessions.end()) refused = wrong_secret();  // changed meanwhile
  if (refused) {
    answer.response = to_response(*refused);
    co_return answer;
  }
  const std::string role(user_role_name(session->role));
  answer.response = json_response(
      201, document_text(SignedInDocument{
               .token = token, .name = session->user, .role = role, .ends_at = session->ends_at}));
  HttpRequest signed_in = request;
  signed_in.authorization = "Bearer " + token;
  answer.caller = caller(signed_in);
  co_return answer;
}

asio::awaitable<PersonAnswer> PeopleDesk::sign_out(const HttpRequest& request) {
  PersonAnswer answer{.response = session_answer(request, services_), .caller = caller(request)};
  if (!answer.caller.is_user) co_return answer;
  const std::string digest = token_digest_of(request);
  const auto refused = co_await write([&](UserBook& book) {
    end_session(book, digest);
    return Effect::kTakes;
  });
  answer.response = refused ? to_response(*refused) : session_answer(request, services_);
  co_return answer;
}

asio::awaitable<PersonAnswer> PeopleDesk::change_own_secret(const HttpRequest& request) {
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  const auto refused = co_await why_own_secret_stays(request, answer.caller);
  answer.response = refused ? to_response(*refused) : session_answer(request, services_);
  co_return answer;
}

/// Nothing where the secret is another one now.
asio::awaitable<std::optional<Problem>> PeopleDesk::why_own_secret_stays(const HttpRequest& request,
                                                                         const Caller& caller) {
  const auto body = read_secret_change(request.body);
  if (const auto* problem = std::get_if<Problem>(&body)) co_return *problem;
  if (!caller.is_user || caller.role == Role::kOverSession) co_return only_who_is_signed_in(caller);
  const std::string& name = caller.token_name;
  const SecretChange& asked = std::get<SecretChange>(body);
  if (const auto why = why_no_secret(asked.new_secret, name))
    co_return Problem{.kind = ProblemKind::kBody, .detail = *why, .pointer = "/new_secret"};
  std::string old_hash;
  const Tried tried{.name = name, .secret = asked.secret, .is_by_token = true};
  auto refused = co_await why_not_theirs(request, tried, old_hash);
  if (refused) co_return refused;
  std::string hash;
  refused = co_await hash_new(asked.new_secret, hash);
  if (refused) co_return refused;
  const std::string digest = token_digest_of(request);
  bool is_changed = false;
  refused = co_await write([&](UserBook& book) {
    const bool is_signed_in =
        std::ranges::find(book.sessions, digest, &Session::token_digest) != book.sessions.end();
    is_changed = is_signed_in && is_still_theirs(book, name, old_hash);
    if (is_changed) change_secret(book, name, hash, digest);
    return Effect::kTakes;
  });
  if (!refused && !is_changed) refused = not_any_more();
  co_return refused;
}

asio::awaitable<HttpResponse> PeopleDesk::put(const HttpRequest& request, bool is_recorded) {
  const auto body = read_user_request(request.body);
  if (const auto* problem = std::get_if<Problem>(&body)) co_return to_response(*problem);
  const UserRequest& asked = std::get<UserRequest>(body);
  if (!asked.secret && !find_user(services_.user_book, asked.name))
    co_return to_response({.kind = ProblemKind::kBody,
                           .detail = "is missing; a new user needs a PIN or a passphrase",
                           .pointer = "/secret"});
  const Caller by = caller(request);
  const std::string by_digest = token_digest_of(request);
  PutRequest to_put{.user = {.name = asked.name,
                             .role = asked.role,
                             .created_at = format_utc(services_.operation.clocks().system())},
                    .keeps_secret = !asked.secret,
                    .is_recorded = is_recorded};
  if (!by.token_name.empty()) to_put.user.created_by = by.token_name;
  if (asked.secret) {
    const auto not_hashed = co_await hash_new(*asked.secret, to_put.user.secret_hash);
    if (not_hashed) co_return to_response(*not_hashed);
  }
  PutOutcome outcome = PutOutcome::kEnded;
  auto refused = co_await write([&](UserBook& book) {
    Effect effect = Effect::kTakes;
    if (is_still_engineer(book, by, by_digest)) outcome = put_into(book, to_put, effect);
    return effect;
  });
  if (!refused) refused = why_not_put(outcome, asked.name);
  if (refused) co_return to_response(*refused);
  co_return users_answer(201, services_);
}

asio::awaitable<HttpResponse> PeopleDesk::remove(const HttpRequest& request, const std::string& name) {
  const Caller by = caller(request);
  const std::string by_digest = token_digest_of(request);
  bool may_still = false;
  bool was_there = false;
  auto refused = co_await write([&](UserBook& book) {
    may_still = is_still_engineer(book, by, by_digest);
    was_there = may_still && remove_user(book, name);
    return Effect::kTakes;
  });
  if (!refused && !may_still) refused = not_any_more();
  if (!refused && !was_there) refused = no_user(name);
  if (refused) co_return to_response(*refused);
  co_return users_answer(200, services_);
}

/// Nothing where the secret is the user's; `hash` is that of it then. Each guess counts until it has shown to
/// be right, or that nothing was compared.
asio::awaitable<std::optional<Problem>> PeopleDesk::why_not_theirs(const HttpRequest& request, Tried tried,
                                                                   std::string& hash) {
  const std::string network = network_of(request.remote);
  const SecretGuesses::Guess guess{.network = network, .name = tried.name, .is_known = tried.is_by_token};
  const auto now = services_.operation.clocks().steady();
  if (const auto wait = guesses_.wait_of_name(guess, now); wait > wait.zero())
    co_return too_often("wrong secrets for this name", wait);
  if (const auto wait = guesses_.wait_of_network(guess, now); wait > wait.zero())
    co_return too_often("names are tried from this network", wait);
  const auto place = tried.is_by_token ? places_.take_by_token() : places_.take_as_stranger(network);
  if (!place) co_return hashing_busy();
  const auto begun = guesses_.begin(guess, now);
  const User* user = find_user(services_.user_book, tried.name);
  hash = user ? user->secret_hash : std::string();
  const std::string& to_compare = user ? hash : hash_of_nobody();
  bool is_compared = true;
  bool is_theirs = false;
  co_await run_on(hashing_, [&] {
    try {
      is_theirs = is_secret_of(to_compare, tried.secret);
    } catch (const std::bad_alloc&) {
      is_compared = false;
    }
  });
  if (!is_compared) {
    guesses_.was_none(begun);
    co_return no_memory();
  }
  if (!is_theirs || !is_still_theirs(services_.user_book, tried.name, hash)) co_return wrong_secret();
  guesses_.was_right(begun);
  co_return std::nullopt;
}

/// Nothing where `hash` is that of the secret. For who shows a token that counts.
asio::awaitable<std::optional<Problem>> PeopleDesk::hash_new(const std::string& secret, std::string& hash) {
  const auto place = places_.take_by_token();
  if (!place) co_return hashing_busy();
  bool is_hashed = true;
  co_await run_on(hashing_, [&] {
    try {
      hash = hash_secret(secret);
    } catch (const std::bad_alloc&) {
      is_hashed = false;
    }
  });
  if (!is_hashed) co_return no_memory();
  co_return std::nullopt;
}

asio::awaitable<std::optional<Problem>> PeopleDesk::write(const std::function<Effect(UserBook&)>& change) {
  std::optional<Problem> refused;
  const UserBook book = co_await run_on(store_, [&] {
    try {
      if (!services_.users.change(change)) refused = not_kept();
    } catch (const std::exception& error) {
      refused = not_written(error);
    }
    return services_.users.book();
  });
  take_(book);
  co_return refused;
}

}  // namespace cell
