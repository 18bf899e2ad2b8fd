#pragma once

#include <string>

namespace CLI {
class App;
}

namespace cell {

/// What a shell needs to complete every command of `app` and the options of each: a script for "bash" or
/// "zsh". An option's value is completed as a file.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace cell
