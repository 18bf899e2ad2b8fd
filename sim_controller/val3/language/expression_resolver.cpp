#include "sim_controller/val3/language/expression_resolver.hpp"

#include <algorithm>

#include "sim_controller/val3/language/instructions.hpp"
#include "sim_controller/val3/language/resolver_rules.hpp"

namespace val3 {
namespace {

constexpr Type kNumType{Kind::kNum, -1};
constexpr Type kBoolType{Kind::kBool, -1};
constexpr Type kStringType{Kind::kString, -1};

bool is_braces(const Expression& e) { return e.kind == Expression::Kind::kBraces; }
bool has_kind(const Expression& e, Kind kind) { return !e.is_unknown && e.type.kind == kind; }

}  // namespace

bool can_be_put(const Type& wanted, const Type& given) {
  if (wanted == given) return wanted.kind != Kind::kVoid;
  const auto is_pair = [&](Kind one, Kind other) {
    return (wanted.kind == one && given.kind == other) || (wanted.kind == other && given.kind == one);
  };
  return is_pair(Kind::kDio, Kind::kBool) || is_pair(Kind::kAio, Kind::kNum) ||
         is_pair(Kind::kSio, Kind::kNum) || is_pair(Kind::kSio, Kind::kString);
}

std::string full_name(const Expression& e) { return e.alias.empty() ? e.text : e.alias + ":" + e.text; }

std::string ExpressionResolver::type_name(const Expression& e) const { return type_name(e.type); }

void ExpressionResolver::tell(Severity severity, std::string_view rule, const Expression& at,
                              std::string what, std::string remedy) {
  findings_.push_back(
      {severity, std::string(rule), {program_.file, at.line, at.column}, std::move(what), std::move(remedy)});
}

void ExpressionResolver::fail(std::string_view rule, Expression& at, std::string what, std::string remedy) {
  tell(Severity::kError, rule, at, std::move(what), std::move(remedy));
  at.is_unknown = true;
}

void ExpressionResolver::resolve(Expression& e) {
  switch (e.kind) {
    case Expression::Kind::kNumber:
      e.type = kNumType;
      return;
    case Expression::Kind::kTruth:
      e.type = kBoolType;
      return;
    case Expression::Kind::kText:
      e.type = kStringType;
      return;
    case Expression::Kind::kName:
      return resolve_name(e);
    case Expression::Kind::kIndex:
      return resolve_index(e);
    case Expression::Kind::kField:
      return resolve_field(e);
    case Expression::Kind::kCall:
      return resolve_call(e);
    case Expression::Kind::kUnary:
      return resolve_unary(e);
    case Expression::Kind::kBinary:
      return resolve_binary(e);
    case Expression::Kind::kBraces:
      for (Expression& part : e.parts) resolve(part);
      return;
  }
}

void ExpressionResolver::resolve_as(Expression& e, const Type& wanted, std::string_view where) {
  resolve(e);
  expect(e, wanted, where);
}

void ExpressionResolver::expect(Expression& e, const Type& wanted, std::string_view where) {
  if (e.is_unknown) return;
  if (is_braces(e)) {
    type_braces(e, wanted);
    return;
  }
  if (can_be_put(wanted, e.type) || !has_result(e)) return;
  fail(resolver_rules::kWrongType, e,
       std::string(where) + " is a " + type_name(wanted) + ", and this is a " + type_name(e));
}

/// An instruction without a result is told where a value is wanted.
bool ExpressionResolver::has_result(Expression& e) {
  if (e.is_unknown || e.kind != Expression::Kind::kCall || e.type.kind != Kind::kVoid) return true;
  fail(resolver_rules::kWrongType, e, full_name(e) + "() has no result", "call it on a line of its own");
  return false;
}

void ExpressionResolver::fail_without_type(Expression& e) {
  fail(resolver_rules::kBraces, e, "no type says what the values in braces are",
       "put them into a variable of the type that is meant");
}

bool ExpressionResolver::type_braces(Expression& e, const Type& wanted) {
  const std::vector<Type> fields = field_types(scope_.application(), wanted);
  e.type = wanted;
  if (fields.empty()) {
    fail(resolver_rules::kBraces, e, "a value in braces where a " + type_name(wanted) + " is wanted");
    return false;
  }
  if (e.parts.size() > fields.size()) {
    fail(resolver_rules::kBraces, e,
         std::to_string(e.parts.size()) + " values in braces, and a " + type_name(wanted) + " has " +
             std::to_string(fields.size()) + " fields");
    return false;
  }
  for (std::size_t i = 0; i < e.parts.size(); ++i) expect(e.parts[i], fields[i], "this field");
  return true;
}

/// Makes it a condition: what is put together by `or`, `and`, `xor`, or asked by itself.
bool ExpressionResolver::be_bool(Expression& e) {
  if (!has_result(e) || e.is_unknown || has_kind(e, Kind::kBool)) return true;
  if (has_kind(e, Kind::kDio)) {
    fail(resolver_rules::kDioCondition, e, "an input or output stands as a condition by itself",
         "compare it, as in d==true, or assign it to a bool first");
  } else if (is_braces(e)) {
    fail(resolver_rules::kConditionType, e, "a value in braces is no condition");
  } else {
    fail(resolver_rules::kConditionType, e, "a condition is a bool, and this is a " + type_name(e));
  }
  return false;
}

void ExpressionResolver::demand_no_signal(Expression& e, Kind wanted, const std::string& where) {
  if (wanted != Kind::kBool || !has_kind(e, Kind::kDio)) return;
  fail(resolver_rules::kDioCondition, e, where + " is a bool, and this is an input or output by itself",
       "compare it, as in d==true, or assign it to a bool first");
}

void ExpressionResolver::resolve_condition(Expression& e) {
  resolve(e);
  be_bool(e);
}

bool ExpressionResolver::resolve_place(Expression& e) {
  resolve(e);
  if (e.is_unknown || e.is_place) return true;
  fail(resolver_rules::kNotAVariable, e, "a variable must stand here");
  return false;
}

void ExpressionResolver::resolve_unary(Expression& e) {
  Expression& value = e.parts[0];
  resolve(value);
  if (is_braces(value)) return fail_without_type(e);
  e.is_unknown = !has_result(value) || value.is_unknown;
  if (e.is_unknown) return;
  e.type = value.type;
  if (e.text == "!") {
    if (has_kind(value, Kind::kTrsf)) return;
    // The opposite of an input's state: programs in use have it.
    e.type = kBoolType;
    e.is_unknown = !has_kind(value, Kind::kDio) && !be_bool(value);
    return;
  }
  if (has_kind(value, Kind::kAio)) e.type = kNumType;
  if (has_kind(e, Kind::kNum) || has_kind(e, Kind::kJoint) || has_kind(e, Kind::kJointRs)) return;
  fail(resolver_rules::kOperatorType, e, "- is not defined for a " + type_name(value));
}

void ExpressionResolver::resolve_binary(Expression& e) {
  if (e.text == "or" || e.text == "and" || e.text == "xor") return resolve_logical(e);
  Expression& left = e.parts[0];
  Expression& right = e.parts[1];
  resolve(left);
  resolve(right);
  const bool have_results = has_result(left) && has_result(right);
  if (have_results && is_braces(left) && is_braces(right)) return fail_without_type(e);
  if (e.text == "==" || e.text == "!=") {
    e.type = kBoolType;
    if (!comparable(left, right))
      tell(Severity::kError, resolver_rules::kOperatorType, e,
           "a " + type_name(left) + " is not compared with a " + type_name(right));
    return;
  }
  resolve_arithmetic(e);
}

void ExpressionResolver::resolve_logical(Expression& e) {
  e.type = kBoolType;
  for (Expression& side : e.parts) resolve_condition(side);
}

bool ExpressionResolver::comparable(Expression& left, Expression& right) {
  if (left.is_unknown || right.is_unknown) return true;
  if (is_braces(left) && is_braces(right)) return false;
  if (is_braces(left)) {
    type_braces(left, right.type);
    return true;
  }
  if (is_braces(right)) {
    type_braces(right, left.type);
    return true;
  }
  const auto is_pair = [&](Kind one, Kind other) {
    return (has_kind(left, one) && has_kind(right, other)) || (has_kind(left, other) && has_kind(right, one));
  };
  if (is_pair(Kind::kDio, Kind::kBool) || is_pair(Kind::kAio, Kind::kNum)) return true;
  const Kind kind = left.type.kind;
  return left.type == right.type && kind != Kind::kVoid && kind != Kind::kSio;
}

/// + - * / % < > <= >=
void ExpressionResolver::resolve_arithmetic(Expression& e) {
  Expression& left = e.parts[0];
  Expression& right = e.parts[1];
  const bool compares = e.text[0] == '<' || e.text[0] == '>';
  if (left.is_unknown || right.is_unknown) {
    e.is_unknown = !compares;
    e.type = kBoolType;
    return;
  }
  if (is_braces(left) && !is_braces(right)) type_braces(left, right.type);
  if (is_braces(right) && !is_braces(left)) type_braces(right, left.type);
  if (left.is_unknown || right.is_unknown) {
    e.is_unknown = true;
    return;
  }
  const auto kind_of = [](const Expression& side) {
    return side.type.kind == Kind::kAio ? Kind::kNum : side.type.kind;
  };
  const Kind kind = kind_of(left);
  const bool is_joint = kind == Kind::kJoint || kind == Kind::kJointRs;
  bool is_defined = kind == Kind::kNum;
  if (e.text == "+") is_defined = is_defined || is_joint || kind == Kind::kString;
  if (e.text == "-" || e.text == "<" || e.text == ">") is_defined = is_defined || is_joint;
  if (e.text == "*") is_defined = is_defined || kind == Kind::kTrsf;
  e.type = compares ? kBoolType : Type{kind, -1};
  if (is_defined && kind == kind_of(right)) return;
  fail(resolver_rules::kOperatorType, e,
       e.text + " is not defined for a " + type_name(left) + " and a " + type_name(right),
       kind == Kind::kString && e.text == "+" ? "write the number by toString()" : "");
}

}  // namespace val3
