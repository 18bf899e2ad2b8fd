// What the shell completes: commands, options, files, and names that it asks the program for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/end_to_end/environment.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string shipped_cell_file(const std::string& name) {
  return std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + name + "/cell.json";
}

class ShellCompletion : public ::testing::Test {
 protected:
  Finished run(const std::vector<std::string>& arguments) {
    return Process(arguments, folder_ / "call.err").wait();
  }
  /// Completes the last of its arguments and prints each answer so.
  std::filesystem::path script_that_prints(const std::string& format, const std::string& before = {}) {
    std::ofstream(folder_ / "completion.bash")
        << run({"touchcal", "completion", "bash"}).out << "\n"
        << before << R"(COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _touchcal; printf ')" << format
        << R"(' "${COMPREPLY[@]}")"
        << "\n";
    return folder_ / "completion.bash";
  }

  Folder folder_;
};

TEST_F(ShellCompletion, TheShellCompletesCommandsOptionsAndFiles) {
  const auto script = script_that_prints("%s ");
  const auto completed = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"/bin/bash", script.string()});
    return run(words).out;
  };
  EXPECT_EQ(completed({"touchcal", "ident"}), "identify ");
  EXPECT_EQ(completed({"touchcal", "run", "--oper"}), "--operator ");
  const std::string cell = shipped_cell_file("edf");
  EXPECT_EQ(completed({"touchcal", "identify", "--cell", cell.substr(0, cell.size() - 2)}), cell + " ");
}

TEST_F(ShellCompletion, TheShellCompletesRecipesAndToolsOfTheCellThatIsNamed) {
  const auto script = script_that_prints("%s ");
  const std::string program = std::string(TOUCHCAL_PROGRAMS_DIR) + "/touchcal";
  const auto completed = [&](const std::string& command, const std::string& option, const std::string& word) {
    return run({"/bin/bash", script.string(), program, command, "--cell", shipped_cell_file("demo"), option,
                word})
        .out;
  };
  EXPECT_EQ(completed("identify", "--recipe", "qui"), "quick ");
  EXPECT_THAT(completed("plan", "--recipe", ""), AllOf(HasSubstr("best "), HasSubstr("edf-25 ")));
  EXPECT_THAT(completed("compensate", "--tool", ""), HasSubstr("stylus "));
  EXPECT_EQ(run({"/bin/bash", script.string(), program, "show", ""}).out, " ") << "no daemon runs";
}

TEST_F(ShellCompletion, ANameThatIsCompletedIsTextAndNothingThatTheShellRuns) {
  const auto script = script_that_prints("%s\\n"), program = folder_ / "touchcal", made = folder_ / "made";
  std::ofstream(program) << "#!/bin/sh\necho \"$*\" >" << (folder_ / "asked").string() << "\necho '$(touch$"
                         << "{IFS}" << made.string() << ")'\necho 'two words'\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string out = run({"/bin/bash", script.string(), program.string(), "run", "--daemon",
                               "http://other:1", "--recipe", ""})
                              .out;
  EXPECT_FALSE(std::filesystem::exists(made));
  EXPECT_THAT(out, HasSubstr("two\\ words\n"));
  EXPECT_EQ(run({"/bin/cat", (folder_ / "asked").string()}).out, "names recipes --daemon http://other:1\n")
      << "the daemon of the command";
}

TEST_F(ShellCompletion, TheShellCompletesARunBehindOptions) {
  const auto script = script_that_prints("%s ", R"(cd "${1%/*}"; )"), program = folder_ / "touchcal";
  std::ofstream(program) << "#!/bin/sh\necho \"$2-4711\"\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const auto completed = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"/bin/bash", script.string(), program.string()});
    return run(words).out;
  };
  const std::string runs = "runs-4711 ", file = "completion.bash ";
  EXPECT_EQ(completed({"show", ""}), runs);
  EXPECT_EQ(completed({"show", "--json", ""}), runs);
  EXPECT_EQ(completed({"show", "--daemon", "http://other:1", ""}), runs);
  EXPECT_EQ(completed({"show", "--daemon", "=", "http://other:1", ""}), runs);
  EXPECT_EQ(completed({"compare", "3", "--json", ""}), runs);
  EXPECT_EQ(completed({"compare", "--json", "3", "4", "compl"}), file) << "there are two";
  EXPECT_EQ(completed({"show", "--ca", "compl"}), file) << "the value of an option";
}

}  // namespace
}  // namespace touchcal::testing
