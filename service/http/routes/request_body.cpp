#include "service/http/routes/internal/request_body.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

std::variant<NamedText, Problem> read_named_text(const nlohmann::json& document,
                                                 std::span<const std::string_view> keys) {
  if (!document.is_object())
    return Problem{.kind = ProblemKind::kBody, .detail = "an object is required", .pointer = ""};
  const std::string known = fmt::format("'{}'", fmt::join(keys, "' or '"));
  for (const auto& [key, value] : document.items()) {
    if (std::ranges::find(keys, std::string_view(key)) == keys.end()) {
      return Problem{.kind = ProblemKind::kBody,
                     .detail = fmt::format("unknown key; {} is known", known),
                     .pointer = pointer_step(key)};
    }
  }
  if (document.size() > 1) {
    return Problem{.kind = ProblemKind::kBody, .detail = fmt::format("give one of {}", known), .pointer = ""};
  }
  if (document.empty() || !document.begin()->is_string()) {
    const std::string key = document.empty() ? std::string(keys.front()) : document.begin().key();
    return Problem{.kind = ProblemKind::kBody,
                   .detail = fmt::format("a string is required under {}", known),
                   .pointer = pointer_step(key)};
  }
  return NamedText{document.begin().key(), document.begin()->get<std::string>()};
}

}  // namespace

std::variant<NamedText, Problem> named_text(const std::string& body, std::span<const std::string_view> keys) {
  try {
    return read_named_text(parse_strict_json("request body", body, kBodyBytesMax), keys);
  } catch (const ConfigError& error) {
    return Problem{.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()};
  }
}

}  // namespace cell
