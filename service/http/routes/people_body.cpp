#include "service/http/routes/internal/people_body.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"
#include "service/http/auth/user_book.hpp"
#include "service/http/routes/internal/user_routes.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/server/target.hpp"

namespace cell {
namespace {

static_assert(kIdBytesMax >= kUserNameBytesMax, "a path names a user whole");

Problem wrong_member(std::string_view key, std::string detail) {
  return {.kind = ProblemKind::kBody,
          .detail = std::move(detail),
          .pointer = key.empty() ? std::string() : pointer_step(key)};
}

/// The texts under these keys, of which the first `needed` have to be there.
std::variant<std::vector<std::optional<std::string>>, Problem> texts_of(
    const nlohmann::json& document, std::span<const std::string_view> keys, std::size_t needed) {
  if (!document.is_object()) return wrong_member("", "an object is required");
  for (const auto& [key, value] : document.items())
    if (std::ranges::find(keys, std::string_view(key)) == keys.end())
      return wrong_member(key, fmt::format("unknown key; known are {}", fmt::join(keys, ", ")));
  std::vector<std::optional<std::string>> texts;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto found = document.find(keys[i]);
    const bool is_there = found != document.end();
    if (is_there ? !found->is_string() : i < needed) return wrong_member(keys[i], "a string is required");
    texts.push_back(is_there ? std::optional(found->get<std::string>()) : std::nullopt);
  }
  return texts;
}

std::variant<std::vector<std::optional<std::string>>, Problem> read_texts(
    const std::string& body, std::span<const std::string_view> keys, std::size_t needed) {
  try {
    return texts_of(parse_strict_json("request body", body, kBodyBytesMax), keys, needed);
  } catch (const ConfigError& error) {
    return wrong_member("", fmt::format("request body{}: is no JSON that can be taken", error.pointer()));
  }
}

}  // namespace

std::variant<SignInBody, Problem> read_sign_in(const std::string& body) {
  constexpr std::array<std::string_view, 2> kKeys{"name", "secret"};
  auto texts = read_texts(body, kKeys, 2);
  if (auto* problem = std::get_if<Problem>(&texts)) return std::move(*problem);
  auto& values = std::get<0>(texts);
  if (values[0]->size() > kUserNameBytesMax || values[1]->size() > kSecretBytesMax)
    return wrong_member("", fmt::format("a name of at most {} and a secret of at most {} bytes are required",
                                        kUserNameBytesMax, kSecretBytesMax));
  return SignInBody{.name = *values[0], .secret = *values[1]};
}

std::variant<SecretChange, Problem> read_secret_change(const std::string& body) {
  constexpr std::array<std::string_view, 2> kKeys{"secret", "new_secret"};
  auto texts = read_texts(body, kKeys, 2);
  if (auto* problem = std::get_if<Problem>(&texts)) return std::move(*problem);
  auto& values = std::get<0>(texts);
  return SecretChange{.secret = *values[0], .new_secret = *values[1]};
}

std::variant<UserRequest, Problem> read_user_request(const std::string& body) {
  constexpr std::array<std::string_view, 3> kKeys{"name", "role", "secret"};
  auto texts = read_texts(body, kKeys, 2);
  if (auto* problem = std::get_if<Problem>(&texts)) return std::move(*problem);
  auto& values = std::get<0>(texts);
  if (const auto why = why_no_user_name(*values[0])) return wrong_member(kKeys[0], *why);
  const auto role = user_role_named(*values[1]);
  if (!role) return wrong_member(kKeys[1], "must be 'view', 'operate' or 'engineer'");
  if (values[2])
    if (const auto why = why_no_secret(*values[2], *values[0])) return wrong_member(kKeys[2], *why);
  return UserRequest{.name = *values[0], .role = *role, .secret = values[2]};
}

std::string person_asked_about(const HttpRequest& request) {
  if (const auto removed = match(kRemoveUserPath, request.path)) {
    const std::string name = decode_segment(*removed);
    return name.size() > kIdBytesMax ? std::string() : fmt::format("user {}", name);
  }
  if (request.path != kUsersPath || request.method != "POST") return {};
  const auto body = read_user_request(request.body);
  const auto* asked = std::get_if<UserRequest>(&body);
  if (!asked) return {};
  return fmt::format("user {}, role {}, {}", asked->name, user_role_name(asked->role),
                     asked->secret ? "another secret" : "the secret stays");
}

}  // namespace cell
