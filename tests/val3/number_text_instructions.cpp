#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

double rounded(double x) { return std::floor(x + 0.5); }

/// `format` is "width.decimals"; both may be left out.
std::string formatted(const std::string& format, double number) {
  int width = 0;
  int decimals = 0;
  const std::size_t point = format.find('.');
  const auto whole = [](const std::string& digits) {
    if (digits.empty()) return 0;
    if (digits.size() > 2 || digits.find_first_not_of("0123456789") != std::string::npos)
      throw RuntimeError(kErrorParameter, "format");
    return std::stoi(digits);
  };
  width = whole(format.substr(0, point));
  if (point != std::string::npos) decimals = whole(format.substr(point + 1));
  std::array<char, 400> text{};
  const int length = std::snprintf(text.data(), text.size(), "%*.*f", width, decimals, number);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::size_t position(double number) {
  if (number < 0 || number != std::floor(number)) throw RuntimeError(kErrorParameter, "a position or a size");
  return static_cast<std::size_t>(number);
}

/// Reads a number in front of a text and returns what follows it.
Value to_num(Call& c) {
  const std::string& text = c.text(0);
  std::size_t end = 0;
  bool found = true;
  double number = 0;
  try {
    number = std::stod(text, &end);
  } catch (const std::exception&) {
    found = false;
  }
  c.places[2].write(found);
  if (found) c.places[1].write(number);
  return text.substr(end);
}

std::string middle(const std::string& text, double size, double at) {
  if (position(at) > text.size()) throw RuntimeError(kErrorParameter, "a position behind the text");
  return text.substr(position(at), position(size));
}

Value square_root(double x) {
  if (x < 0) throw RuntimeError(kErrorArithmetic, "root of a negative number");
  return std::sqrt(x);
}

void add_numbers(std::vector<Instruction>& list) {
  list.push_back(instruction("num abs(num)", [](Call& c) -> Value { return std::abs(c.number(0)); }));
  list.push_back(instruction("num sqrt(num)", [](Call& c) { return square_root(c.number(0)); }));
  list.push_back(instruction("num round(num)", [](Call& c) -> Value { return rounded(c.number(0)); }));
  list.push_back(instruction("num roundUp(num)", [](Call& c) -> Value { return std::ceil(c.number(0)); }));
  list.push_back(instruction("num roundDown(num)", [](Call& c) -> Value { return std::floor(c.number(0)); }));
  list.push_back(instruction("num power(num, num)",
                             [](Call& c) -> Value { return std::pow(c.number(0), c.number(1)); }));
  list.push_back(
      instruction("num min(num, num)", [](Call& c) -> Value { return std::min(c.number(0), c.number(1)); }));
  list.push_back(
      instruction("num max(num, num)", [](Call& c) -> Value { return std::max(c.number(0), c.number(1)); }));
  list.push_back(instruction("num limit(num, num, num)", [](Call& c) -> Value {
    return std::min(std::max(c.number(0), c.number(1)), c.number(2));
  }));
  list.push_back(instruction("num sel(bool, num, num)",
                             [](Call& c) -> Value { return c.value<bool>(0) ? c.number(1) : c.number(2); }));
  list.push_back(instruction("num sin(num)",
                             [](Call& c) -> Value { return std::sin(c.number(0) * kRadiansPerDegree); }));
  list.push_back(instruction("num cos(num)",
                             [](Call& c) -> Value { return std::cos(c.number(0) * kRadiansPerDegree); }));
}

void add_texts(std::vector<Instruction>& list) {
  list.push_back(instruction("string toString(string, num)",
                             [](Call& c) -> Value { return formatted(c.text(0), c.number(1)); }));
  list.push_back(instruction("string toNum(string, num&, bool&)", to_num));
  list.push_back(
      instruction("num len(string)", [](Call& c) -> Value { return static_cast<double>(c.text(0).size()); }));
  list.push_back(instruction("string left(string, num)",
                             [](Call& c) -> Value { return middle(c.text(0), c.number(1), 0); }));
  list.push_back(instruction("string right(string, num)", [](Call& c) -> Value {
    const std::size_t size = std::min(position(c.number(1)), c.text(0).size());
    return c.text(0).substr(c.text(0).size() - size);
  }));
  // text, size, position: in this order
  list.push_back(instruction("string mid(string, num, num)",
                             [](Call& c) -> Value { return middle(c.text(0), c.number(1), c.number(2)); }));
  list.push_back(instruction("num find(string, string)", [](Call& c) -> Value {
    const std::size_t at = c.text(0).find(c.text(1));
    return at == std::string::npos ? -1.0 : static_cast<double>(at);
  }));
  list.push_back(instruction("string chr(num)", [](Call& c) -> Value {
    if (c.number(0) < 0 || c.number(0) > 255) throw RuntimeError(kErrorParameter, "chr");
    return std::string(1, static_cast<char>(c.number(0)));
  }));
  list.push_back(instruction("num asc(string, num)", [](Call& c) -> Value {
    const std::string one = middle(c.text(0), 1, c.number(1));
    return one.empty() ? -1.0 : static_cast<double>(static_cast<unsigned char>(one[0]));
  }));
}

}  // namespace

std::vector<Instruction> number_and_text_instructions() {
  std::vector<Instruction> list;
  add_numbers(list);
  add_texts(list);
  return list;
}

}  // namespace val3
