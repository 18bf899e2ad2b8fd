#include "service/cli/completion.hpp"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

namespace cell {
namespace {

struct OptionWords {
  std::vector<std::string> names;  // with their dashes; empty for one that goes by its place
  std::string place_name;          // of such a one
  std::string description;
  bool takes_value = false;
};

std::vector<OptionWords> options_of(const CLI::App& app) {
  std::vector<OptionWords> list;
  for (const CLI::Option* option : app.get_options()) {
    OptionWords words{.place_name = option->get_name(),
                      .description = option->get_description(),
                      .takes_value = option->get_items_expected_max() > 0};
    for (const std::string& name : option->get_lnames()) words.names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) words.names.push_back("-" + name);
    list.push_back(std::move(words));
  }
  return list;
}

std::string names_of(const CLI::App& app, bool only_with_value) {
  std::string names;
  for (const OptionWords& option : options_of(app)) {
    if (only_with_value && !option.takes_value) continue;
    for (const std::string& name : option.names) names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  auto commands = app.get_subcommands([](const CLI::App*) { return true; });
  std::ranges::sort(commands, {}, &CLI::App::get_name);
  return commands;
}

std::string bash_script(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : commands_of(app)) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(), names_of(*command, false));
  }
  std::string with_value;
  for (const CLI::App* command : commands_of(app)) with_value += " " + names_of(*command, true);
  return fmt::format(R"(# bash completion of {0}, made by `{0} completion bash`
_{0}() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" options
  case "${{COMP_WORDS[1]}}" in
{2}    *) options="{3}" ;;
  esac
  if [ "$COMP_CWORD" -eq 1 ]; then
    options="{1} $options"
  elif [[ " {4} " == *" $before "* ]] || [[ "$word" != -* ]]; then
    COMPREPLY=($(compgen -f -- "$word"))
    return
  fi
  COMPREPLY=($(compgen -W "$options" -- "$word"))
}}
complete -o filenames -F _{0} {0}
)",
                     app.get_name(), commands, cases, names_of(app, false), with_value);
}

/// Within single quotes and the brackets of _arguments.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      safe += std::string("\\") + c;
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string zsh_arguments(const CLI::App& command) {
  std::string arguments;
  for (const OptionWords& option : options_of(command)) {
    const std::string value = option.takes_value ? ":value:_files" : "";
    for (const std::string& name : option.names)
      arguments += fmt::format(" \\\n      '{}[{}]{}'", name, quoted(option.description), value);
    if (option.names.empty()) arguments += fmt::format(" \\\n      ':{}:_files'", quoted(option.place_name));
  }
  return arguments;
}

std::string zsh_script(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : commands_of(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), quoted(command->get_description()));
    cases += fmt::format("    {}) _arguments{} ;;\n", command->get_name(), zsh_arguments(*command));
  }
  return fmt::format(R"(#compdef {0}
# zsh completion of {0}, made by `{0} completion zsh`
_{0}() {{
  local -a commands
  commands=(
{1}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _arguments{3}
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{2}  esac
}}
_{0} "$@"
)",
                     app.get_name(), commands, cases, zsh_arguments(app));
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  return shell == "zsh" ? zsh_script(app) : bash_script(app);
}

}  // namespace cell
