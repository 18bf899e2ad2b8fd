#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace cell {

/// A word, a number, a text or a sign of a line of VAL3.
struct ProgramToken {
  enum class Kind { kWord, kNumber, kText, kSign };
  Kind kind = Kind::kSign;
  std::string_view text;  // of the line; a text without its quotes
  double number = 0.0;
};

/// The tokens of a line; they look into it. None of a comment. What is no VAL3 is a sign: whether a program
/// is right is a checker's matter (cs8sim --check), not this reader's.
std::vector<ProgramToken> program_tokens(std::string_view line);

/// [begin, end) of a line's tokens.
using TokenRange = std::pair<std::size_t, std::size_t>;

/// What stands between the commas behind the bracket at `open`, up to the bracket that closes it or the end
/// of the line.
std::vector<TokenRange> listed_in(const std::vector<ProgramToken>& tokens, std::size_t open);
/// The place of the bracket that closes the one at `open`; the number of tokens where none does.
std::size_t closing_of(const std::vector<ProgramToken>& tokens, std::size_t open);

/// True where the token at `place` is the name of a variable or a program of the application itself: no field
/// of something and nothing of a library.
bool is_own_name(const std::vector<ProgramToken>& tokens, std::size_t place);
bool is_sign(const std::vector<ProgramToken>& tokens, std::size_t place, std::string_view sign);

}  // namespace cell
