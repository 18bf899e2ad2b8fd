#pragma once

#include <boost/asio/awaitable.hpp>

#include "service/http/auth/tokens.hpp"
#include "service/http/server/http_message.hpp"

namespace cell {

class CellOperation;

/// Answers a request by the routes of route_table.hpp, on the thread of the operation. Requests that wait
/// (DispatchMode) go through api.hpp.
boost::asio::awaitable<HttpResponse> route(HttpRequest request, CellOperation& operation, Tokens tokens);

}  // namespace cell
