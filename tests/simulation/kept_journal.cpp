#include "tests/simulation/kept_journal.hpp"

#include <spdlog/fmt/fmt.h>

#include <istream>
#include <sstream>

#include "tests/simulation/chosen_world.hpp"

namespace simulation {
namespace {

/// The lines of a file, and where it is read.
class LinesRead {
 public:
  LinesRead(std::istream& text, std::string name) : text_(text), name_(std::move(name)) {}

  bool next(std::string& line) {
    ++number_;
    return static_cast<bool>(std::getline(text_, line));
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw BadJournal(fmt::format("{}:{}: {}", name_, number_, why));
  }

 private:
  std::istream& text_;
  std::string name_;
  int number_ = 0;
};

Outcome outcome_of(const ChosenWorld& chosen, const LinesRead& lines) try {
  return run_world(chosen.scenario());
} catch (const UnknownEvent& error) {
  lines.refuse(error.what());
}

void compare(const std::string& journal, LinesRead& lines) {
  std::istringstream again(journal);
  std::string expected, line;
  while (std::getline(again, expected)) {
    const bool is_there = lines.next(line);
    if (is_there && line == expected) continue;
    lines.refuse(
        fmt::format("this program has here: '{}'. The journal is of another commit, or was changed; "
                    "build the commit that wrote it, or run the seed anew",
                    expected));
  }
}

}  // namespace

std::vector<std::string> repeat_journals(std::istream& text, const std::string& name) {
  LinesRead lines(text, name);
  std::vector<std::string> broken;
  int count = 0;
  for (std::string line; lines.next(line);) {
    const auto chosen = chosen_by(line);
    if (!chosen) continue;  // between journals: what was said of them
    ++count;
    const Outcome outcome = outcome_of(*chosen, lines);
    compare(outcome.journal, lines);
    broken.insert(broken.end(), outcome.broken.begin(), outcome.broken.end());
  }
  if (count == 0)
    throw BadJournal(name + ": no journal of touchcal-sim is in it; one begins with 'touchcal-sim --seed N'");
  return broken;
}

}  // namespace simulation
