#pragma once

#include <string>
#include <string_view>

#include "service/http/server/http_message.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

struct Services;

inline constexpr std::string_view kSessionPath = "/api/v1/session";
inline constexpr std::string_view kSignInPath = "/api/v1/sign-in";
inline constexpr std::string_view kSignOutPath = "/api/v1/sign-out";
inline constexpr std::string_view kOwnSecretPath = "/api/v1/session/secret";
inline constexpr std::string_view kUsersPath = "/api/v1/users";
inline constexpr std::string_view kRemoveUserPath = "/api/v1/users/{id}/remove";

/// Whose token the request carries, by what counts now.
HttpResponse session_answer(const HttpRequest& request, const Services& services);
/// The users, as they are now.
HttpResponse users_answer(unsigned status, const Services& services);
Problem no_user(std::string_view name);

}  // namespace cell
