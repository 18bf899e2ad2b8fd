#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"
#include "service/http/server/token_rank.hpp"

namespace cell {

/// What a route requires: nothing; to stop the arm; a token that may read, operate, or say what the cell goes
/// by from now on.
enum class Access { kOpen, kStop, kView, kOperate, kEngineer };

/// Whose token a request carries.
enum class Role { kNone, kWrongToken, kOverSession, kView, kOperate, kEngineer };
std::string_view role_name(
    Role role);  // "engineer", "operate", "view", "session over", "wrong token", "none"
TokenRank token_rank(Role role);

/// Who sends a request, by its token. A value: the tokens may be others before the request is answered.
struct Caller {
  Role role = Role::kNone;
  std::string token_name = {};  // of the token or of the user; empty where the token has no name
  bool is_user = false;         // who signed in; else the token is in a file, and may do all that it operates
  [[nodiscard]] bool may_operate() const { return role == Role::kOperate || role == Role::kEngineer; }
  [[nodiscard]] bool may_engineer() const {
    return role == Role::kEngineer || (role == Role::kOperate && !is_user);
  }
};
Caller caller_of(const HttpRequest& request, const Tokens& tokens);
Role role_of(const HttpRequest& request, const Tokens& tokens);
bool shows_token(const HttpRequest& request, const Tokens& tokens);  // one that counts

/// The digest by which the token of a request is kept as a session's; empty where it has none.
std::string token_digest_of(const HttpRequest& request);

/// Nothing if access is granted. Reading needs no token on loopback. To stop, any session is enough, also one
/// that is over: nobody who has signed in is kept from it.
std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens);

/// A body, also one that is only announced, must be declared as JSON: a foreign web page cannot send that
/// without a CORS preflight.
std::optional<HttpResponse> refuse_content_type(const HttpRequest& request);

}  // namespace cell
