#pragma once

#include <string>

#include "service/http/server/http_message.hpp"

namespace cell {

/// The bytes of an answer, HTTP/1.`minor`. `head`: only the header that a GET would get. A stream of events
/// has no length: it ends with its connection.
std::string response_text(const HttpResponse& response, unsigned minor, bool keep_alive, bool head);

}  // namespace cell
