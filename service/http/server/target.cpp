#include "service/http/server/target.hpp"

#include <algorithm>
#include <boost/url/parse.hpp>
#include <boost/url/pct_string_view.hpp>
#include <boost/url/url_view.hpp>

namespace cell {
namespace {

namespace urls = boost::urls;

bool has_control(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

std::string decoded(urls::pct_string_view text) {
  return text.decode();  // a plus sign stays one, unlike in url_view::params()
}

/// A trailing '&' adds no pair.
Query decoded_query(const urls::url_view& target) {
  Query query;
  const auto pairs = target.encoded_params();
  std::size_t left = pairs.size();
  const std::string_view encoded = target.encoded_query();
  if (encoded.empty() || encoded.ends_with('&')) left = left == 0 ? 0 : left - 1;
  for (auto pair = pairs.begin(); left > 0; ++pair, --left)
    query.emplace(decoded((*pair).key), decoded((*pair).value));
  return query;
}

}  // namespace

std::optional<std::pair<std::string, Query>> parse_target(std::string_view target) {
  const auto parsed = urls::parse_origin_form(target);
  if (!parsed) return std::nullopt;
  std::pair<std::string, Query> taken{parsed->encoded_path(), decoded_query(*parsed)};
  const bool is_clean =
      !has_control(parsed->path()) && std::ranges::none_of(taken.second, [](const auto& pair) {
        return has_control(pair.first) || has_control(pair.second);
      });
  return is_clean ? std::optional(std::move(taken)) : std::nullopt;
}

std::string decode_segment(std::string_view segment) {
  if (segment.find('%') == std::string_view::npos) return std::string(segment);
  const auto encoded = urls::make_pct_string_view(segment);
  return encoded ? decoded(*encoded) : std::string(segment);
}

}  // namespace cell
