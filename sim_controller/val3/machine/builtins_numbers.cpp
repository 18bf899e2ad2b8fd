// Numbers, bits and bytes (manual 6, pages 34 to 47).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/geometry.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

double demand(bool fits, double value, const char* text) {
  if (!fits) throw RunFailure(kErrorArgument, text);
  return value;
}

double powered(double base, double exponent) {
  // The manual wants a base above 0; programs of s7 square signed differences.
  const bool is_whole = exponent == std::floor(exponent);
  const double value = std::pow(base, exponent);
  return demand((base > 0.0 || is_whole) && std::isfinite(value), value, "a power that is no number");
}

/// Operands are rounded to unsigned 32 bits (manual 6, page 43).
std::uint32_t bits_of(double value) {
  const double rounded = std::round(value);
  constexpr double kMax = 4294967295.0;
  if (!(rounded >= 0.0 && rounded <= kMax))
    throw RunFailure(kErrorArgument, "bits of a number beyond 32 bits");
  return static_cast<std::uint32_t>(rounded);
}

/// "-2l", "4.0b": how a number stands in bytes (manual 6, page 46).
struct Format {
  std::size_t bytes = 0;
  bool is_signed = false;
  bool is_float = false;
  bool is_big = false;
};

Format format_of(const std::string& text) {
  std::string_view rest = text;
  Format format;
  if (rest.starts_with('-')) {
    format.is_signed = true;
    rest.remove_prefix(1);
  }
  const auto refuse = [&] { throw RunFailure(kErrorParameter, "'" + text + "' is no format of a number"); };
  if (rest.empty() || (rest[0] != '1' && rest[0] != '2' && rest[0] != '4' && rest[0] != '8')) refuse();
  format.bytes = static_cast<std::size_t>(rest[0] - '0');
  rest.remove_prefix(1);
  if (rest.starts_with(".0")) {
    format.is_float = true;
    rest.remove_prefix(2);
  }
  format.is_big = rest == "b";
  const bool has_order = rest == "l" || rest == "b";
  const bool is_single = format.bytes == 1 && rest.empty() && !format.is_float;
  const bool fits_float = format.is_float && !format.is_signed && format.bytes >= 4;
  const bool fits_whole = !format.is_float && (format.bytes == 2 || format.bytes == 4);
  if (!is_single && !(has_order && (fits_float || fits_whole))) refuse();
  return format;
}

std::uint64_t pattern_of(double value, const Format& format) {
  if (format.is_float)
    return format.bytes == 4 ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                             : std::bit_cast<std::uint64_t>(value);
  const double rounded = std::round(value);
  const double range = std::ldexp(1.0, static_cast<int>(8 * format.bytes));
  const double low = format.is_signed ? -range / 2.0 : 0.0;
  const double high = format.is_signed ? range / 2.0 - 1.0 : range - 1.0;
  if (!(rounded >= low && rounded <= high)) throw RunFailure(kErrorParameter, "a number beyond its bytes");
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded));
}

double value_of(std::uint64_t pattern, const Format& format) {
  if (format.is_float)
    return format.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(pattern)))
                             : std::bit_cast<double>(pattern);
  const double range = std::ldexp(1.0, static_cast<int>(8 * format.bytes));
  const auto value = static_cast<double>(pattern);
  return format.is_signed && value >= range / 2.0 ? value - range : value;
}

std::size_t count_of(double n, std::size_t most) {
  if (!(n >= 0.0 && n <= static_cast<double>(most)))
    throw RunFailure(kErrorParameter, "more elements than the array has");
  return static_cast<std::size_t>(n);
}

double to_binary(Context& context, Slice<double> values, double n, const std::string& text,
                 Slice<double> bytes) {
  const Format format = format_of(text);
  const std::size_t count = count_of(n, values.size());
  if (count * format.bytes > bytes.size())
    throw RunFailure(kErrorParameter, "too few elements for the bytes");
  context.tasks.charge(count * format.bytes);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t pattern = pattern_of(values[i], format);
    for (std::size_t k = 0; k < format.bytes; ++k) {
      const std::size_t shift = 8 * (format.is_big ? format.bytes - 1 - k : k);
      bytes[i * format.bytes + k] = static_cast<double>(pattern >> shift & 0xFFU);
    }
  }
  return static_cast<double>(count * format.bytes);
}

