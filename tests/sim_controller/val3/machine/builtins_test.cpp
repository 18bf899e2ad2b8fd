#include "sim_controller/val3/machine/builtins.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "sim_controller/val3/language/instructions.hpp"
#include "sim_controller/val3/machine/libraries.hpp"

namespace val3 {
namespace {

/// The instructions that the README calls refused: the words in backticks of the line that begins so.
std::set<std::string> refused_by_readme() {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/sim_controller/val3/README.md");
  std::set<std::string> names;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| refused at load |")) continue;
    std::istringstream parts(line);
    bool is_name = false;
    for (std::string part; std::getline(parts, part, '`'); is_name = !is_name)
      if (is_name) names.insert(part);
  }
  return names;
}

TEST(Builtins, TheReadmeNamesEveryInstructionThatIsRefusedAndNoOther) {
  std::set<std::string> refused;
  for (const Instruction& instruction : all_instructions()) {
    Expression call{.kind = Expression::Kind::kCall};
    call.text = instruction.name;
    const bool is_line = instruction.name == "wait" || instruction.name == "delay";
    if (!is_line && !builtins().knows(instruction.name) && !is_library_instruction(call))
      refused.insert(instruction.name);
  }
  refused.insert("libDelete");  // its form is known, and no file is ever removed
  EXPECT_EQ(refused_by_readme(), refused);
}

}  // namespace
}  // namespace val3
