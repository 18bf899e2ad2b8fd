#include "config/utc_text.hpp"

#include <charconv>

namespace cell {
namespace {

constexpr std::string_view kShape = "0000-00-00T00:00:00";  // 0: a digit
constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kFractionDigitsMax = 9;
constexpr int kYearMin = 1970;
constexpr int kYearMax = 2199;  // a clock of nanoseconds ends in 2262

int number_at(std::string_view text, std::size_t place, std::size_t digits) {
  int value = 0;
  std::from_chars(text.data() + place, text.data() + place + digits, value);
  return value;
}

bool has_shape(std::string_view text) {
  if (text.size() < kShape.size()) return false;
  for (std::size_t i = 0; i < kShape.size(); ++i) {
    const bool is_digit = kDigits.find(text[i]) != std::string_view::npos;
    if (kShape[i] == '0' ? !is_digit : text[i] != kShape[i]) return false;
  }
  return true;
}

/// Behind the seconds: "Z", or a point, digits and "Z".
std::optional<std::chrono::milliseconds> fraction_from(std::string_view text) {
  if (text == "Z") return std::chrono::milliseconds(0);
  if (text.size() < 3 || text.front() != '.' || text.back() != 'Z') return std::nullopt;
  const std::string_view digits = text.substr(1, text.size() - 2);
  if (digits.size() > kFractionDigitsMax || digits.find_first_not_of(kDigits) != std::string_view::npos)
    return std::nullopt;
  int milliseconds = 0;
  for (std::size_t i = 0; i < 3; ++i)
    milliseconds = 10 * milliseconds + (i < digits.size() ? digits[i] - '0' : 0);
  return std::chrono::milliseconds(milliseconds);
}

}  // namespace

std::optional<std::chrono::system_clock::time_point> time_from_utc(std::string_view text) {
  if (!has_shape(text)) return std::nullopt;
  const auto fraction = fraction_from(text.substr(kShape.size()));
  const int year = number_at(text, 0, 4);
  const std::chrono::year_month_day date(std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(number_at(text, 5, 2))),
                                         std::chrono::day(static_cast<unsigned>(number_at(text, 8, 2))));
  const int hours = number_at(text, 11, 2), minutes = number_at(text, 14, 2),
            seconds = number_at(text, 17, 2);
  const bool is_time = hours < 24 && minutes < 60 && seconds < 60;
  if (!fraction || !date.ok() || year < kYearMin || year > kYearMax || !is_time) return std::nullopt;
  return std::chrono::sys_days(date) + std::chrono::hours(hours) + std::chrono::minutes(minutes) +
         std::chrono::seconds(seconds) + *fraction;
}

}  // namespace cell
