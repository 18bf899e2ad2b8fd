#include "sim_controller/val3/language/parser.hpp"

#include <algorithm>

#include "sim_controller/val3/language/block_links.hpp"
#include "sim_controller/val3/language/expression_parser.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

struct LineWord {
  std::string_view word;
  Line::Kind kind;
};
/// Words that a line begins with, and that make it what it is.
constexpr LineWord kLineWords[] = {
    {"call", Line::Kind::kCall},
    {"taskCreate", Line::Kind::kTaskCreate},
    {"taskCreateSync", Line::Kind::kTaskCreateSync},
    {"if", Line::Kind::kIf},
    {"elseIf", Line::Kind::kElseIf},
    {"else", Line::Kind::kElse},
    {"endIf", Line::Kind::kEndIf},
    {"while", Line::Kind::kWhile},
    {"endWhile", Line::Kind::kEndWhile},
    {"do", Line::Kind::kDo},
    {"until", Line::Kind::kUntil},
    {"for", Line::Kind::kFor},
    {"endFor", Line::Kind::kEndFor},
    {"switch", Line::Kind::kSwitch},
    {"case", Line::Kind::kCase},
    {"default", Line::Kind::kDefault},
    {"break", Line::Kind::kBreak},
    {"endSwitch", Line::Kind::kEndSwitch},
    {"return", Line::Kind::kReturn},
};

const LineWord* line_word(std::string_view word) {
  const auto* const found = std::ranges::find(kLineWords, word, &LineWord::word);
  return found == std::end(kLineWords) ? nullptr : found;
}

/// The text between two ends of lines, without blanks around it.
std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

void parse_task(ExpressionParser& in, Line& line, int leading) {
  for (int i = 0; i < leading; ++i) {
    line.expressions.push_back(in.expression());
    in.expect(",");
  }
  auto [alias, program] = in.name();
  line.alias = std::move(alias);
  line.program = std::move(program);
  for (Expression& argument : in.arguments()) line.expressions.push_back(std::move(argument));
}

void parse_for(ExpressionParser& in, Line& line) {
  line.expressions.push_back(in.expression());
  if (!in.problem() && !can_be_assigned(line.expressions.back()))
    in.fail(syntax_rules::kAssignmentTarget, "'for' does not count in a variable");
  in.expect("=");
  line.expressions.push_back(in.expression());
  in.expect("to");
  line.expressions.push_back(in.expression());
  if (in.take("step")) line.expressions.push_back(in.expression());
}

/// An assignment, or an instruction that stands alone.
void parse_plain(ExpressionParser& in, Line& line) {
  line.expressions.push_back(in.expression());
  while (!in.problem() && in.is("=")) {
    if (!can_be_assigned(line.expressions.back())) {
      in.fail(line.expressions.size() == 1 ? syntax_rules::kAssignmentTarget
                                           : syntax_rules::kAssignmentInExpression,
              "what stands left of '=' is no variable", "to compare, write ==");
      return;
    }
    in.skip();
    line.expressions.push_back(in.expression());
  }
  if (in.problem() || !in.at_end()) return;
  const Expression& last = line.expressions.back();
  if (line.expressions.size() > 1) {
    line.kind = Line::Kind::kAssign;
  } else if (last.kind == Expression::Kind::kCall) {
    line.kind = Line::Kind::kInstruction;
  } else if (last.kind == Expression::Kind::kBinary && last.text == "==") {
    in.fail(syntax_rules::kNoEffect, "a comparison stands alone", "to assign, write =");
  } else {
    in.fail(
        syntax_rules::kNoEffect, "the line does nothing",
        last.kind == Expression::Kind::kName ? "an instruction has parentheses: " + last.text + "()" : "");
  }
}

/// Words that say all by themselves: what stands behind them is told, and the block keeps them.
bool has_no_content(Line::Kind kind) {
  switch (kind) {
    case Line::Kind::kElse:
    case Line::Kind::kEndIf:
    case Line::Kind::kEndWhile:
    case Line::Kind::kDo:
    case Line::Kind::kEndFor:
    case Line::Kind::kDefault:
    case Line::Kind::kBreak:
    case Line::Kind::kEndSwitch:
      return true;
    default:
      return false;
  }
}

