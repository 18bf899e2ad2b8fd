#include "sim_controller/val3/language/block_links.hpp"

#include <algorithm>
#include <utility>

#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

struct BlockWords {
  Line::Kind open;
  Line::Kind close;
  std::string_view open_word;
  std::string_view close_word;
};
constexpr BlockWords kBlockWords[] = {
    {Line::Kind::kIf, Line::Kind::kEndIf, "if", "endIf"},
    {Line::Kind::kWhile, Line::Kind::kEndWhile, "while", "endWhile"},
    {Line::Kind::kDo, Line::Kind::kUntil, "do", "until"},
    {Line::Kind::kFor, Line::Kind::kEndFor, "for", "endFor"},
    {Line::Kind::kSwitch, Line::Kind::kEndSwitch, "switch", "endSwitch"},
};

/// The block that a line of this kind opens, closes or divides; null for other lines.
const BlockWords* block_of(Line::Kind kind) {
  switch (kind) {
    case Line::Kind::kElse:
    case Line::Kind::kElseIf:
      return &kBlockWords[0];
    case Line::Kind::kCase:
    case Line::Kind::kDefault:
      return &kBlockWords[4];
    default:
      break;
  }
  const auto* const found = std::ranges::find_if(
      kBlockWords, [kind](const BlockWords& words) { return words.open == kind || words.close == kind; });
  return found == std::end(kBlockWords) ? nullptr : found;
}

std::string word_of_block_line(Line::Kind kind) {
  switch (kind) {
    case Line::Kind::kElse:
      return "else";
    case Line::Kind::kElseIf:
      return "elseIf";
    case Line::Kind::kCase:
      return "case";
    case Line::Kind::kDefault:
      return "default";
    default:
      break;
  }
  const BlockWords* const words = block_of(kind);
  if (words == nullptr) return {};
  return std::string(words->open == kind ? words->open_word : words->close_word);
}

}  // namespace

void BlockLinks::tell(std::string_view rule, const std::string& what, const std::string& remedy, int line,
                      int column) {
  told_.push_back({{rule, column, what, remedy}, line});
}

std::vector<BlockLinks::Told> BlockLinks::take_told() { return std::exchange(told_, {}); }

bool BlockLinks::add(std::vector<Line>& lines, Line& line, bool is_read) {
  switch (line.kind) {
    case Line::Kind::kIf:
    case Line::Kind::kWhile:
    case Line::Kind::kDo:
    case Line::Kind::kFor:
    case Line::Kind::kSwitch:
      check_in_case(line);
      open_block(lines, line, is_read);
      return is_read;
    case Line::Kind::kElse:
    case Line::Kind::kElseIf:
    case Line::Kind::kCase:
    case Line::Kind::kDefault:
      return label(lines, line, is_read);
    case Line::Kind::kBreak:
      return break_line(lines, line);
    case Line::Kind::kEndIf:
    case Line::Kind::kEndWhile:
    case Line::Kind::kUntil:
    case Line::Kind::kEndFor:
    case Line::Kind::kEndSwitch:
      return close_block(lines, line);
    default:
      check_in_case(line);
      return is_read;
  }
}

void BlockLinks::open_block(const std::vector<Line>& lines, const Line& line, bool is_read) {
  blocks_.push_back({.kind = line.kind,
                     .line = line.line,
                     .column = line.column,
                     .is_kept = is_read,
                     .open = lines.size(),
                     .last = lines.size()});
}

bool BlockLinks::find_block(const Line& line) {
  const BlockWords& words = *block_of(line.kind);
  const auto found = std::find_if(blocks_.rbegin(), blocks_.rend(),
                                  [&](const Block& block) { return block.kind == words.open; });
  if (found == blocks_.rend()) {
    tell(syntax_rules::kUnpairedBlock,
         "'" + word_of_block_line(line.kind) + "' without '" + std::string(words.open_word) + "'",
         "remove it, or write the line that opens the block", line.line, line.column);
    return false;
  }
  const auto keep = static_cast<std::size_t>(blocks_.rend() - found);
  while (blocks_.size() > keep) {
    const Block& open = blocks_.back();
    const BlockWords& inner = *block_of(open.kind);
    tell(syntax_rules::kUnpairedBlock,
         "'" + std::string(inner.open_word) + "' without '" + std::string(inner.close_word) + "' before '" +
             word_of_block_line(line.kind) + "' in line " + std::to_string(line.line),
         "close it with " + std::string(inner.close_word), open.line, open.column);
    blocks_.pop_back();
  }
  return true;
}

