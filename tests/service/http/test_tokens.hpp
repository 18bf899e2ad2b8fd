#pragma once

#include <string>

#include "service/http/auth/tokens.hpp"

namespace cell {

/// The access tokens of a daemon under test.
inline const Tokens kTokens{std::string(64, 'a'),
                            std::string(64, 'b'),
                            {{"anna", std::string(64, 'd')}, {"bert", std::string(64, 'e')}}};

}  // namespace cell
