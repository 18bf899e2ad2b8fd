#pragma once

#include <string>

#include "service/http/server/http_message.hpp"

namespace cell {

class RunStore;

/// The operator's name of the run that a command is for, as the one who starts it gives it; empty where it is
/// for no run or nobody was named. Of an admitted request, on the thread of `store`. Never throws.
std::string operator_named_for(const HttpRequest& request, const RunStore& store);

}  // namespace cell
