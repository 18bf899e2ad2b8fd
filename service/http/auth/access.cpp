#include "service/http/auth/access.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/base/digest.hpp"
#include "service/base/state_directory.hpp"
#include "service/http/server/problem.hpp"

namespace cell {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view token_of(const HttpRequest& request) {
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view sent =
      request.authorization ? std::string_view(*request.authorization) : std::string_view();
  // The name of a scheme is case-insensitive (RFC 9110, 11.1).
  return std::ranges::equal(sent.substr(0, kScheme.size()), kScheme, {}, lower, lower)
             ? sent.substr(kScheme.size())
             : std::string_view();
}

Role role_of_user(UserRole role) {
  switch (role) {
    case UserRole::kView:
      return Role::kView;
    case UserRole::kOperate:
      return Role::kOperate;
    case UserRole::kEngineer:
      return Role::kEngineer;
  }
  return Role::kNone;
}

bool may(const Caller& caller, Access access) {
  switch (access) {
    case Access::kOpen:
      return true;
    case Access::kStop:
      return caller.may_operate() || caller.is_user;
    case Access::kView:
      return caller.may_operate() || caller.role == Role::kView;
    case Access::kOperate:
      return caller.may_operate();
    case Access::kEngineer:
      return caller.may_engineer();
  }
  return false;
}

/// Of a caller who is known and may not do this.
HttpResponse refuse_role(const Caller& caller, Access access) {
  std::string detail = "the view token may only read";
  if (caller.is_user && access == Access::kEngineer)
    detail = fmt::format("'{}' has the role {}, and this takes an engineer; sign in as one",
                         caller.token_name, role_name(caller.role));
  else if (caller.is_user)
    detail = fmt::format("'{}' has the role {}: it may look and stop; sign in as an operator or an engineer",
                         caller.token_name, role_name(caller.role));
  return to_response({.status = 403, .kind = ProblemKind::kRole, .detail = std::move(detail)});
}

std::string how_to_be_known(const Caller& caller, Access access, const Tokens& tokens) {
  if (caller.role == Role::kOverSession)
    return fmt::format("the session of '{}' is over: it may stop the arm, and nothing else; sign in again",
                       caller.token_name);
  return fmt::format(
      "send 'Authorization: Bearer TOKEN'; the token stands in {} in the daemon's state directory{}",
      access == Access::kView ? kViewTokenFile : kOperateTokenFile,
      tokens.sessions.empty() ? "" : ", or POST /api/v1/sign-in gives one");
}

}  // namespace

std::string_view role_name(Role role) {
  switch (role) {
    case Role::kNone:
      return "none";
    case Role::kWrongToken:
      return "wrong token";
    case Role::kOverSession:
      return "session over";
    case Role::kView:
      return "view";
    case Role::kOperate:
      return "operate";
    case Role::kEngineer:
      return "engineer";
  }
  return "";
}

TokenRank token_rank(Role role) {
  switch (role) {
    case Role::kNone:
    case Role::kWrongToken:
      return TokenRank::kNone;
    case Role::kOverSession:
    case Role::kView:
      return TokenRank::kView;
    case Role::kOperate:
    case Role::kEngineer:
      return TokenRank::kOperate;
  }
  return TokenRank::kNone;
}

/// Each token is compared, whichever it is: the time does not tell which of them a guess came near.
Caller caller_of(const HttpRequest& request, const Tokens& tokens) {
  const std::string_view token = token_of(request);
  Caller caller{.role = request.authorization ? Role::kWrongToken : Role::kNone};
  if (same_token(tokens.view, token)) caller = {.role = Role::kView};
  for (const NamedToken& named : tokens.operators)
    if (same_token(named.token, token)) caller = {.role = Role::kOperate, .token_name = named.name};
  if (same_token(tokens.operate, token)) caller = {.role = Role::kOperate};
  if (caller.role != Role::kWrongToken || token.empty()) return caller;
  const std::string digest = token_digest_of(request);
  const auto session = std::ranges::find(tokens.sessions, digest, &Session::token_digest);
  if (session == tokens.sessions.end()) return caller;
  return {.role = session->is_over ? Role::kOverSession : role_of_user(session->role),
          .token_name = session->user,
          .is_user = true};
}

std::string token_digest_of(const HttpRequest& request) {
  const std::string_view token = token_of(request);
  return token.empty() ? std::string() : sha256_hex(std::string(token));
}

Role role_of(const HttpRequest& request, const Tokens& tokens) { return caller_of(request, tokens).role; }

bool shows_token(const HttpRequest& request, const Tokens& tokens) {
  const Role role = role_of(request, tokens);
  return role == Role::kView || role == Role::kOperate || role == Role::kEngineer;
}

std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens) {
  if (access == Access::kOpen || (access == Access::kView && request.from_loopback)) return std::nullopt;
  const Caller caller = caller_of(request, tokens);
  if (may(caller, access)) return std::nullopt;
  if (may(caller, Access::kView)) return refuse_role(caller, access);
  HttpResponse response = to_response(
      {.status = 401, .kind = ProblemKind::kToken, .detail = how_to_be_known(caller, access, tokens)});
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"touchcal\"");
  return response;
}

std::optional<HttpResponse> refuse_content_type(const HttpRequest& request) {
  if (request.body.empty() && !request.announces_body) return std::nullopt;
  const std::string_view type =
      request.content_type ? std::string_view(*request.content_type) : std::string_view();
  if (std::ranges::equal(type.substr(0, type.find_first_of("; \t")), std::string_view("application/json"), {},
                         lower)) {
    return std::nullopt;
  }
  return to_response(
      {.status = 415, .kind = ProblemKind::kContentType, .detail = "a body must be application/json"});
}

}  // namespace cell
