#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "service/http/route_table.hpp"

namespace cell {

/// Whose token a request carries: "operate", "view", "wrong token", or "none".
std::string_view role_of(const HttpRequest& request, const Tokens& tokens);

/// Nothing when the request may do what the route does. Reading needs no token on loopback.
std::optional<HttpResponse> refuse_access(const HttpRequest& request, Access access, const Tokens& tokens);

/// A body must say that it is JSON: a web page elsewhere cannot send that without asking.
std::optional<HttpResponse> refuse_content_type(const HttpRequest& request);

}  // namespace cell
