#pragma once

#include <nlohmann/json_fwd.hpp>

#include "service/base/exit_code.hpp"
#include "service/cli/api_client.hpp"

namespace cell {

/// The document that the daemon answered. Throws DaemonUnreachable when what answers is no touchcald.
nlohmann::json parse_reply(const ApiReply& reply);

/// Tells a problem document that the daemon answered; the exit code that goes with it.
ExitCode tell_problem(const ApiReply& reply, bool json);

}  // namespace cell
