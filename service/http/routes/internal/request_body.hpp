#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "service/http/server/problem.hpp"

namespace cell {

/// The single member of a request body: {"recipe":"edf-25"}.
struct NamedText {
  std::string key;
  std::string text;
};

/// Reads a body that must be an object with exactly one of these keys and a string value.
std::variant<NamedText, Problem> named_text(const std::string& body, std::span<const std::string_view> keys);

}  // namespace cell
