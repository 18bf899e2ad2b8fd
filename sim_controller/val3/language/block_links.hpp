#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim_controller/val3/language/lexer.hpp"
#include "sim_controller/val3/program/syntax.hpp"

namespace val3 {

/// Pairs the lines of blocks while a program's lines come in, one after the other.
class BlockLinks {
 public:
  struct Told {
    LineProblem problem;
    int line = 0;
  };

  /// Links a line that is to stand at `lines.size()`. False: it is not to be kept, because it was not read or
  /// because the line that opens its block was not.
  bool add(std::vector<Line>& lines, Line& line, bool is_read);
  /// The program ends: blocks that are open have no end.
  void close_all();
  /// What was found since the last call.
  std::vector<Told> take_told();

 private:
  struct Block {
    Line::Kind kind{};
    int line = 0;
    int column = 0;
    bool is_kept = false;
    std::size_t open = 0;  // of one that is kept
    std::size_t last = 0;  // the label that was last: `next` of it is still to come
    std::optional<std::size_t> pending_break;
    std::vector<std::size_t> breaks;
    int case_line = 0;  // of the case that is open; 0: none was yet
    bool case_ended = false;
    bool last_label_seen = false;  // else, default
  };

  void open_block(const std::vector<Line>& lines, const Line& line, bool is_read);
  bool label(std::vector<Line>& lines, Line& line, bool is_read);
  bool break_line(const std::vector<Line>& lines, Line& line);
  bool close_block(std::vector<Line>& lines, Line& line);
  /// Brings the innermost block that `line` can belong to to the top; blocks inside it have no end.
  bool find_block(const Line& line);
  void check_case_end();
  void check_in_case(const Line& line);
  void follow(std::vector<Line>& lines, Block& block, std::size_t at) const;
  void tell(std::string_view rule, const std::string& what, const std::string& remedy, int line, int column);

  std::vector<Block> blocks_;
  std::vector<Told> told_;
};

}  // namespace val3
