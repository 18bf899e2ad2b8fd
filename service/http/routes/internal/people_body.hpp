#pragma once

#include <optional>
#include <string>
#include <variant>

#include "service/http/auth/user_role.hpp"
#include "service/http/server/http_message.hpp"
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

/// Whom a request about people is about, as the audit tells it: "user otto, role view, another secret". Empty
/// where the request is about nobody, or its body is none that can be taken: a secret may stand anywhere in
/// it.
std::string person_asked_about(const HttpRequest& request);

}  // namespace cell
