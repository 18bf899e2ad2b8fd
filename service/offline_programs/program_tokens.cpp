#include "service/offline_programs/program_tokens.hpp"

#include <algorithm>
#include <charconv>

namespace cell {
namespace {

// Not of the C library: its answers depend on the locale.
bool begins_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }
bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t word_size(std::string_view rest) {
  std::size_t size = 1;
  while (size < rest.size() && (begins_word(rest[size]) || is_decimal_digit(rest[size]))) ++size;
  return size;
}

std::size_t digits_size(std::string_view rest) {
  std::size_t size = 0;
  while (size < rest.size() && (is_decimal_digit(rest[size]) || rest[size] == '.')) ++size;
  return size;
}

bool begins_number(std::string_view rest, const std::vector<ProgramToken>& before) {
  if (is_decimal_digit(rest[0])) return true;
  if (rest[0] != '.' || rest.size() < 2 || !is_decimal_digit(rest[1])) return false;
  // A point behind a name or a bracket chooses a field.
  return before.empty() || (before.back().kind != ProgramToken::Kind::kWord && before.back().text != "]" &&
                            before.back().text != ")");
}

std::size_t sign_size(std::string_view rest) {
  for (const std::string_view pair : {"==", "!=", "<=", ">="})
    if (rest.starts_with(pair)) return 2;
  return 1;
}

}  // namespace

std::vector<ProgramToken> program_tokens(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r\f\v";
  std::vector<ProgramToken> tokens;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    if (line.empty() || (tokens.empty() && line.starts_with("//"))) return tokens;
    ProgramToken token;
    std::size_t size = 0;
    if (line[0] == '"') {
      const std::size_t end = std::min(line.find('"', 1), line.size());
      token = {ProgramToken::Kind::kText, line.substr(1, end - 1)};
      size = std::min(end + 1, line.size());
    } else if (begins_word(line[0])) {
      size = word_size(line);
      token = {ProgramToken::Kind::kWord, line.substr(0, size)};
    } else if (begins_number(line, tokens)) {
      size = digits_size(line);
      token = {ProgramToken::Kind::kNumber, line.substr(0, size)};
      std::from_chars(line.data(), line.data() + size, token.number);
    } else {
      size = sign_size(line);
      token = {ProgramToken::Kind::kSign, line.substr(0, size)};
    }
    tokens.push_back(token);
    line.remove_prefix(size);
  }
}

std::size_t closing_of(const std::vector<ProgramToken>& tokens, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    if (tokens[i].kind != ProgramToken::Kind::kSign) continue;
    const char sign = tokens[i].text[0];
    if (sign == '(' || sign == '[' || sign == '{') ++depth;
    if (sign == ')' || sign == ']' || sign == '}')
      if (--depth == 0) return i;
  }
  return tokens.size();
}

std::vector<TokenRange> listed_in(const std::vector<ProgramToken>& tokens, std::size_t open) {
  std::vector<TokenRange> ranges;
  const std::size_t close = closing_of(tokens, open);
  std::size_t begin = open + 1;
  for (std::size_t i = begin; i < close; ++i) {
    if (is_sign(tokens, i, "(") || is_sign(tokens, i, "[") || is_sign(tokens, i, "{")) {
      i = std::min(closing_of(tokens, i), close - 1);
    } else if (is_sign(tokens, i, ",")) {
      ranges.emplace_back(begin, i);
      begin = i + 1;
    }
  }
  if (begin < close) ranges.emplace_back(begin, close);
  return ranges;
}

bool is_sign(const std::vector<ProgramToken>& tokens, std::size_t place, std::string_view sign) {
  return place < tokens.size() && tokens[place].kind == ProgramToken::Kind::kSign &&
         tokens[place].text == sign;
}

bool is_own_name(const std::vector<ProgramToken>& tokens, std::size_t place) {
  if (place >= tokens.size() || tokens[place].kind != ProgramToken::Kind::kWord) return false;
  if (place > 0 && (is_sign(tokens, place - 1, ".") || is_sign(tokens, place - 1, ":"))) return false;
  return !is_sign(tokens, place + 1, ":");
}

}  // namespace cell
