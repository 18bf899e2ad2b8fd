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

/// What `names` of the program is asked for, to complete a value; empty: it is a file.
std::string named_kind(const OptionWords& option) {
  const auto is = [&](const char* name) {
    return option.place_name == name || std::ranges::find(option.names, name) != option.names.end();
  };
  if (is("RUN") || is("OTHER") || is("--of") || is("--check") || is("--tool-run")) return "runs";
  if (is("RECIPE") || is("--recipe")) return "recipes";
  return is("--tool") || is("NAME") ? "tools" : "";
}

/// Lines of a shell's case of "command:place" for what goes by its place, from 1; options and their values
/// are none.
std::string bash_places(const CLI::App& command) {
  std::string cases;
  int place = 0;
  for (const OptionWords& option : options_of(command)) {
    if (!option.names.empty()) continue;
    ++place;
    if (const std::string kind = named_kind(option); !kind.empty())
      cases += fmt::format("        {}:{}) kind={} ;;\n", command.get_name(), place, kind);
  }
  return cases;
}

std::string bash_script(const CLI::App& app) {
  std::string commands, cases, places;
  for (const CLI::App* command : shown_commands(app)) {
    places += bash_places(*command);
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(), names_of(*command, false));
  }
  std::string with_value;
  for (const CLI::App* command : shown_commands(app)) with_value += " " + names_of(*command, true);
  return fmt::format(R"sh(# bash completion of {0}, made by `{0} completion bash`
_{0}() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" options kind= same=() i name place=1
  local valued=" {4} "
  case "${{COMP_WORDS[1]}}" in
{2}    *) options="{3}" ;;
  esac
  for ((i = 2; i < COMP_CWORD; i++)); do
    if [[ "${{COMP_WORDS[i]}}" != -* ]]; then
      place=$((place + 1))
    elif [[ "$valued" == *" ${{COMP_WORDS[i]}} "* ]]; then
      [ "${{COMP_WORDS[i+1]}}" != = ] || i=$((i + 1))
      i=$((i + 1))
    fi
  done
  case "$before" in
    --of|--check|--tool-run) kind=runs ;;
    --recipe) kind=recipes ;;
    --tool) kind=tools ;;
    *) if [[ "$valued" != *" $before "* ]]; then
      case "${{COMP_WORDS[1]}}:$place" in
{5}      esac
    fi ;;
  esac
  if [ -n "$kind" ] && [[ "$word" != -* ]]; then
    for ((i = 2; i < COMP_CWORD; i++)); do
      case "${{COMP_WORDS[i]}}" in
        --cell|--daemon|--state|--ca) same+=("${{COMP_WORDS[i]}}" "${{COMP_WORDS[i+1]/#\~/$HOME}}") ;;
        --token-in-clear) same+=(--token-in-clear) ;;
      esac
    done
    COMPREPLY=()
    while IFS= read -r name; do
      [[ "$name" != "$word"* ]] || COMPREPLY+=("$(printf %q "$name")")
    done < <("${{COMP_WORDS[0]}}" names "$kind" "${{same[@]}}" 2>/dev/null)
    return
  fi
  if [ "$COMP_CWORD" -eq 1 ]; then
    options="{1} $options"
  elif [[ "$valued" == *" $before "* ]] || [[ "$word" != -* ]]; then
    COMPREPLY=($(compgen -f -- "$word"))
    return
  fi
  COMPREPLY=($(compgen -W "$options" -- "$word"))
}}
complete -o filenames -F _{0} {0}
)sh",
                     app.get_name(), commands, cases, names_of(app, false), with_value, places);
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
    const std::string kind = named_kind(option);
    const std::string filled = kind.empty() ? "_files" : "{_touchcal_names " + kind + "}";
    const std::string value = option.takes_value ? ":value:" + filled : "";
    for (const std::string& name : option.names)
      arguments += fmt::format(" \\\n      '{}[{}]{}'", name, quoted(option.description), value);
    if (option.names.empty())
      arguments += fmt::format(" \\\n      ':{}:{}'", quoted(option.place_name), filled);
  }
  return arguments;
}

std::string zsh_script(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : shown_commands(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), quoted(command->get_description()));
    cases += fmt::format("    {}) _arguments{} ;;\n", command->get_name(), zsh_arguments(*command));
  }
  return fmt::format(R"sh(#compdef {0}
# zsh completion of {0}, made by `{0} completion zsh`
_{0}_names() {{
  local option i same=()
  for option in --cell --daemon --state --ca; do
    i=${{words[(i)$option]}}
    (( i < $#words )) && same+=($option ${{words[i+1]/#\~/$HOME}})
  done
  compadd -- ${{(f)"$({0} names $1 $same 2>/dev/null)"}}
}}
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
)sh",
                     app.get_name(), commands, cases, zsh_arguments(app));
}

}  // namespace

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  auto commands = app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
  std::ranges::sort(commands, {}, &CLI::App::get_name);
  return commands;
}

std::string completion_script(const CLI::App& app, const std::string& shell) {
  return shell == "zsh" ? zsh_script(app) : bash_script(app);
}

}  // namespace cell
