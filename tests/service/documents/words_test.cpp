#include "service/documents/words.hpp"

#include <gtest/gtest.h>

#include <set>

namespace cell {
namespace {

template <class Enumeration>
void expect_a_word_for_each() {
  std::set<std::string_view> words;
  for (const Enumeration value : kAllOf<Enumeration>) {
    EXPECT_FALSE(word_of(value).empty());
    EXPECT_TRUE(words.insert(word_of(value)).second) << word_of(value) << " is the word of two values";
  }
  // The values are counted from 0: one behind the last has no word.
  EXPECT_TRUE(word_of(static_cast<Enumeration>(kAllOf<Enumeration>.size())).empty())
      << "a value is not listed";
}

TEST(Words, EachValueOfAnEnumerationHasAWordOfItsOwn) {
  expect_a_word_for_each<State>();
  expect_a_word_for_each<Verdict>();
  expect_a_word_for_each<RunOutcome>();
  expect_a_word_for_each<HandActivity>();
  expect_a_word_for_each<HandStep>();
  expect_a_word_for_each<calib::TouchRole>();
  expect_a_word_for_each<calib::RejectionReason>();
  expect_a_word_for_each<calib::ParameterStatus>();
  expect_a_word_for_each<ArtefactStatus>();
  expect_a_word_for_each<TouchUse>();
  expect_a_word_for_each<calib::CompensationStatus>();
}

}  // namespace
}  // namespace cell
