#pragma once

#include <string>
#include <vector>

#include "service/http/auth/tokens.hpp"

namespace cell {

/// What the log says of tokens that are read again and again: each trouble once, not at each look.
class TokenTroubles {
 public:
  void tell(const CurrentTokens& now);

 private:
  std::vector<std::string> told_;
};

/// Whose token counts from now on, and whose does not any more.
void tell_changes(const Tokens& before, const Tokens& now);

}  // namespace cell
