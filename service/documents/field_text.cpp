#include "service/documents/internal/field_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"

namespace cell {
namespace {

/// Outside these a number is written with an exponent.
constexpr double kPlainMin = 1e-4, kPlainEnd = 1e15;

/// Whether a text stands between quotes as it is.
bool is_plain(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; });
}

}  // namespace

void FieldText::write(double value) {
  if (!std::isfinite(value)) {
    text_ += "null";
    return;
  }
  std::array<char, 32> digits{};
  const double size = std::abs(value);
  const bool has_exponent = size != 0.0 && (size < kPlainMin || size >= kPlainEnd);
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value,
                    has_exponent ? std::chars_format::scientific : std::chars_format::fixed);
  const std::string_view written(digits.data(), static_cast<std::size_t>(end - digits.data()));
  text_ += written;
  // A figure that is whole by chance is no integer.
  if (!has_exponent && written.find('.') == std::string_view::npos) text_ += ".0";
}

void FieldText::write(std::string_view value) {
  if (is_plain(value))
    text_.append("\"").append(value).append("\"");
  else
    text_ += text_of(Json(value));
}

}  // namespace cell
