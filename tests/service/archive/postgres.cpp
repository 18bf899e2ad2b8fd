#include "tests/service/archive/postgres.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <pqxx/pqxx>
#include <stdexcept>
#include <utility>

namespace cell {
namespace {

const std::string kPrograms = "/usr/lib/postgresql/15/bin/";

/// In a child that becomes `call` as a user that a database takes; its standard error goes to `log`.
pid_t spawn(const std::vector<std::string>& call, int log) {
  const passwd* user = ::geteuid() == 0 ? ::getpwnam("postgres") : nullptr;
  if (::geteuid() == 0 && user == nullptr) throw std::runtime_error("there is no user postgres");
  std::vector<char*> arguments;
  for (const std::string& argument : call) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child != 0) return child;
  if (user != nullptr && (::setgid(user->pw_gid) != 0 || ::setuid(user->pw_uid) != 0)) ::_exit(126);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

}  // namespace

Postgres::Postgres(std::vector<std::string> settings) : settings_(std::move(settings)) {
  if (const passwd* user = ::geteuid() == 0 ? ::getpwnam("postgres") : nullptr)
    if (::chown(folder_.path().c_str(), user->pw_uid, user->pw_gid) != 0) throw std::runtime_error("chown");
  run({kPrograms + "initdb", "--no-sync", "--auth=trust", "--username=postgres", "--encoding=UTF8",
       "--locale=C.UTF-8", (folder_.path() / "data").string()});
  start();
}

Postgres::~Postgres() { kill(); }

void Postgres::run(const std::vector<std::string>& call) const {
  const int log =
      ::open((folder_.path().string() + ".log").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  int status = 0;
  ::waitpid(spawn(call, log), &status, 0);
  ::close(log);
  std::filesystem::remove(folder_.path().string() + ".log");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(call.front() + " failed");
}

void Postgres::start() {
  std::array<int, 2> log{};
  if (::pipe2(log.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::filesystem::remove(folder_.path() / "data" / "postmaster.pid");
  std::vector<std::string> call{kPrograms + "postgres", "-D", (folder_.path() / "data").string(), "-k",
                                folder_.path().string()};
  for (const char* setting : {"listen_addresses=", "fsync=off", "logging_collector=off"})
    call.insert(call.end(), {"-c", setting});
  for (const std::string& setting : settings_) call.insert(call.end(), {"-c", setting});
  pid_ = spawn(call, log[1]);
  ::close(log[1]);
  std::string said;
  char byte = 0;
  while (said.find("ready to accept connections") == std::string::npos && ::read(log[0], &byte, 1) == 1)
    said += byte;
  ::close(log[0]);
  if (said.find("ready to accept connections") == std::string::npos)
    throw std::runtime_error("no database: " + said);
}

void Postgres::kill() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGQUIT);  // at once: its own children end with it
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::size_t Postgres::sql(const std::string& text) const {
  pqxx::connection connection(url());
  pqxx::work work(connection);
  const auto rows = work.exec(text).affected_rows();
  work.commit();
  return static_cast<std::size_t>(rows);
}

std::string Postgres::url(const std::string& user) const {
  std::string host;
  for (const char letter : folder_.path().string()) host += letter == '/' ? "%2F" : std::string(1, letter);
  return "postgresql://" + user + "@/postgres?host=" + host;
}

}  // namespace cell
