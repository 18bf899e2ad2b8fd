#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"

namespace cell {

/// What a route asks of its caller: nothing, a token that may read, one that may change things.
enum class Access { kOpen, kView, kOperate };

/// Whose token a request carries.
enum class Role { kNone, kWrongToken, kView, kOperate };
std::string_view role_name(Role role);  // "operate", "view", "wrong token", "none"

Role role_of(const HttpRequest& request, const Tokens& tokens);

/// Nothing when the request may do what the route does. Reading needs no token on loopback.
std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens);

/// A body must say that it is JSON: a web page elsewhere cannot send that without asking.
std::optional<HttpResponse> refuse_content_type(const HttpRequest& request);

}  // namespace cell
