#include "service/base/state_directory.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

namespace cell {

std::filesystem::path default_state_directory() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return std::filesystem::path(state) / "touchcal";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home && *home ? home : "/var/lib") / ".local" / "state" / "touchcal";
}

namespace {

/// Nothing where it is not there; what cannot be looked at is told by who uses it.
std::optional<struct stat> found_at(const std::filesystem::path& directory) {
  struct stat found = {};
  return ::stat(directory.c_str(), &found) == 0 ? std::optional(found) : std::nullopt;
}

[[noreturn]] void refuse_dead_link(const std::filesystem::path& directory,
                                   const std::filesystem::path& link) {
  std::error_code ignored;
  const std::string target = std::filesystem::read_symlink(link, ignored).string();
  throw std::runtime_error("--state " + directory.string() + ": " + link.string() + " is a link to " +
                           target +
                           ", which is not there; make that directory, remove the link, or name another");
}

}  // namespace

void demand_closed_directory(const std::filesystem::path& directory) {
  const auto found = found_at(directory);
  if (!found || (found->st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  throw std::runtime_error(
      "--state " + directory.string() +
      ": others than its owner may write into it, and could put a token there; look at what is there, then "
      "chmod 700 " +
      directory.string() +
      "; where its mount decides the rights, mount it for this user alone (dir_mode=0700, no fsGroup), or "
      "name another");
}

void demand_own_directory(const std::filesystem::path& directory) {
  const auto found = found_at(directory);
  if (!found || found->st_uid == ::geteuid() || found->st_uid == 0) return;
  const std::string own = std::to_string(::geteuid());
  throw std::runtime_error("--state " + directory.string() + ": belongs to the user with the id " +
                           std::to_string(found->st_uid) + ", and touchcald runs as " + own +
                           "; run it as that user, or look at what is there, then chown -R " + own + " " +
                           directory.string());
}

std::filesystem::path demand_state_directory(const std::filesystem::path& directory) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path existing = fs::absolute(directory);
  while (!fs::exists(existing, ignored) && existing.has_relative_path()) {
    if (fs::is_symlink(fs::symlink_status(existing, ignored))) refuse_dead_link(directory, existing);
    existing = existing.parent_path();
  }
  if (!fs::is_directory(existing, ignored)) {
    throw std::runtime_error("--state " + directory.string() + ": " + existing.string() +
                             " is not a directory; name another");
  }
  return existing;
}

}  // namespace cell
