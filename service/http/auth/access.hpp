#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"
#include "service/http/server/token_rank.hpp"

namespace cell {

/// What a route requires: nothing, a token that may read, or one that may operate.
enum class Access { kOpen, kView, kOperate };

/// Whose token a request carries.
enum class Role { kNone, kWrongToken, kView, kOperate };
std::string_view role_name(Role role);  // "operate", "view", "wrong token", "none"
TokenRank token_rank(Role role);

/// Who sends a request, by its token. A value: the tokens may be others before the request is answered.
struct Caller {
  Role role = Role::kNone;
  std::string token_name = {};  // empty where the token has no name
};
Caller caller_of(const HttpRequest& request, const Tokens& tokens);
Role role_of(const HttpRequest& request, const Tokens& tokens);
bool shows_token(const HttpRequest& request, const Tokens& tokens);  // one that counts

/// Nothing if access is granted. Reading needs no token on loopback.
std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens);

/// A body, also one that is only announced, must be declared as JSON: a foreign web page cannot send that
/// without a CORS preflight.
std::optional<HttpResponse> refuse_content_type(const HttpRequest& request);

}  // namespace cell
