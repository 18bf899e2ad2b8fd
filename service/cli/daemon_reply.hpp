#pragma once

#include <nlohmann/json_fwd.hpp>

#include "service/base/exit_code.hpp"
#include "service/cli/api_client.hpp"

namespace cell {

/// The document in a reply. Throws DaemonUnreachable if the peer is not touchcald.
nlohmann::json parse_reply(const ApiReply& reply);

/// Prints the problem document of a reply; returns its exit code.
ExitCode print_problem(const ApiReply& reply, bool json);

}  // namespace cell
