#include "tests/val3/lexer.hpp"

#include <cctype>
#include <charconv>

namespace val3 {
namespace {

bool starts_word(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Where the word, number, text or sign ends that begins at `begin`.
Token token_at(std::string_view line, std::size_t& at, const std::string& file, int number) {
  const std::size_t begin = at;
  if (starts_word(line[at])) {
    // the main task's name ends in ~, but that is text; a word has letters, digits and _
    while (at < line.size() && (starts_word(line[at]) || is_digit(line[at]))) ++at;
    return {TokenKind::kWord, std::string(line.substr(begin, at - begin)), 0.0, number};
  }
  if (is_digit(line[at])) {
    Token token{TokenKind::kNumber, {}, 0.0, number};
    while (at < line.size() && (is_digit(line[at]) || line[at] == '.')) ++at;
    token.text = line.substr(begin, at - begin);
    const auto [end, error] =
        std::from_chars(token.text.data(), token.text.data() + token.text.size(), token.number);
    if (error != std::errc{} || end != token.text.data() + token.text.size())
      throw Problem{file, number, "'" + token.text + "' is no number"};
    return token;
  }
  if (line[at] == '"') {
    const std::size_t end = line.find('"', at + 1);
    if (end == std::string_view::npos) throw Problem{file, number, "a text without its end"};
    at = end + 1;
    return {TokenKind::kText, std::string(line.substr(begin + 1, end - begin - 1)), 0.0, number};
  }
  for (const std::string_view sign : {"==", "!=", "<=", ">=", "<>"}) {
    if (!line.substr(at).starts_with(sign)) continue;
    if (sign == "<>") throw Problem{file, number, "VAL3 writes != for <>"};
    at += 2;
    return {TokenKind::kSign, std::string(sign), 0.0, number};
  }
  if (std::string_view("+-*/%!=<>()[]{},.").find(line[at]) == std::string_view::npos)
    throw Problem{file, number, std::string("'") + line[at] + "' is no sign of VAL3"};
  ++at;
  return {TokenKind::kSign, std::string(line.substr(begin, 1)), 0.0, number};
}

}  // namespace

std::vector<Token> tokens_of(std::string_view code, const std::string& file, int first_line) {
  std::vector<Token> tokens;
  int number = first_line;
  while (!code.empty()) {
    const std::size_t end = std::min(code.find('\n'), code.size());
    std::string_view line = code.substr(0, end);
    code.remove_prefix(std::min(end + 1, code.size()));
    for (std::size_t at = 0; at < line.size();) {
      if (std::isspace(static_cast<unsigned char>(line[at])) != 0) {
        ++at;
      } else if (line.substr(at).starts_with("//")) {
        break;
      } else {
        tokens.push_back(token_at(line, at, file, number));
      }
    }
    tokens.push_back({TokenKind::kEndOfLine, "end of line", 0.0, number});
    ++number;
  }
  tokens.push_back({TokenKind::kEnd, "end of the code", 0.0, number});
  return tokens;
}

}  // namespace val3
