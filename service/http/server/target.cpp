#include "service/http/server/internal/target.hpp"

namespace cell {

std::optional<std::pair<std::string, Query>> parse_target(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  const std::size_t question = target.find('?');
  Query query;
  std::string_view rest =
      question == std::string_view::npos ? std::string_view() : target.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view pair = rest.substr(0, end);
    const std::size_t equals = pair.find('=');
    query.emplace(std::string(pair.substr(0, equals)),
                  std::string(equals == std::string_view::npos ? "" : pair.substr(equals + 1)));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return std::pair{std::string(target.substr(0, question)), std::move(query)};
}

}  // namespace cell
