#pragma once

#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

namespace simulation {

/// It is no journal, or this program would write it otherwise; says where and what to do.
class BadJournal : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs each world again of which the text has a journal (ChosenWorld::line() begins one) and compares line
/// by line. Returns what these worlds break, as Outcome::broken. Throws BadJournal; `name` is that of the
/// file.
std::vector<std::string> repeat_journals(std::istream& text, const std::string& name);

}  // namespace simulation
