#include "config/short_name.hpp"

#include <algorithm>
#include <cstddef>

#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr std::size_t kShortNameMax = 32;

}  // namespace

std::string short_name(const JsonValue& value) {
  std::string name = value.text();
  const auto is_plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (name.size() > kShortNameMax || !std::ranges::all_of(name, is_plain))
    value.fail("is " + in_quotes(name) + "; give 1 to " + std::to_string(kShortNameMax) +
               " of the characters a to z, 0 to 9 and _");
  if (name == "on" || name.ends_with("_turn"))
    value.fail("is " + in_quotes(name) + ", which means something else in other files; give another name");
  return name;
}

}  // namespace cell
