#include "sim_controller/val3/language/expression_parser.hpp"

#include <algorithm>
#include <array>

#include "sim_controller/val3/language/parser.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

/// Operators by rank, loosest first (language reference, 2.4). `-` and `+`, `/`, `*` and `%` are of one rank.
constexpr std::array<std::array<std::string_view, 4>, 7> kBinaryOperators{
    {{"or"}, {"and"}, {"xor"}, {"!=", "=="}, {">=", ">", "<=", "<"}, {"-", "+"}, {"%", "/", "*"}}};

}  // namespace

ExpressionParser::ExpressionParser(const std::vector<Token>& tokens, int line_number)
    : tokens_(tokens), line_(line_number) {}

const Token& ExpressionParser::peek(std::size_t ahead) const {
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

void ExpressionParser::skip() {
  if (!at_end()) ++at_;
}

bool ExpressionParser::is(std::string_view text, std::size_t ahead) const {
  const Token& token = peek(ahead);
  return (token.kind == Token::Kind::kWord || token.kind == Token::Kind::kSign) && token.text == text;
}

bool ExpressionParser::take(std::string_view text) {
  if (!is(text)) return false;
  ++at_;
  return true;
}

std::string ExpressionParser::here() const {
  const Token& token = peek();
  if (token.kind == Token::Kind::kEndOfLine) return "the end of the line";
  if (token.kind == Token::Kind::kText) return "a text";
  return "'" + std::string(token.text) + "'";
}

void ExpressionParser::fail(std::string_view rule, std::string what, std::string remedy) {
  if (!problem_) problem_ = {rule, peek().column, std::move(what), std::move(remedy)};
  at_ = tokens_.size() - 1;
}

void ExpressionParser::expect(std::string_view text) {
  if (take(text) || problem_) return;
  if (is("=") && text != "=")
    return fail(syntax_rules::kAssignmentInExpression, "'=' inside an expression", "to compare, write ==");
  const bool is_bracket = text == ")" || text == "]" || text == "}";
  fail(is_bracket ? syntax_rules::kMissingBracket : syntax_rules::kSyntax,
       "'" + std::string(text) + "' is missing before " + here());
}

void ExpressionParser::expect_end() {
  if (at_end() || problem_) return;
  if (is("="))
    return fail(syntax_rules::kAssignmentInExpression, "'=' inside an expression", "to compare, write ==");
  const bool is_bracket = is(")") || is("]") || is("}");
  fail(is_bracket ? syntax_rules::kMissingBracket : syntax_rules::kTrailingCharacters,
       is_bracket ? here() + " closes nothing" : here() + " is too much on this line",
       is_bracket ? "" : "an operator is missing before it, or it belongs on a line of its own");
}

ExpressionParser::QualifiedName ExpressionParser::name() {
  const auto word = [this]() -> std::string {
    if (peek().kind != Token::Kind::kWord || is_keyword(peek().text)) {
      if (!problem_) fail(syntax_rules::kSyntax, "a name is missing before " + here());
      return {};
    }
    return std::string(tokens_[at_++].text);
  };
  QualifiedName result{{}, word()};
  if (take(":")) {
    result.alias = std::move(result.name);
    result.name = word();
  }
  return result;
}

Expression ExpressionParser::made(Expression::Kind kind) const {
  return {.kind = kind, .line = line_, .column = peek().column};
}

std::vector<Expression> ExpressionParser::list(std::string_view closing) {
  std::vector<Expression> result;
  do result.push_back(expression());
  while (take(","));
  expect(closing);
  return result;
}

std::vector<Expression> ExpressionParser::arguments() {
  expect("(");
  if (take(")")) return {};
  return list(")");
}

Expression ExpressionParser::expression() {
  if (depth_ >= kExpressionDepthMax) {
    fail(syntax_rules::kExpressionTooDeep,
         "an expression is nested deeper than " + std::to_string(kExpressionDepthMax) + " times",
         "divide it over several lines");
    return made(Expression::Kind::kNumber);
  }
  ++depth_;
  Expression result = binary(0);
  --depth_;
  return result;
}

int ExpressionParser::rank_here() const {
  const Token& token = peek();
  if (token.kind != Token::Kind::kSign && token.kind != Token::Kind::kWord) return -1;
  for (std::size_t rank = 0; rank < kBinaryOperators.size(); ++rank)
    for (const std::string_view one : kBinaryOperators[rank])
      if (!one.empty() && one == token.text) return static_cast<int>(rank);
  return -1;
}

/// Operators of this rank and of those that bind closer; equal ones from the left.
Expression ExpressionParser::binary(int rank) {
  Expression left = unary();
  for (int found = rank_here(); found >= rank; found = rank_here()) {
    Expression whole = made(Expression::Kind::kBinary);
    whole.text = std::string(peek().text);
    skip();
    whole.parts.reserve(2);
    whole.parts.push_back(std::move(left));
    whole.parts.push_back(binary(found + 1));
    left = std::move(whole);
  }
  return left;
}

Expression ExpressionParser::unary() {
  if (!is("-") && !is("!")) return operand();
  Expression whole = made(Expression::Kind::kUnary);
  whole.text = std::string(peek().text);
  skip();
  if (is("-") || is("!")) {
    fail(syntax_rules::kTwoUnaryOperators, "two signs in a row before a value",
         "put the inner one between parentheses");
    return whole;
  }
  whole.parts.push_back(operand());
  return whole;
}

void ExpressionParser::fail_for_value() {
  if (problem_) return;
  if (is("=")) return fail(syntax_rules::kSyntax, "a value is missing before '='", "to compare, write ==");
  if (peek().kind == Token::Kind::kWord && is_keyword(peek().text))
    return fail(syntax_rules::kSyntax, "a value is missing before the keyword " + here());
  fail(syntax_rules::kSyntax, "a value is missing before " + here());
}

Expression ExpressionParser::operand() {
  switch (peek().kind) {
    case Token::Kind::kNumber: {
      Expression result = made(Expression::Kind::kNumber);
      result.number = peek().number;
      skip();
      return result;
    }
    case Token::Kind::kText: {
      Expression result = made(Expression::Kind::kText);
      result.text = std::string(peek().text);
      skip();
      return result;
    }
    case Token::Kind::kWord:
      return operand_of_name();
    default:
      break;
  }
  Expression result = made(Expression::Kind::kBraces);
  if (take("(")) {
    Expression inner = expression();
    expect(")");
    return with_elements(std::move(inner));
  }
  if (take("{"))
    result.parts = list("}");
  else
    fail_for_value();
  return result;
}

Expression ExpressionParser::operand_of_name() {
  if (is("true") || is("false")) {
    Expression result = made(Expression::Kind::kTruth);
    result.number = is("true") ? 1.0 : 0.0;
    skip();
    return result;
  }
  Expression result = made(Expression::Kind::kName);
  if (is_keyword(peek().text)) {
    fail_for_value();
    return result;
  }
  QualifiedName named = name();
  result.alias = std::move(named.alias);
  result.text = std::move(named.name);
  if (is("(")) {
    result.kind = Expression::Kind::kCall;
    result.parts = arguments();
  }
  return with_elements(std::move(result));
}

/// `inner` with its indices and fields: inner[i].field[j].
Expression ExpressionParser::with_elements(Expression inner) {
  for (;;) {
    if (is("[")) {
      inner = indexed(std::move(inner));
    } else if (is(".")) {
      skip();
      Expression whole = made(Expression::Kind::kField);
      if (peek().kind != Token::Kind::kWord) {
        fail(syntax_rules::kSyntax, "the name of a field is missing before " + here());
        return inner;
      }
      whole.text = std::string(peek().text);
      skip();
      whole.parts.push_back(std::move(inner));
      inner = std::move(whole);
    } else {
      return inner;
    }
  }
}

Expression ExpressionParser::indexed(Expression inner) {
  Expression whole = made(Expression::Kind::kIndex);
  skip();
  std::vector<Expression> indices = list("]");
  if (indices.size() > 3)
    fail(syntax_rules::kSyntax, std::to_string(indices.size()) + " indices; an array has three at most");
  whole.parts.reserve(indices.size() + 1);
  whole.parts.push_back(std::move(inner));
  for (Expression& index : indices) whole.parts.push_back(std::move(index));
  return whole;
}

bool can_be_assigned(const Expression& expression) {
  switch (expression.kind) {
    case Expression::Kind::kName:
      return true;
    case Expression::Kind::kIndex:
    case Expression::Kind::kField:
      return can_be_assigned(expression.parts[0]);
    default:
      return false;
  }
}

}  // namespace val3