/// Stands for the condition of an `until` that cannot be read, which closes its block all the same.
Expression placeholder(const Line& line) {
  return {.kind = Expression::Kind::kTruth, .line = line.line, .column = line.column, .number = 1.0};
}

/// `?value`, which s8 has for put(value).
void parse_shorthand(ExpressionParser& in, Line& line) {
  Expression put{.kind = Expression::Kind::kCall, .line = line.line, .column = line.column, .text = "put"};
  in.skip();
  put.parts.push_back(in.expression());
  line.kind = Line::Kind::kInstruction;
  line.is_shorthand = true;
  line.expressions.push_back(std::move(put));
}

void parse_line_of(Line::Kind kind, ExpressionParser& in, Line& line) {
  line.kind = kind;
  switch (kind) {
    case Line::Kind::kCall: {
      auto [alias, program] = in.name();
      line.alias = std::move(alias);
      line.program = std::move(program);
      line.expressions = in.arguments();
      return;
    }
    case Line::Kind::kTaskCreate:
      return parse_task(in, line, 2);
    case Line::Kind::kTaskCreateSync:
      return parse_task(in, line, 3);
    case Line::Kind::kFor:
      return parse_for(in, line);
    case Line::Kind::kIf:
    case Line::Kind::kElseIf:
    case Line::Kind::kWhile:
    case Line::Kind::kUntil:
    case Line::Kind::kSwitch:
      line.expressions.push_back(in.expression());
      return;
    case Line::Kind::kCase:
      do line.expressions.push_back(in.expression());
      while (in.take(","));
      return;
    default:
      return;
  }
}

class ProgramParser {
 public:
  ProgramParser(const std::string& file, Findings& findings) : file_(file), findings_(findings) {}

  std::vector<Line> run(std::string_view code, int first_line) {
    number_ = first_line;
    for (bool more = true; more; ++number_) {
      const std::size_t end = std::min(code.find('\n'), code.size());
      line(code.substr(0, end));
      more = end < code.size() && told_ < kFindingsPerProgramMax;
      code.remove_prefix(std::min(end + 1, code.size()));
    }
    --number_;
    if (told_ >= kFindingsPerProgramMax)
      tell({syntax_rules::kTooManyFindings, 0, "the program is not read behind this line", {}}, number_);
    return finish();
  }

 private:
  enum class Stage { kBefore, kInside, kBehind };

  std::vector<Line> finish() {
    const bool read_whole = told_ < kFindingsPerProgramMax;
    if (read_whole && stage_ == Stage::kBefore)
      tell({syntax_rules::kMissingBegin, 0, "the program has no 'begin'", "begin its code with 'begin'"},
           number_);
    if (read_whole && stage_ == Stage::kInside)
      tell({syntax_rules::kMissingEnd, 0, "the program has no 'end'", "end its code with 'end'"}, number_);
    if (read_whole) links_.close_all();
    tell_of_blocks();
    if (lines_.empty() || lines_.back().kind != Line::Kind::kEnd) lines_.push_back(end_line());
    return std::move(lines_);
  }

  void tell(const LineProblem& problem, int at) {
    findings_.push_back({problem.severity,
                         std::string(problem.rule),
                         {file_, at, problem.column},
                         problem.what,
                         problem.remedy});
    ++told_;
  }
  void tell(const LineProblem& problem) { tell(problem, number_); }
  void tell_of_blocks() {
    for (const auto& [problem, at] : links_.take_told()) tell(problem, at);
  }

