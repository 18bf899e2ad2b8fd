#include "tests/simulation/kept_journal.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "tests/simulation/chosen_world.hpp"

namespace simulation {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

std::vector<std::string> repeat(const std::string& text) {
  std::istringstream stream(text);
  return repeat_journals(stream, "file");
}

std::string journal_of(const ChosenWorld& chosen) {
  return chosen.line() + "\n" + run_world(chosen.scenario()).journal;
}

TEST(ChosenWorld, IsSaidByTheLineThatRunsIt) {
  EXPECT_EQ(ChosenWorld{.seed = 7}.line(), "touchcal-sim --seed 7");
  const auto chosen = chosen_by((ChosenWorld{.seed = 12, .events = {1, 3}}).line());
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->seed, 12u);
  EXPECT_THAT(chosen->events, ElementsAre(1u, 3u));
}

TEST(ChosenWorld, OfAnotherFormatIsNone) {
  for (const char* line :
       {"", "touchcal-sim --seed", "touchcal-sim --seed 0x7", "touchcal-sim --seed -7",
        "touchcal-sim --seed 7 ", "touchcal-sim --seed 7 --events", "touchcal-sim --seed 7 --events 1,",
        "touchcal-sim --seed 7 --events a", "touchcal-sim --seed 99999999999999999999", "seed 7"})
    EXPECT_FALSE(chosen_by(line)) << line;
}

TEST(ChosenWorld, HasNoEventsThatItsSeedDoesNotDraw) {
  const std::size_t count = scenario_of(3).faults.size();
  EXPECT_THAT((ChosenWorld{.seed = 3, .events = {count}}.scenario().faults), ::testing::SizeIs(1));
  EXPECT_THAT((ChosenWorld{.seed = 3, .events = {0}}.scenario().faults), IsEmpty());
  EXPECT_THROW((ChosenWorld{.seed = 3, .events = {count + 1}}.scenario()), UnknownEvent);
}

TEST(KeptJournal, OfThisCommitIsRepeated) {
  const std::string two =
      journal_of({.seed = 10}) + "what was said of it\n" + journal_of({.seed = 3, .events = {1}});
  EXPECT_THAT(repeat(two), IsEmpty());
}

TEST(KeptJournal, OfAnotherCommitIsRefusedWithThePlaceWhereItDiffers) {
  std::string text = journal_of({.seed = 10});
  const std::size_t third = text.find('\n', text.find('\n') + 1) + 1;
  text.replace(third, 1, "9");
  EXPECT_THAT([&] { repeat(text); },
              ThrowsMessage<BadJournal>(AllOf(HasSubstr("file:3: "), HasSubstr("of another commit"))));
}

TEST(KeptJournal, ThatEndsEarlyIsRefused) {
  const std::string text = journal_of({.seed = 10});
  EXPECT_THAT([&] { repeat(text.substr(0, text.size() / 2)); },
              ThrowsMessage<BadJournal>(HasSubstr("of another commit")));
}

TEST(KeptJournal, ThatIsNoneIsRefused) {
  EXPECT_THAT([] { repeat("some text\n"); },
              ThrowsMessage<BadJournal>(HasSubstr("no journal of touchcal-sim")));
  EXPECT_THAT([] { repeat("touchcal-sim --seed 3 --events 77\n"); },
              ThrowsMessage<BadJournal>(HasSubstr("file:1: seed 3 has ")));
}

}  // namespace
}  // namespace simulation
