#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/language/lexer.hpp"
#include "sim_controller/val3/program/syntax.hpp"

namespace val3 {

/// Reads the expressions of one line, from its tokens. The first thing that is wrong is kept as problem();
/// from then on the parser stands at the line's end, so that nothing else is taken.
class ExpressionParser {
 public:
  /// The tokens end with kEndOfLine and outlive the parser.
  ExpressionParser(const std::vector<Token>& tokens, int line_number);

  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const;
  [[nodiscard]] bool at_end() const { return peek().kind == Token::Kind::kEndOfLine; }
  void skip();
  /// A keyword or a sign.
  bool take(std::string_view text);
  [[nodiscard]] bool is(std::string_view text, std::size_t ahead = 0) const;
  void expect(std::string_view text);
  /// Nothing more on this line.
  void expect_end();

  struct QualifiedName {
    std::string alias;
    std::string name;
  };
  /// A name, with or without its library's alias.
  QualifiedName name();
  Expression expression();
  /// Between parentheses, separated by commas.
  std::vector<Expression> arguments();

  void fail(std::string_view rule, std::string what, std::string remedy = {});
  [[nodiscard]] const std::optional<LineProblem>& problem() const { return problem_; }

 private:
  Expression binary(int rank);
  Expression unary();
  Expression operand();
  Expression operand_of_name();
  Expression with_elements(Expression inner);
  Expression indexed(Expression inner);
  std::vector<Expression> list(std::string_view closing);
  [[nodiscard]] int rank_here() const;
  [[nodiscard]] Expression made(Expression::Kind kind) const;
  void fail_for_value();
  [[nodiscard]] std::string here() const;

  const std::vector<Token>& tokens_;
  std::size_t at_ = 0;
  int line_;
  int depth_ = 0;
  std::optional<LineProblem> problem_;
};

/// A variable, or an element or a field of one.
bool can_be_assigned(const Expression& expression);

}  // namespace val3
