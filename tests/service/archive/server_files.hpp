#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/config/folder.hpp"
#include "tests/service/mqtt/certificates.hpp"

namespace cell {

/// One that nobody listens on now.
inline int free_port() {
  const int one = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(at);
  auto* address = reinterpret_cast<sockaddr*>(&at);
  if (::bind(one, address, size) != 0 || ::getsockname(one, address, &size) != 0)
    throw std::runtime_error("no free port");
  ::close(one);
  return ntohs(at.sin_port);
}

/// What a server of PostgreSQL has to have of its own to be known by a certificate and to know others by
/// theirs, as its user has to own it.
class ServerFiles {
 public:
  /// `hostssl`: who is let in over the network, as lines of pg_hba.conf; `more`: names of certificates that
  /// it has too, as one that goes to another server.
  explicit ServerFiles(
      const std::string& hostssl = "hostssl all all 127.0.0.1/32 cert clientcert=verify-full\n",
      const std::vector<std::string>& more = {}) {
    std::vector<std::string> names{"broker.crt", "broker.key", "ca.crt", "other.crt"};
    for (const std::string& name : more) names.insert(names.end(), {name + ".crt", name + ".key"});
    for (const std::string& name : names) std::filesystem::copy(certificates() / name, folder_.path() / name);
    std::ofstream(folder_.path() / "pg_hba.conf") << "local all postgres trust\n" << hostssl;
    own(folder_.path());
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".key")
        std::filesystem::permissions(
            entry.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
      own(entry.path());
    }
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] std::vector<std::string> settings(int port) const {
    return {"listen_addresses=127.0.0.1",
            "port=" + std::to_string(port),
            "ssl=on",
            "ssl_cert_file=" + path("broker.crt"),
            "ssl_key_file=" + path("broker.key"),
            "ssl_ca_file=" + path("ca.crt"),
            "hba_file=" + path("pg_hba.conf")};
  }

 private:
  static void own(const std::filesystem::path& file) {
    const passwd* user = ::geteuid() == 0 ? ::getpwnam("postgres") : nullptr;
    if (user != nullptr && ::chown(file.c_str(), user->pw_uid, user->pw_gid) != 0)
      throw std::runtime_error("chown");
  }

  Folder folder_;
};

}  // namespace cell
