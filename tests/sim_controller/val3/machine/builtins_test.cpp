#include "sim_controller/val3/machine/builtins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "sim_controller/val3/language/instructions.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "sim_controller/val3/machine/libraries.hpp"
#include "sim_controller/val3/machine/machine.hpp"
#include "tests/sim_controller/val3/small_application.hpp"
#include "tests/val3/cabinet.hpp"

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

/// What the machine finds in a line that it refuses.
Finding refusal_of(const std::string& line) {
  SmallApplication small;
  small.application.form = 5;
  small.global("num", "n").global("string", "s").global("trsf", "t").global("mdesc", "m");
  small.global("jointRx", "j").library("gone", nullptr).program("start", line).program("stop", "");
  Findings findings = std::move(small.findings);
  resolve(small.application, findings);
  std::erase_if(findings, [](const Finding& one) { return one.severity != Severity::kError; });
  EXPECT_TRUE(findings.empty()) << line << ": " << (findings.empty() ? "" : findings[0].what);
  Cabinet cabinet;
  findings.clear();
  const Machine machine(small.application, cabinet, findings);
  EXPECT_EQ(findings.size(), 1U) << line;
  return findings.empty() ? Finding{} : findings[0];
}

TEST(Builtins, ARefusalNamesTheInstructionThatIsNotThereAndWhy) {
  const std::string addon = "() is of an add-on, and add-ons are not simulated";
  for (const auto& [line, why] : std::vector<std::pair<std::string, std::string>>{
           {"$unheard(gone:x,{1,2},s)", "$unheard" + addon},
           {"n=$unheard(gone:x)+1", "$unheard" + addon},
           {"s=\"a\"+$unheard()", "$unheard" + addon},
           {"put($unheard({1,2}))", "$unheard" + addon},
           {"n=$fileOpen(gone:x,\"r\")", "$fileOpen" + addon},
           {"$movejSync({0,0,0,0,0,0},flange,m)", "$movejSync" + addon},
           {"n=alter(gone:t)", "alter() is of the option alter, and options are not simulated"},
           {"movejf({0,0,0,0,0,0},flange,m,9)",
            "movejf() is of the option compliance, and options are not simulated"},
           {"n=getLicence(\"a\",\"b\")", "getLicence() is not simulated: there are no licences here"},
           {"setLanguage(\"french\")",
            "setLanguage() is not simulated: the controller here has one language"},
           {"setPayload(1,t)", "setPayload() is not simulated: a payload has no effect here"},
           {"if libList(\"Disk://\",s)\nendIf",
            "libList() is not simulated: there is no disk here whose folders it would list"},
           {"t=interpolateC(t,t,t,0.5)", "interpolateC() is not simulated"},
           {"if isDefined(n)\nendIf", "isDefined() is not simulated"},
           {"n=append(n)", "what append() gives is not simulated"},
           {"put(gone:x)", "'gone:x' is of a library that is not there"},
           {"call gone:f(n)", "program f is of a library that is not there"}})
    EXPECT_EQ(refusal_of(line).what, why) << line;
}

TEST(Builtins, TheRemedyForALibraryThatIsNotThereIsToPutItThere) {
  const std::string there = "put its folder beside the application";
  EXPECT_EQ(refusal_of("put(gone:x)").remedy, there);
  EXPECT_EQ(refusal_of("call gone:f(n)").remedy, there);
  EXPECT_EQ(refusal_of("setPayload(1)").remedy,
            "run this application on a controller, or leave the line out");
}

}  // namespace
}  // namespace val3
