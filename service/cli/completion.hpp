#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace cell {

/// The commands of `app` that its help lists, by name.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

/// A completion script for "bash" or "zsh" with every command of `app` and its options. Runs, recipes and
/// tools complete by `names` of the program, all other values as files.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace cell
