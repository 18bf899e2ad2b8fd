#pragma once

#include <string>

namespace CLI {
class App;
}

namespace cell {

/// A completion script for "bash" or "zsh" with every command of `app` and its options. Option values
/// complete as files.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace cell
