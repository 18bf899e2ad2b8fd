#pragma once

#include <string>

#include "service/http/auth/tokens.hpp"

namespace cell {

/// The access tokens of a daemon under test.
inline const Tokens kTokens{std::string(64, 'a'), std::string(64, 'b')};

}  // namespace cell
