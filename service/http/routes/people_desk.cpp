#include "service/http/routes/internal/people_desk.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
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
#include "service/http/routes/internal/user_routes.hpp"
#include "service/http/routes/internal/waiting.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

constexpr int kHashSeconds = 2;  // what is hashed before one more takes about so long

Problem wrong_secret() {
  return {.status = 401, .kind = ProblemKind::kSignIn, .detail = "the name or the secret is wrong"};
}

Problem too_often(std::chrono::steady_clock::duration wait) {
  const auto seconds = static_cast<int>(std::chrono::ceil<std::chrono::seconds>(wait).count());
  return {.status = 429,
          .kind = ProblemKind::kSignIn,
          .detail = fmt::format("too many wrong secrets for this name; try again in {} s", seconds),
          .retry_after_s = seconds};
}

Problem hashing_busy() {
  return {.status = 503,
          .kind = ProblemKind::kBusy,
          .detail = "others are signing in; try again",
          .retry_after_s = kHashSeconds};
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

/// Guesses for one name from one network: nobody elsewhere is held up by them.
std::string guess_key(const HttpRequest& request, const std::string& name) {
  return network_of(request.remote) + '\n' + name;
}

}  // namespace

PeopleDesk::PeopleDesk(asio::any_io_executor hashing, asio::any_io_executor store, Services& services,
                       std::function<void(const UserBook&)> take)
    : hashing_(std::move(hashing)), store_(std::move(store)), services_(services), take_(std::move(take)) {}

