#pragma once

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"

namespace cell {

class CellOperation;
struct Services;

/// Answers a request at once, by the routes of route_table.hpp. Requests that wait (DispatchMode) go through
/// api.hpp.
HttpResponse route(const HttpRequest& request, Services& services);
/// The same with its own services.
HttpResponse route(const HttpRequest& request, CellOperation& operation, const Tokens& tokens);

}  // namespace cell
