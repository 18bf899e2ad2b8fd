#include "sim_controller/run_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sim {
namespace {

using ::testing::HasSubstr;

std::vector<ScriptStep> steps_of(std::string_view text) {
  auto parsed = parse_script(text);
  if (const auto* error = std::get_if<ScriptError>(&parsed)) {
    ADD_FAILURE() << error->line << ": " << error->what;
    return {};
  }
  return std::get<std::vector<ScriptStep>>(std::move(parsed));
}

TEST(RunScript, HasOneStepALineWithTimeAndArguments) {
  const auto steps = steps_of(
      "# a comment\n0 input BasicIO-1\\%I0 on\n\n 0.5 mode remote\r\n0.5 estop press\n"
      "1 send Socket\\host \"a\\x0d\\n\\\"b\\\\\"\n2 expect-number n[3] -1.5\n3 end");
  ASSERT_EQ(steps.size(), 6u);
  EXPECT_EQ(steps[0].act.kind, ScriptAct::Kind::kInput);
  EXPECT_EQ(steps[0].act.name, "BasicIO-1\\%I0");
  EXPECT_TRUE(steps[0].act.on);
  EXPECT_EQ(steps[0].line, 2);
  EXPECT_EQ(steps[1].act.number, 4.0);
  EXPECT_EQ(steps[1].at_s, 0.5);
  EXPECT_EQ(steps[2].act.number, 2.0);
  EXPECT_EQ(steps[3].act.text, "a\r\n\"b\\");
  EXPECT_EQ(steps[4].act.name, "n[3]");
  EXPECT_EQ(steps[4].act.number, -1.5);
  EXPECT_EQ(steps[5].line, 8);
}

TEST(RunScript, SaysWhichSocketsAreRealFromTheStart) {
  const auto steps = steps_of("0 socket Socket\\host 5000\n0.0 socket Socket\\eye  127.0.0.1:81 \n1 end");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].act.kind, ScriptAct::Kind::kSocket);
  EXPECT_EQ(steps[0].act.name, "Socket\\host");
  EXPECT_EQ(steps[0].act.text, "5000");
  EXPECT_EQ(steps[1].act.text, "127.0.0.1:81");
}

TEST(RunScript, DeclaresCardsFromTheStart) {
  const auto steps = steps_of("0 card J206-1");
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].act.kind, ScriptAct::Kind::kCard);
  EXPECT_EQ(steps[0].act.name, "J206-1");
}

TEST(RunScript, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(steps_of("\xEF\xBB\xBF"
                     "0 end")
                .size(),
            1u);
}

TEST(RunScript, RefusesWhatItDoesNotKnowWithLineAndRemedy) {
  const std::vector<std::tuple<std::string, int, std::string>> mistakes{
      {"input x on", 1, "'input' is no time"},
      {"-1 end", 1, "is no time"},
      {"nan end", 1, "is no time"},
      {"1e9 end", 1, "is no time"},
      {"0 jump", 1, "'jump' is no command; there are: card NAME, input LINK on|off"},
      {"0", 1, "'' is no command"},
      {"0 input x", 1, "write 'input LINK on|off'"},
      {"0 input", 1, "write 'input LINK on|off'"},
      {"0 mode press", 1, "write 'mode manual|test|local|remote'"},
      {"0 key x", 1, "write 'key CODE'"},
      {"0 key 70000", 1, "write 'key CODE'"},
      {"0 key 1.5", 1, "write 'key CODE'"},
      {"0 speed -5", 1, "write 'speed PERCENT'"},
      {"0 speed 101", 1, "write 'speed PERCENT'"},
      {"0 end now", 1, "write 'end'"},
      {"0.5 card J206-1", 1, "a card is there from the start; begin its line with 0"},
      {"0 card", 1, "write 'card NAME'"},
      {"0 socket s", 1, "write 'socket SOCKET PORT|HOST:PORT'"},
      {"0 socket s 70000", 1, "write 'socket"},
      {"0 socket s peer:0", 1, "write 'socket"},
      {"1 socket s 5000", 1, "begin its line with 0"},
      {"0 send s text", 1, "write 'send SOCKET \"TEXT\"'"},
      {"0 send s \"a\\x4\"", 1, "write 'send"},
      {"0 send s \"a\\\"", 1, "write 'send"},
      {"0 send s \"a\"b\"", 1, "write 'send"},
      {"1 end\n0 end", 2, "in order of time"},
      {std::string(kScriptBytesMax + 1, '\n'), 0, "more than 1 MiB"},
  };
  for (const auto& [text, line, what] : mistakes) {
    const auto parsed = parse_script(text);
    const auto* error = std::get_if<ScriptError>(&parsed);
    ASSERT_NE(error, nullptr) << text.substr(0, 40);
    EXPECT_EQ(error->line, line) << text.substr(0, 40);
    EXPECT_THAT(error->what, HasSubstr(what)) << text.substr(0, 40);
  }
}

}  // namespace
}  // namespace sim
