#include "sim_controller/val3/language/lexer.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

constexpr std::string_view kKeywords[] = {
    "begin",     "end",  "if",     "elseIf", "else",   "endIf",  "while", "endWhile", "do",
    "until",     "for",  "to",     "step",   "endFor", "switch", "case",  "break",    "default",
    "endSwitch", "call", "return", "true",   "false",  "and",    "or",    "xor"};

// Not of the C library: its answers depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
char lowered(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

class LineLexer {
 public:
  LineLexer(std::string_view line, std::vector<Token>& tokens, std::optional<LineProblem>& warning)
      : line_(line), tokens_(tokens), warning_(warning) {}

  std::optional<LineProblem> run() {
    tokens_.clear();
    std::optional<LineProblem> problem;
    for (skip_blanks(); at_ < line_.size() && !problem; skip_blanks()) problem = one();
    tokens_.push_back({.kind = Token::Kind::kEndOfLine, .column = static_cast<int>(at_) + 1});
    return problem;
  }

 private:
  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  }
  [[nodiscard]] char at(std::size_t offset) const {
    return at_ + offset < line_.size() ? line_[at_ + offset] : '\0';
  }
  [[nodiscard]] LineProblem problem(std::string_view rule, std::string what, std::string remedy = {}) const {
    return {rule, static_cast<int>(at_) + 1, std::move(what), std::move(remedy)};
  }

  void push(Token::Kind kind, std::size_t size, double number = 0.0) {
    tokens_.push_back({kind, line_.substr(at_, size), number, static_cast<int>(at_) + 1});
    at_ += size;
  }

  std::optional<LineProblem> one() {
    const char c = line_[at_];
    if (is_letter(c) || (c == '$' && is_letter(at(1)))) {
      std::size_t size = 1;
      while (is_letter(at(size)) || is_digit(at(size))) ++size;
      push(Token::Kind::kWord, size);
      return std::nullopt;
    }
    if (is_digit(c) || (c == '.' && is_digit(at(1)) && !follows_value())) return number();
    if (c == '"') return text();
    return sign();
  }

  /// A point behind a name or a bracket chooses a field.
  [[nodiscard]] bool follows_value() const {
    if (tokens_.empty()) return false;
    const Token& last = tokens_.back();
    return last.kind == Token::Kind::kWord || last.text == ")" || last.text == "]";
  }

  std::optional<LineProblem> number() {
    std::size_t size = 0;
    while (is_digit(at(size))) ++size;
    if (at(size) == '.') {
      if (!is_digit(at(size + 1)))
        return problem(syntax_rules::kSyntax, "a number that ends in its point",
                       "write digits behind the point");
      ++size;
      while (is_digit(at(size))) ++size;
    }
    double value = 0.0;
    const char* const begin = line_.data() + at_;
    const auto [end, error] = std::from_chars(begin, begin + size, value);
    if (error == std::errc::result_out_of_range)
      return problem(syntax_rules::kNumberTooLarge,
                     "no num holds a number of " + std::to_string(size) + " digits");
    push(Token::Kind::kNumber, size, value);
    return std::nullopt;
  }

  std::optional<LineProblem> text() {
    const std::size_t end = line_.find('"', at_ + 1);
    if (end == std::string_view::npos)
      return problem(syntax_rules::kMissingQuote, "a text without its closing quote",
                     "close it on the same line; a quote inside a text is chr(34)");
    const std::size_t size = end - at_ - 1;
    if (size > kTextBytesMax && !warning_) {
      warning_ = problem(
          syntax_rules::kStringTooLong,
          "a text of " + std::to_string(size) + " bytes; a string holds " + std::to_string(kTextBytesMax),
          "divide it");
      warning_->severity = Severity::kWarning;
    }
    ++at_;
    push(Token::Kind::kText, size);
    tokens_.back().column = static_cast<int>(at_ - size);
    ++at_;
    return std::nullopt;
  }

  std::optional<LineProblem> sign() {
    const char c = line_[at_];
    if (c == '/' && at(1) == '/')
      return problem(syntax_rules::kTrailingComment, "a comment behind an instruction",
                     "give the comment a line of its own");
    for (const std::string_view pair : {"==", "!=", "<=", ">="}) {
      if (!line_.substr(at_).starts_with(pair)) continue;
      push(Token::Kind::kSign, 2);
      return std::nullopt;
    }
    if (c == '<' && at(1) == '>')
      return problem(syntax_rules::kSyntax, "'<>' is no operator", "write != for 'not equal'");
    if (c == '&')
      return problem(syntax_rules::kSyntax, "'&' is no operator",
                     "write 'and'; a reference needs no sign in code");
    if (std::string_view("+-*/%!=<>()[]{},.:?").find(c) == std::string_view::npos)
      return problem(syntax_rules::kSyntax, shown(c) + " has no meaning here");
    push(Token::Kind::kSign, 1);
    return std::nullopt;
  }

  static std::string shown(char c) {
    if (c > ' ' && c <= '~') return std::string("'") + c + "'";
    constexpr std::string_view kDigits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    return std::string("the byte 0x") + kDigits[byte >> 4U] + kDigits[byte & 15U];
  }

  std::string_view line_;
  std::vector<Token>& tokens_;
  std::optional<LineProblem>& warning_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<LineProblem> tokens_of(std::string_view line, std::vector<Token>& tokens,
                                     std::optional<LineProblem>& warning) {
  return LineLexer(line, tokens, warning).run();
}

bool is_keyword(std::string_view word) { return std::ranges::find(kKeywords, word) != std::end(kKeywords); }

std::string_view keyword_like(std::string_view word) {
  const auto* const found = std::ranges::find_if(kKeywords, [&](std::string_view keyword) {
    return std::ranges::equal(keyword, word, {}, lowered, lowered);
  });
  return found == std::end(kKeywords) ? std::string_view{} : *found;
}

}  // namespace val3
