#include <algorithm>
#include <cmath>

#include "tests/val3/interpreter.hpp"

namespace val3 {
namespace {

Value compare(const std::string& sign, const auto& left, const auto& right) {
  if (sign == "==") return left == right;
  if (sign == "!=") return left != right;
  if (sign == "<") return left < right;
  if (sign == "<=") return left <= right;
  if (sign == ">") return left > right;
  if (sign == ">=") return left >= right;
  throw RuntimeError(kErrorInterpreter, "no operator " + sign + " for this type");
}

Value of_numbers(const std::string& sign, double left, double right) {
  if (sign == "+") return left + right;
  if (sign == "-") return left - right;
  if (sign == "*") return left * right;
  if ((sign == "/" || sign == "%") && right == 0) throw RuntimeError(kErrorArithmetic, "division by 0");
  if (sign == "/") return left / right;
  // what a controller makes of larger numbers is not known
  if (sign == "%" && std::max(std::abs(left), std::abs(right)) > 2147483647.0)
    throw RuntimeError(kErrorArithmetic, "% beyond 32 bits");
  if (sign == "%") return std::fmod(left, right);
  return compare(sign, left, right);
}

Value of_joints(const std::string& sign, const Joint& left, const Joint& right) {
  if (sign == "==") return left == right;
  if (sign == "!=") return left != right;
  if (sign != "+" && sign != "-")
    throw RuntimeError(kErrorInterpreter, "no operator " + sign + " for joints");
  Joint result{};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = sign == "+" ? left[i] + right[i] : left[i] - right[i];
  return result;
}

}  // namespace

Value operate(const std::string& sign, const Value& left, const Value& right) {
  if (left.index() != right.index())
    throw RuntimeError(kErrorInterpreter, "operator " + sign + " between two types");
  if (const double* number = std::get_if<double>(&left))
    return of_numbers(sign, *number, std::get<double>(right));
  if (const std::string* text = std::get_if<std::string>(&left)) {
    if (sign == "+") return *text + std::get<std::string>(right);
    return compare(sign, *text, std::get<std::string>(right));
  }
  if (const Joint* joint = std::get_if<Joint>(&left)) return of_joints(sign, *joint, std::get<Joint>(right));
  if (const bool* truth = std::get_if<bool>(&left); truth != nullptr && (sign == "==" || sign == "!="))
    return compare(sign, *truth, std::get<bool>(right));
  throw RuntimeError(kErrorInterpreter, "no operator " + sign + " for this type");
}

}  // namespace val3