void BlockLinks::check_case_end() {
  const Block& block = blocks_.back();
  if (block.case_line == 0 || block.case_ended) return;
  tell(syntax_rules::kCaseWithoutBreak, "a case that does not end with 'break'",
       "write 'break' as its last line", block.case_line, 0);
}

void BlockLinks::check_in_case(const Line& line) {
  if (blocks_.empty() || blocks_.back().kind != Line::Kind::kSwitch) return;
  const Block& block = blocks_.back();
  if (block.case_line != 0 && !block.case_ended) return;
  tell(syntax_rules::kLineOutsideCase, "a line of a switch that is in none of its cases",
       block.case_line == 0 ? "move it behind a 'case'" : "move it before 'break'", line.line, line.column);
}

void BlockLinks::follow(std::vector<Line>& lines, Block& block, std::size_t at) const {
  lines[block.last].next = at;
  block.last = at;
  if (block.pending_break) lines[*block.pending_break].next = at;
  block.pending_break.reset();
}

bool BlockLinks::label(std::vector<Line>& lines, Line& line, bool is_read) {
  if (!find_block(line)) return false;
  Block& block = blocks_.back();
  const bool is_case = block.kind == Line::Kind::kSwitch;
  if (is_case) check_case_end();
  if (block.last_label_seen)
    tell(is_case ? syntax_rules::kCaseAfterDefault : syntax_rules::kUnpairedBlock,
         "'" + word_of_block_line(line.kind) + "' behind '" + (is_case ? "default" : "else") + "'",
         is_case ? "'default' is the last of a switch" : "'else' is the last branch of an if", line.line,
         line.column);
  block.last_label_seen |= line.kind == Line::Kind::kElse || line.kind == Line::Kind::kDefault;
  block.case_line = line.line;
  block.case_ended = false;
  if (!is_read || !block.is_kept) return false;
  line.open = block.open;
  // The line is not in `lines` yet; what comes before points to where it is going to be.
  follow(lines, block, lines.size());
  return true;
}

bool BlockLinks::break_line(const std::vector<Line>& lines, Line& line) {
  const bool in_switch = !blocks_.empty() && blocks_.back().kind == Line::Kind::kSwitch;
  if (!in_switch || blocks_.back().case_line == 0 || blocks_.back().case_ended) {
    const bool deeper =
        !in_switch && std::ranges::find(blocks_, Line::Kind::kSwitch, &Block::kind) != blocks_.end();
    tell(syntax_rules::kBreakOutsideCase,
         deeper ? "'break' inside a block inside a case" : "'break' outside of a case",
         "'break' is the last line of a case, and only that", line.line, line.column);
    return false;
  }
  Block& block = blocks_.back();
  block.case_ended = true;
  if (!block.is_kept) return false;
  line.open = block.open;
  block.breaks.push_back(lines.size());
  block.pending_break = lines.size();
  return true;
}

bool BlockLinks::close_block(std::vector<Line>& lines, Line& line) {
  if (!find_block(line)) return false;
  if (line.kind == Line::Kind::kEndSwitch) check_case_end();
  Block block = std::move(blocks_.back());
  blocks_.pop_back();
  if (!block.is_kept) return false;
  const std::size_t at = lines.size();
  follow(lines, block, at);
  for (std::size_t i = block.open; i != at; i = lines[i].next) lines[i].close = at;
  for (const std::size_t i : block.breaks) lines[i].close = at;
  line.open = block.open;
  return true;
}

void BlockLinks::close_all() {
  for (; !blocks_.empty(); blocks_.pop_back()) {
    const Block& open = blocks_.back();
    const BlockWords& words = *block_of(open.kind);
    tell(syntax_rules::kUnpairedBlock,
         "'" + std::string(words.open_word) + "' without '" + std::string(words.close_word) + "'",
         "close it with " + std::string(words.close_word), open.line, open.column);
  }
}

}  // namespace val3