asio::awaitable<PersonAnswer> PeopleDesk::answer(const HttpRequest& request, const Route& route,
                                                 std::string_view id) {
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  if (route.path == kSignInPath) {
    answer = co_await sign_in(request);
  } else if (route.path == kSignOutPath) {
    answer = co_await sign_out(request);
  } else if (route.path == kOwnSecretPath) {
    answer = co_await change_own_secret(request);
  } else if (route.path == kUsersPath) {
    answer.response = co_await put(request);
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
  auto refused = co_await why_not_theirs(request, asked.name, asked.secret, hash);
  const std::string token = random_hex(kTokenBytes);
  const std::string digest = sha256_hex(token);
  if (!refused) {
    const auto now = services_.operation.clocks().system();
    refused = co_await write([&](UserBook& book) {
      if (is_still_theirs(book, asked.name, hash)) begin_session(book, asked.name, digest, now);
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
  const auto refused = co_await write([&](UserBook& book) { end_session(book, digest); });
  answer.response = refused ? to_response(*refused) : session_answer(request, services_);
  co_return answer;
}

asio::awaitable<PersonAnswer> PeopleDesk::change_own_secret(const HttpRequest& request) {
  const auto body = read_secret_change(request.body);
  PersonAnswer answer{.response = {}, .caller = caller(request)};
  std::optional<Problem> refused;
  if (const auto* problem = std::get_if<Problem>(&body)) {
    refused = *problem;
  } else if (!answer.caller.is_user || answer.caller.role == Role::kOverSession) {
    refused =
        Problem{.status = answer.caller.may_operate() || answer.caller.role == Role::kView ? 409U : 401U,
                .kind = ProblemKind::kSignIn,
                .detail = "only who is signed in has a secret to change; sign in"};
  } else {
    const std::string& name = answer.caller.token_name;
    const SecretChange& asked = std::get<SecretChange>(body);
    if (const auto why = why_no_secret(asked.new_secret, name))
      refused = Problem{.kind = ProblemKind::kBody, .detail = *why, .pointer = "/new_secret"};
    std::string old_hash;
    if (!refused) refused = co_await why_not_theirs(request, name, asked.secret, old_hash);
    if (!refused) {
      const std::string hash = co_await hashed(asked.new_secret);
      const std::string digest = token_digest_of(request);
      bool is_changed = false;
      refused = co_await write([&](UserBook& book) {
        const bool is_signed_in =
            std::ranges::find(book.sessions, digest, &Session::token_digest) != book.sessions.end();
        is_changed = is_signed_in && is_still_theirs(book, name, old_hash);
        if (is_changed) change_secret(book, name, hash, digest);
      });
      if (!refused && !is_changed) refused = not_any_more();
    }
  }
  answer.response = refused ? to_response(*refused) : session_answer(request, services_);
  co_return answer;
}

asio::awaitable<HttpResponse> PeopleDesk::put(const HttpRequest& request) {
  const auto body = read_user_request(request.body);
  if (const auto* problem = std::get_if<Problem>(&body)) co_return to_response(*problem);
  const UserRequest& asked = std::get<UserRequest>(body);
  const User* known = find_user(services_.user_book, asked.name);
  if (!known && !asked.secret)
    co_return to_response({.kind = ProblemKind::kBody,
                           .detail = "is missing; a new user needs a PIN or a passphrase",
                           .pointer = "/secret"});
  if (asked.secret && at_once_ >= kAtOnceMax) co_return to_response(hashing_busy());
  const Caller by = caller(request);
  const std::string by_digest = token_digest_of(request);
  const std::string& maker = by.token_name;
  User user{.name = asked.name,
            .role = asked.role,
            .created_at = format_utc(services_.operation.clocks().system())};
  if (!maker.empty()) user.created_by = maker;
  if (asked.secret) user.secret_hash = co_await hashed(*asked.secret);
  bool is_full = false;
  bool is_gone = false;
  bool may_still = false;
  auto refused = co_await write([&](UserBook& book) {
    may_still = is_still_engineer(book, by, by_digest);
    if (!may_still) return;
    const User* there = find_user(book, user.name);
    if (!asked.secret && there) user.secret_hash = there->secret_hash;
    is_gone = !asked.secret && !there;  // somebody removed them meanwhile
    is_full = !is_gone && !put_user(book, user);
  });
  if (!refused && !may_still) refused = not_any_more();
  if (is_gone) refused = no_user(asked.name);
  if (is_full)
    refused = Problem{.status = 409,
                      .kind = ProblemKind::kState,
                      .detail = fmt::format("there are {} users, and no more fit; remove one", kUsersMax)};
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
  });
  if (!refused && !may_still) refused = not_any_more();
  if (!refused && !was_there) refused = no_user(name);
  if (refused) co_return to_response(*refused);
  co_return users_answer(200, services_);
}

/// Nothing where the secret is the user's; `hash` is that of it then. Each guess counts until it has shown to
/// be right.
asio::awaitable<std::optional<Problem>> PeopleDesk::why_not_theirs(const HttpRequest& request,
                                                                   const std::string& name,
                                                                   const std::string& secret,
                                                                   std::string& hash) {
  const std::string key = guess_key(request, name);
  const auto now = services_.operation.clocks().steady();
  if (const auto wait = wrong_secrets_.wait(key, now); wait > wait.zero()) co_return too_often(wait);
  if (at_once_ >= kAtOnceMax) co_return hashing_busy();
  wrong_secrets_.add(key, now);
  const User* user = find_user(services_.user_book, name);
  hash = user ? user->secret_hash : std::string();
  bool is_theirs = false;
  {
    const Waiting waiting(at_once_);
    is_theirs = co_await run_on(hashing_,
                                [&] { return is_secret_of(hash.empty() ? hash_of_nobody() : hash, secret); });
  }
  if (!is_theirs || !is_still_theirs(services_.user_book, name, hash)) co_return wrong_secret();
  wrong_secrets_.forgive(key);
  co_return std::nullopt;
}

asio::awaitable<std::string> PeopleDesk::hashed(const std::string& secret) {
  const Waiting waiting(at_once_);
  std::string hash = co_await run_on(hashing_, [&] { return hash_secret(secret); });
  co_return hash;
}

asio::awaitable<std::optional<Problem>> PeopleDesk::write(const std::function<void(UserBook&)>& change) {
  std::optional<Problem> refused;
  const UserBook book = co_await run_on(store_, [&] {
    try {
      return services_.users.change(change);
    } catch (const std::exception& error) {
      refused = not_written(error);
      return services_.users.book();
    }
  });
  take_(book);
  co_return refused;
}

}  // namespace cell
