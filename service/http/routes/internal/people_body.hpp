#pragma once

#include <optional>
#include <string>
#include <variant>

#include "service/http/auth/user_role.hpp"
#include "service/http/server/problem.hpp"

/// The bodies of requests about people. A refusal never tells a secret.
namespace cell {

struct SignInBody {
  std::string name;
  std::string secret;
};
std::variant<SignInBody, Problem> read_sign_in(const std::string& body);

struct SecretChange {
  std::string secret;
  std::string new_secret;
};
std::variant<SecretChange, Problem> read_secret_change(const std::string& body);

struct UserRequest {
  std::string name;
  UserRole role = UserRole::kView;
  std::optional<std::string> secret = {};
};
std::variant<UserRequest, Problem> read_user_request(const std::string& body);

}  // namespace cell
