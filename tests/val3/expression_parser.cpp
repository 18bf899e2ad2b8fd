#include "tests/val3/expression_parser.hpp"

namespace val3 {
namespace {

Expression binary(std::string sign, Expression left, Expression right) {
  Expression result{.kind = ExpressionKind::kBinary, .line = left.line, .text = std::move(sign)};
  result.parts.push_back(std::move(left));
  result.parts.push_back(std::move(right));
  return result;
}

}  // namespace

bool ExpressionParser::take(std::string_view text) {
  const Token& token = peek();
  if ((token.kind != TokenKind::kWord && token.kind != TokenKind::kSign) || token.text != text) return false;
  ++at_;
  return true;
}

void ExpressionParser::expect(std::string_view text) {
  if (!take(text)) fail("expected '" + std::string(text) + "' before '" + peek().text + "'");
}

std::string ExpressionParser::expect_word() {
  if (peek().kind != TokenKind::kWord) fail("expected a name before '" + peek().text + "'");
  return next().text;
}

std::vector<Expression> ExpressionParser::arguments() {
  std::vector<Expression> result;
  expect("(");
  if (take(")")) return result;
  do result.push_back(expression());
  while (take(","));
  expect(")");
  return result;
}

Expression ExpressionParser::expression() {
  Expression left = conjunction();
  while (take("or")) left = binary("or", std::move(left), conjunction());
  return left;
}

Expression ExpressionParser::conjunction() {
  Expression left = comparison();
  while (take("and")) left = binary("and", std::move(left), comparison());
  return left;
}

Expression ExpressionParser::comparison() {
  Expression left = sum();
  for (const char* sign : {"==", "!=", "<=", ">=", "<", ">"})
    if (take(sign)) return binary(sign, std::move(left), sum());
  return left;
}

Expression ExpressionParser::sum() {
  Expression left = product();
  for (;;) {
    if (take("+"))
      left = binary("+", std::move(left), product());
    else if (take("-"))
      left = binary("-", std::move(left), product());
    else
      return left;
  }
}

Expression ExpressionParser::product() {
  Expression left = factor();
  for (;;) {
    if (take("*"))
      left = binary("*", std::move(left), factor());
    else if (take("/"))
      left = binary("/", std::move(left), factor());
    else if (take("%"))
      left = binary("%", std::move(left), factor());
    else
      return left;
  }
}

Expression ExpressionParser::factor() {
  const int line = peek().line;
  for (const char* sign : {"-", "!"}) {
    if (!take(sign)) continue;
    Expression result{.kind = ExpressionKind::kUnary, .line = line, .text = sign};
    result.parts.push_back(factor());
    return result;
  }
  if (take("(")) {
    Expression inner = expression();
    expect(")");
    return inner;
  }
  if (take("{")) {
    Expression result{.kind = ExpressionKind::kBraces, .line = line};
    do result.parts.push_back(expression());
    while (take(","));
    expect("}");
    return result;
  }
  if (take("true") || take("false")) {
    const bool truth = tokens_[at_ - 1].text == "true";
    return {.kind = ExpressionKind::kTruth, .line = line, .number = truth ? 1.0 : 0.0};
  }
  switch (peek().kind) {
    case TokenKind::kNumber:
      return {.kind = ExpressionKind::kNumber, .line = line, .number = next().number};
    case TokenKind::kText:
      return {.kind = ExpressionKind::kText, .line = line, .text = next().text};
    case TokenKind::kWord:
      return name();
    default:
      fail("expected a value before '" + peek().text + "'");
  }
}

Expression ExpressionParser::name() {
  Expression result{.kind = ExpressionKind::kName, .line = peek().line, .text = expect_word()};
  if (peek().kind == TokenKind::kSign && peek().text == "(") {
    result.kind = ExpressionKind::kInstruction;
    result.parts = arguments();
    return result;
  }
  if (take("[")) {
    result.parts.push_back(expression());
    expect("]");
  }
  while (take(".")) result.fields.push_back(expect_word());
  return result;
}

}  // namespace val3
