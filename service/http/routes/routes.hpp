#pragma once

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"

namespace cell {

class Operation;
struct Services;

/// Version 1 of the API (service/doc/surfaces.md), as far as it can be answered at once: route_table.hpp.
/// What waits (Pace) is answered by api.hpp.
HttpResponse route(const HttpRequest& request, Services& services);
/// The same with services of its own.
HttpResponse route(const HttpRequest& request, Operation& operation, const Tokens& tokens);

}  // namespace cell
