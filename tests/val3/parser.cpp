#include "tests/val3/parser.hpp"

#include <set>

#include "tests/val3/expression_parser.hpp"

namespace val3 {
namespace {

const std::set<std::string, std::less<>> kBlockEnds{
    "end", "elseIf", "else", "endIf", "endWhile", "endFor", "until", "case", "default", "endSwitch", "break"};

class Parser {
 public:
  Parser(std::string_view code, const std::string& file, int first_line)
      : in_(tokens_of(code, file, first_line), file) {}

  std::vector<Statement> program() {
    skip_empty();
    in_.expect("begin");
    end_line();
    block();
    add({.kind = StatementKind::kReturn});
    in_.expect("end");
    end_line();
    skip_empty();
    if (in_.peek().kind != TokenKind::kEnd) in_.fail("code behind 'end'");
    return std::move(statements_);
  }

 private:
  std::size_t add(Statement statement) {
    statement.line = in_.peek().line;
    statements_.push_back(std::move(statement));
    return statements_.size() - 1;
  }
  std::size_t add_at(int line, Statement statement) {
    const std::size_t index = add(std::move(statement));
    statements_[index].line = line;
    return index;
  }
  void land_here(std::size_t jump) { statements_[jump].target = statements_.size(); }

  void end_line() {
    if (in_.peek().kind == TokenKind::kEnd) return;
    if (in_.peek().kind != TokenKind::kEndOfLine)
      in_.fail("'" + in_.peek().text + "' is too much on this line");
    in_.next();
  }
  void skip_empty() {
    while (in_.peek().kind == TokenKind::kEndOfLine) in_.next();
  }

  /// Statements up to a word that ends or divides a block, which is left.
  void block() {
    for (;;) {
      skip_empty();
      const Token& token = in_.peek();
      if (token.kind == TokenKind::kEnd) in_.fail("a block without its end");
      if (token.kind == TokenKind::kWord && kBlockEnds.contains(token.text)) return;
      statement();
    }
  }

  void statement() {
    const int line = in_.peek().line;
    if (in_.take("if")) return if_block(line);
    if (in_.take("while")) return while_block(line);
    if (in_.take("for")) return for_block(line);
    if (in_.take("do")) return do_block();
    if (in_.take("switch")) return switch_block();
    if (in_.take("return")) {
      add_at(line, {.kind = StatementKind::kReturn});
    } else if (in_.take("call")) {
      Statement call{.kind = StatementKind::kCall, .program = in_.expect_word()};
      call.expressions = in_.arguments();
      add_at(line, std::move(call));
    } else if (in_.take("taskCreate")) {
      task(line, StatementKind::kTaskCreate, 2);
    } else if (in_.take("taskCreateSync")) {
      task(line, StatementKind::kTaskCreateSync, 3);
    } else {
      plain(line);
    }
    end_line();
  }

  void task(int line, StatementKind kind, int leading) {
    Statement create{.kind = kind};
    for (int i = 0; i < leading; ++i) {
      create.expressions.push_back(in_.expression());
      in_.expect(",");
    }
    create.program = in_.expect_word();
    for (Expression& argument : in_.arguments()) create.expressions.push_back(std::move(argument));
    add_at(line, std::move(create));
  }

  /// An assignment or an instruction.
  void plain(int line) {
    if (in_.peek().kind != TokenKind::kWord) in_.fail("no statement begins with '" + in_.peek().text + "'");
    Expression first = in_.expression();
    if (first.kind == ExpressionKind::kInstruction) {
      add_at(line, {.kind = StatementKind::kInstruction, .expressions = {std::move(first)}});
      return;
    }
    if (first.kind != ExpressionKind::kName) in_.fail("neither an assignment nor an instruction");
    in_.expect("=");
    Expression value = in_.expression();
    add_at(line, {.kind = StatementKind::kAssign, .expressions = {std::move(first), std::move(value)}});
  }

  std::size_t condition(int line) {
    Statement jump{.kind = StatementKind::kJumpUnless, .expressions = {in_.expression()}};
    return add_at(line, std::move(jump));
  }

  void if_block(int line) {
    std::vector<std::size_t> to_end;
    std::size_t otherwise = condition(line);
    bool else_seen = false;
    for (;;) {
      end_line();
      block();
      if (in_.take("endIf")) break;
      if (else_seen) in_.fail("'" + in_.peek().text + "' behind 'else'");
      to_end.push_back(add({.kind = StatementKind::kJump}));
      land_here(otherwise);
      const int branch_line = in_.peek().line;
      if (in_.take("elseIf")) {
        otherwise = condition(branch_line);
      } else {
        if (!in_.take("else")) in_.expect("endIf");
        else_seen = true;
      }
    }
    if (!else_seen) land_here(otherwise);
    for (const std::size_t jump : to_end) land_here(jump);
    end_line();
  }

  void while_block(int line) {
    const std::size_t exit = condition(line);
    end_line();
    block();
    in_.expect("endWhile");
    add({.kind = StatementKind::kJump, .target = exit});
    land_here(exit);
    end_line();
  }

  void do_block() {
    const std::size_t begin = statements_.size();
    end_line();
    block();
    const int line = in_.peek().line;
    in_.expect("until");
    statements_[condition(line)].target = begin;
    end_line();
  }

  void for_block(int line) {
    const Expression counter = in_.expression();
    if (counter.kind != ExpressionKind::kName) in_.fail("'for' counts in a variable");
    in_.expect("=");
    Expression first = in_.expression();
    in_.expect("to");
    Expression last = in_.expression();
    Expression step{.kind = ExpressionKind::kNumber, .line = line, .number = 1.0};
    if (in_.take("step")) step = in_.expression();
    add_at(line, {.kind = StatementKind::kAssign, .expressions = {counter, std::move(first)}});
    const std::size_t exit = add_at(
        line, {.kind = StatementKind::kJumpUnlessFor, .expressions = {counter, std::move(last), step}});
    end_line();
    block();
    in_.expect("endFor");
    Expression sum{
        .kind = ExpressionKind::kBinary, .line = line, .text = "+", .parts = {counter, std::move(step)}};
    add({.kind = StatementKind::kAssign, .expressions = {counter, std::move(sum)}});
    add({.kind = StatementKind::kJump, .target = exit});
    land_here(exit);
    end_line();
  }

  void switch_block() {
    const Expression selector = in_.expression();
    end_line();
    skip_empty();
    std::vector<std::size_t> to_end;
    while (!in_.take("endSwitch")) {
      const int line = in_.peek().line;
      Statement jump{.kind = StatementKind::kJumpUnlessCase, .expressions = {selector}};
      const bool is_default = in_.take("default");
      if (!is_default) {
        in_.expect("case");
        do jump.expressions.push_back(in_.expression());
        while (in_.take(","));
      }
      const std::size_t next_case = is_default ? 0 : add_at(line, std::move(jump));
      end_line();
      block();
      in_.expect("break");
      end_line();
      skip_empty();
      to_end.push_back(add({.kind = StatementKind::kJump}));
      if (!is_default) land_here(next_case);
      if (is_default && (in_.peek().text != "endSwitch")) in_.fail("a case behind 'default'");
    }
    for (const std::size_t jump : to_end) land_here(jump);
    end_line();
  }

  ExpressionParser in_;
  std::vector<Statement> statements_;
};

}  // namespace

std::vector<Statement> parse(std::string_view code, const std::string& file, int first_line) {
  return Parser(code, file, first_line).program();
}

}  // namespace val3