  void line(std::string_view raw) {
    const std::string_view text = trimmed(raw);
    if (text.empty() || text.starts_with("//")) return;
    const auto indent = static_cast<int>(text.data() - raw.data());
    if (text.starts_with(';'))
      return tell({syntax_rules::kDisabledLine,
                   indent + 1,
                   "a line that begins with ';' is not run",
                   {},
                   Severity::kNote});
    if (raw.size() > kLineBytesMax) {
      tell({syntax_rules::kLineTooLong, 0,
            "a line of " + std::to_string(raw.size()) + " bytes; at most " + std::to_string(kLineBytesMax) +
                " are read",
            "divide it"});
      return;
    }
    std::optional<LineProblem> warning;
    const auto problem = tokens_of(raw, tokens_, warning);
    if (warning) tell(*warning);
    in_stage(raw, problem);
  }

  void in_stage(std::string_view raw, const std::optional<LineProblem>& problem) {
    const std::string_view text = trimmed(raw);
    if (stage_ == Stage::kBehind)
      return tell({syntax_rules::kCodeBehindEnd, tokens_[0].column, "a line behind the program's 'end'",
                   "move it before 'end'"});
    if (stage_ == Stage::kBefore) {
      stage_ = Stage::kInside;
      if (text == "begin") return;
      tell({syntax_rules::kMissingBegin, tokens_[0].column, "the program does not begin with 'begin'",
            "begin its code with a line 'begin'"});
    }
    if (text == "end") {
      lines_.push_back(end_line());
      stage_ = Stage::kBehind;
      return;
    }
    parse_one(problem);
  }

  Line end_line() {
    Line end{.kind = Line::Kind::kEnd, .line = number_, .column = 1};
    end.open = end.next = end.close = lines_.size();
    return end;
  }

  /// The keyword a line begins with, also in another case: the block stays paired, and the case is told.
  Line::Kind kind_of_line() {
    if (tokens_[0].kind != Token::Kind::kWord) return Line::Kind::kAssign;
    const std::string_view word = tokens_[0].text;
    if (const LineWord* const exact = line_word(word)) return exact->kind;
    const LineWord* const meant = line_word(keyword_like(word));
    if (meant == nullptr) return Line::Kind::kAssign;
    for (const std::string_view sign : {"=", "[", ".", ":"})
      if (tokens_[1].kind == Token::Kind::kSign && tokens_[1].text == sign) return Line::Kind::kAssign;
    tell({syntax_rules::kKeywordCase, tokens_[0].column,
          "'" + std::string(word) + "' is written as no keyword is", "write " + std::string(meant->word)});
    return meant->kind;
  }

  void parse_one(std::optional<LineProblem> problem) {
    Line line{.line = number_, .column = tokens_[0].column};
    ExpressionParser in(tokens_, number_);
    const Line::Kind kind = kind_of_line();
    if (!problem || problem->column > line.column) parse_content(kind, in, line);
    // What the lexer could not read stands at the end of the tokens: a parser's problem before it is told.
    if (in.problem() && (!problem || in.problem()->column < problem->column)) problem = in.problem();
    if (problem) tell(*problem);
    line.kind = kind == Line::Kind::kAssign ? line.kind : kind;
    line.open = line.next = line.close = lines_.size();
    if (problem && kind == Line::Kind::kUntil) line.expressions = {placeholder(line)};
    const bool is_read = !problem || has_no_content(kind);
    if (links_.add(lines_, line, is_read)) lines_.push_back(std::move(line));
    tell_of_blocks();
  }

  static void parse_content(Line::Kind kind, ExpressionParser& in, Line& line) {
    if (kind != Line::Kind::kAssign) {
      in.skip();
      parse_line_of(kind, in, line);
    } else if (in.is("?")) {
      parse_shorthand(in, line);
    } else {
      parse_plain(in, line);
    }
    in.expect_end();
  }

  const std::string& file_;
  Findings& findings_;
  Stage stage_ = Stage::kBefore;
  int number_ = 1;
  std::size_t told_ = 0;
  std::vector<Token> tokens_;
  std::vector<Line> lines_;
  BlockLinks links_;
};

}  // namespace

std::vector<Line> parse(std::string_view code, const std::string& file, int first_line, Findings& findings) {
  return ProgramParser(file, findings).run(code, first_line);
}

}  // namespace val3
