#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "service/http/server/problem.hpp"

namespace cell {

/// What a request's body names: {"recipe":"edf-25"}.
struct NamedText {
  std::string key;
  std::string text;
};

/// A body that is an object with exactly one of these keys and a text behind it, or what is wrong with it.
std::variant<NamedText, Problem> named_text(const std::string& body, std::span<const std::string_view> keys);

}  // namespace cell
