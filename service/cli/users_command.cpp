#include <spdlog/fmt/fmt.h>
#include <termios.h>
#include <unistd.h>

#include <boost/url/encode.hpp>
#include <boost/url/rfc/unreserved_chars.hpp>
#include <cstdio>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include "service/base/terminal_text.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/people_document.hpp"
#include "service/documents/problem_document.hpp"

namespace cell {
namespace {

constexpr const char* kUsersOfDaemon = "/api/v1/users";

/// What takes something from a person counts at once, although the disk did not take it: done, with a word
/// about the disk, and nothing to be sent again.
bool is_done_but_not_kept(const ApiReply& reply) {
  return reply.status == 503 && read_reply(reply, read_problem).type == "urn:touchcal:problem:not-kept";
}

std::string users_text(const UsersDocument& document) {
  if (document.users.empty())
    return "nobody can sign in; touchcal users add NAME --role engineer makes the first user\n";
  std::string lines =
      fmt::format("{:<10}{:<26}{:<26}{:<10}{}\n", "role", "last sign-in", "made", "sessions", "name");
  for (const UserRow& user : document.users)
    lines += fmt::format("{:<10}{:<26}{:<26}{:<10}{}\n", user.role, user.last_sign_in_at.value_or("never"),
                         user.created_at, user.session_count, user.name);
  return lines;
}

/// What is typed on a terminal is not shown, to the end of its scope.
class HiddenTyping {
 public:
  HiddenTyping() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios hidden = before_;
    hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    is_hidden_ = ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &hidden) == 0;
  }
  ~HiddenTyping() {
    if (is_hidden_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  }
  HiddenTyping(const HiddenTyping&) = delete;
  HiddenTyping& operator=(const HiddenTyping&) = delete;

 private:
  termios before_{};
  bool is_hidden_ = false;
};

std::string secret_line(const std::string& prompt, bool on_terminal) {
  std::optional<HiddenTyping> hidden;
  if (on_terminal) {
    fmt::print(stderr, "{}: ", prompt);
    hidden.emplace();
  }
  std::string line;
  if (!std::getline(std::cin, line))
    throw std::invalid_argument("the secret is missing; type it, or give it as a line on standard input");
  if (on_terminal) fmt::print(stderr, "\n");
  return line;
}

/// From a person twice, from a program once. Never from the command line, which everybody on the machine can
/// read.
std::string asked_secret(const std::string& name) {
  const bool on_terminal = ::isatty(STDIN_FILENO) == 1;
  std::string secret =
      secret_line("PIN or passphrase of " + terminal_text(name) + ", 6 characters or more", on_terminal);
  if (on_terminal && secret_line("again", true) != secret)
    throw std::invalid_argument("the two are not the same; nothing was changed");
  return secret;
}

std::string path_of(const std::string& name) {
  return std::string(kUsersOfDaemon) + "/" + boost::urls::encode(name, boost::urls::unreserved_chars) +
         "/remove";
}

ApiReply ask_daemon(const ApiClient& daemon, const UsersArguments& arguments) {
  if (arguments.action == "list") return daemon.get(kUsersOfDaemon);
  if (arguments.name.empty())
    throw std::invalid_argument("touchcal users " + arguments.action + " NAME: the name is missing");
  if (arguments.action == "remove") return daemon.post(path_of(arguments.name), {});
  UserRequestDocument request{.name = arguments.name, .role = arguments.role};
  if (request.role.empty()) throw std::invalid_argument("--role is missing; give view, operate or engineer");
  if (!arguments.keep_secret) request.secret = asked_secret(arguments.name);
  return daemon.post(kUsersOfDaemon, document_text(request));
}

}  // namespace

ExitCode users_command(const ApiClient& daemon, const UsersArguments& arguments, bool json) {
  const ApiReply reply = ask_daemon(daemon, arguments);
  if (is_done_but_not_kept(reply)) {
    if (json) fmt::print("{}\n", reply.body);
    print_warnings({problem_line(reply)});
    return kExitDone;
  }
  if (reply.status >= 300) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
    return kExitDone;
  }
  fmt::print("{}", terminal_text(users_text(read_reply(reply, read_users))));  // names come from requests
  return kExitDone;
}

}  // namespace cell
