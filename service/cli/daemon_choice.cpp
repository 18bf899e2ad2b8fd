#include "service/cli/daemon_choice.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

#include "config/option_text.hpp"

namespace cell {

std::string environment_or(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

void DaemonChoice::add_to(CLI::App& command) {
  command.add_option("--daemon", url_, "the daemon's address; also TOUCHCAL_DAEMON")
      ->check(refuse_empty)
      ->default_str(url_);
  command.add_option("--state", state_directory_, "the daemon's state directory, where its token is")
      ->check(refuse_empty)
      ->default_str(state_directory_);
  command
      .add_option("--ca", ca_file_,
                  "certificates (PEM) that sign the one of an https daemon; also TOUCHCAL_CA")
      ->check(refuse_empty)
      ->default_str(ca_file_);
  command.add_flag("--token-in-clear", token_in_clear_,
                   "send the token over http to another machine, where everybody on the way can read it");
}

ApiClient DaemonChoice::client(const CLI::App& command) const {
  // A daemon that was named is that one; else the one of the state directory, first by its socket.
  const bool is_named = command.count("--daemon") > 0 || !environment_or("TOUCHCAL_DAEMON", "").empty();
  const std::filesystem::path state(state_directory_);
  if (!is_named) demand_state_directory(state);
  return {url_, find_operate_token(state),
          ApiClientOptions{.ca_file = ca_file_,
                           .socket = is_named ? std::filesystem::path() : state / kSocketFile,
                           .sends_token_in_clear = token_in_clear_}};
}

}  // namespace cell
