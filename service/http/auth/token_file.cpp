#include "service/http/auth/token_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace cell {

std::optional<std::string> read_token(const std::filesystem::path& file, std::string_view replacement) {
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (status.type() == std::filesystem::file_type::not_found) return std::nullopt;
  std::ifstream existing(file);
  if (!existing)
    throw std::runtime_error(file.string() + ": the token cannot be read; make the file this user's own");
  constexpr auto kOthers = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
  if ((status.permissions() & kOthers) != std::filesystem::perms::none) {
    throw std::runtime_error(
        fmt::format("{0}: others than its owner have access; {1}, or chmod 600 {0} when nobody has read it",
                    file.string(), replacement));
  }
  std::string token;
  std::getline(existing, token);
  const bool is_visible = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() < 2 * kTokenBytes || token.size() > kTokenCharactersMax || !is_visible) {
    throw std::runtime_error(fmt::format("{}: does not hold a token; {}", file.string(), replacement));
  }
  return token;
}

}  // namespace cell
