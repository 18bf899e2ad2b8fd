#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace cell {

/// What somebody who signs in may do; each may what the one before may.
enum class UserRole {
  kView,      // look, and stop
  kOperate,   // run the cell
  kEngineer,  // approve models, roll them back, say who the users are
};

inline constexpr std::array kUserRoles{UserRole::kView, UserRole::kOperate, UserRole::kEngineer};

constexpr std::string_view user_role_name(UserRole role) {
  switch (role) {
    case UserRole::kView:
      return "view";
    case UserRole::kOperate:
      return "operate";
    case UserRole::kEngineer:
      return "engineer";
  }
  return "";
}

constexpr std::optional<UserRole> user_role_named(std::string_view name) {
  for (const UserRole role : kUserRoles)
    if (user_role_name(role) == name) return role;
  return std::nullopt;
}

}  // namespace cell
