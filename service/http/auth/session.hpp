#pragma once

#include <string>

#include "service/http/auth/user_role.hpp"

namespace cell {

/// Somebody who has signed in. Their token is kept as its digest only.
struct Session {
  std::string token_digest;  // SHA-256
  std::string user;
  UserRole role = UserRole::kView;
  std::string ends_at;   // RFC 3339, UTC with milliseconds
  bool is_over = false;  // its time is: it may stop the arm, and nothing else

  bool operator==(const Session&) const = default;
};

}  // namespace cell
