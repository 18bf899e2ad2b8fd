#pragma once

#include <string>
#include <vector>

#include "tests/val3/lexer.hpp"
#include "tests/val3/program.hpp"

namespace val3 {

/// Reads expressions from tokens: or, and, comparison, sum, product, sign, in this order of binding. Throws
/// Problem.
class ExpressionParser {
 public:
  ExpressionParser(std::vector<Token> tokens, const std::string& file)
      : tokens_(std::move(tokens)), file_(file) {}

  Expression expression();
  /// "(a, b)", also without any.
  std::vector<Expression> arguments();

  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const {
    return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
  }
  Token next() {
    Token token = peek();
    ++at_;
    return token;
  }
  /// Takes the next token when it is this word or sign.
  bool take(std::string_view text);
  void expect(std::string_view text);
  std::string expect_word();
  [[noreturn]] void fail(const std::string& text) const { throw Problem{file_, peek().line, text}; }

 private:
  Expression conjunction();
  Expression comparison();
  Expression sum();
  Expression product();
  Expression factor();
  Expression name();

  std::vector<Token> tokens_;
  const std::string& file_;
  std::size_t at_ = 0;
};

}  // namespace val3