/// How many were read; minus that where a byte is none or a float is no number.
double from_binary(Context& context, Slice<double> bytes, double n, const std::string& text,
                   Slice<double> values) {
  const Format format = format_of(text);
  const std::size_t count = std::min(count_of(n, bytes.size()) / format.bytes, values.size());
  context.tasks.charge(count * format.bytes);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t pattern = 0;
    for (std::size_t k = 0; k < format.bytes; ++k) {
      const double byte = bytes[i * format.bytes + k];
      if (!(byte >= 0.0 && byte <= 255.0)) return -static_cast<double>(i);
      const std::size_t shift = 8 * (format.is_big ? format.bytes - 1 - k : k);
      pattern |= static_cast<std::uint64_t>(std::llround(byte)) << shift;
    }
    const double value = value_of(pattern, format);
    if (!std::isfinite(value)) return -static_cast<double>(i);
    values[i] = value;
  }
  return static_cast<double>(count);
}

void define_angles(Builtins& list) {
  list.define<double, double>("sin", [](Context&, double x) { return std::sin(x * kRadiansPerDegree); });
  list.define<double, double>("cos", [](Context&, double x) { return std::cos(x * kRadiansPerDegree); });
  list.define<double, double>("tan", [](Context&, double x) { return std::tan(x * kRadiansPerDegree); });
  list.define<double, double>("asin", [](Context&, double x) {
    return demand(std::abs(x) <= 1.0, std::asin(x) / kRadiansPerDegree, "asin beyond 1");
  });
  list.define<double, double>("acos", [](Context&, double x) {
    return demand(std::abs(x) <= 1.0, std::acos(x) / kRadiansPerDegree, "acos beyond 1");
  });
  list.define<double, double>("atan", [](Context&, double x) { return std::atan(x) / kRadiansPerDegree; });
}

void define_bits(Builtins& list) {
  list.define<double, double, double>(
      "bAnd", [](Context&, double a, double b) { return static_cast<double>(bits_of(a) & bits_of(b)); });
  list.define<double, double, double>(
      "bOr", [](Context&, double a, double b) { return static_cast<double>(bits_of(a) | bits_of(b)); });
  list.define<double, double, double>(
      "bXor", [](Context&, double a, double b) { return static_cast<double>(bits_of(a) ^ bits_of(b)); });
  list.define<double, double>("bNot", [](Context&, double a) { return static_cast<double>(~bits_of(a)); });
  list.define<double, Slice<double>, double, std::string, Slice<double>>("toBinary", to_binary);
  list.define<double, Slice<double>, double, std::string, Slice<double>>("fromBinary", from_binary);
}

}  // namespace

void define_numbers(Builtins& list) {
  define_angles(list);
  define_bits(list);
  list.define<double, double>("abs", [](Context&, double x) { return std::abs(x); });
  list.define<Joint, Joint>("abs", [](Context&, Joint joint) {
    for (double& axis : joint) axis = std::abs(axis);
    return joint;
  });
  list.define<double, double>("sqrt", [](Context&, double x) {
    return demand(x >= 0.0, std::sqrt(x), "the root of a negative number");
  });
  list.define<double, double>("exp", [](Context&, double x) {
    return demand(std::isfinite(std::exp(x)), std::exp(x), "exp of too large a number");
  });
  list.define<double, double>(
      "ln", [](Context&, double x) { return demand(x > 0.0, std::log(x), "ln of 0 or less"); });
  list.define<double, double>(
      "log", [](Context&, double x) { return demand(x > 0.0, std::log10(x), "log of 0 or less"); });
  list.define<double, double, double>("power", [](Context&, double x, double y) { return powered(x, y); });
  list.define<double, double>("roundUp", [](Context&, double x) { return std::ceil(x); });
  list.define<double, double>("roundDown", [](Context&, double x) { return std::floor(x); });
  list.define<double, double>("round", [](Context&, double x) { return std::round(x); });
  list.define<double, double, double>("min", [](Context&, double x, double y) { return std::min(x, y); });
  list.define<double, double, double>("max", [](Context&, double x, double y) { return std::max(x, y); });
  list.define<double, double, double, double>(
      "limit", [](Context&, double x, double low, double high) { return std::min(std::max(x, low), high); });
  list.define<double, bool, double, double>(
      "sel", [](Context&, bool first, double a, double b) { return first ? a : b; });
}

}  // namespace val3
