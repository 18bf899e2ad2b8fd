#include "service/http/auth/access.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

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

}  // namespace

std::string_view role_name(Role role) {
  switch (role) {
    case Role::kNone:
      return "none";
    case Role::kWrongToken:
      return "wrong token";
    case Role::kView:
      return "view";
    case Role::kOperate:
      return "operate";
  }
  return "";
}

TokenRank token_rank(Role role) {
  switch (role) {
    case Role::kNone:
    case Role::kWrongToken:
      return TokenRank::kNone;
    case Role::kView:
      return TokenRank::kView;
    case Role::kOperate:
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
  return caller;
}

Role role_of(const HttpRequest& request, const Tokens& tokens) { return caller_of(request, tokens).role; }

bool shows_token(const HttpRequest& request, const Tokens& tokens) {
  const Role role = role_of(request, tokens);
  return role == Role::kView || role == Role::kOperate;
}

std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens) {
  if (access == Access::kOpen || (access == Access::kView && request.from_loopback)) return std::nullopt;
  const Role role = role_of(request, tokens);
  if (role == Role::kOperate) return std::nullopt;
  if (role == Role::kView) {
    if (access == Access::kView) return std::nullopt;
    return to_response({.status = 403, .kind = ProblemKind::kRole, .detail = "the view token may only read"});
  }
  HttpResponse response = to_response(
      {.status = 401,
       .kind = ProblemKind::kToken,
       .detail = fmt::format(
           "send 'Authorization: Bearer TOKEN'; the token stands in {} in the daemon's state directory",
           access == Access::kView ? kViewTokenFile : kOperateTokenFile)});
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
