#include "service/base/terminal_text.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(TerminalText, LeavesWhatIsOnlyWritten) {
  for (const char* text : {"", "Jürgen O'Hara\n", "מרים כהן-לוי", "𝔸 ≤ 5 µm", "\xC2\xA0"})
    EXPECT_EQ(terminal_text(text), text);
}

TEST(TerminalText, LeavesNothingThatSteersATerminal) {
  EXPECT_EQ(terminal_text("a\x1b[2J\r\tb\x7f\n"), "a?[2J??b?\n");
  EXPECT_EQ(terminal_text("a\xC2\x9B"
                          "2J"),
            "a?2J")
      << "CSI, as one character of C1";
  EXPECT_EQ(terminal_text("a\xC2\x85z"), "a?z");
}

TEST(TerminalText, LeavesNothingThatTurnsWhatStandsBesideIt) {
  for (const char* mark : {"\xD8\x9C", "\xE2\x80\x8E", "\xE2\x80\x8F", "\xE2\x80\xAA", "\xE2\x80\xAE",
                           "\xE2\x81\xA6", "\xE2\x81\xA9", "\xE2\x80\xA8", "\xE2\x80\xA9"}) {
    EXPECT_EQ(terminal_text("a" + std::string(mark) + "b"), "a?b");
  }
}

TEST(TerminalText, LeavesNoBytesThatAreNoUtf8) {
  EXPECT_EQ(terminal_text("a\x9b"
                          "2J"),
            "a?2J")
      << "CSI of a terminal of eight bits";
  for (const char* bytes : {"\xC3", "\xC0\xAF", "\xE2\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    const std::string text = terminal_text(bytes);
    EXPECT_EQ(text, std::string(text.size(), '?'));
    EXPECT_FALSE(text.empty());
  }
}

}  // namespace
}  // namespace cell
