#pragma once

#include <string>

#include "service/http/server/http_message.hpp"

namespace cell {

/// An answer as it goes over the wire, HTTP/1.`minor`. `head`: the header that a GET would have got, alone.
/// A stream of events has no length: it ends with its connection.
std::string response_text(const HttpResponse& response, unsigned minor, bool keep_alive, bool head);

}  // namespace cell
