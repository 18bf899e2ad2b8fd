#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "config/endpoint.hpp"

namespace cell {

/// The daemon cannot be reached, or the peer is not touchcald.
struct DaemonUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ApiReply {
  unsigned status = 0;
  std::string body;
};

/// How a daemon is reached.
struct ApiClientOptions {
  std::filesystem::path ca_file = {};  // PEM; empty: what this machine trusts
  std::filesystem::path socket = {};   // a Unix socket that is tried before the URL; empty: none
  bool sends_token_in_clear = false;   // over http to another machine
};

/// Client of a daemon's API; one connection per request.
class ApiClient {
 public:
  /// `url`: http://HOST:PORT or https://HOST:PORT. With https the daemon's certificate must name HOST and be
  /// signed by one in the `ca_file`. Throws std::invalid_argument for any other `url`, and where a token
  /// would go to another machine in clear.
  ApiClient(const std::string& url, std::optional<std::string> token, ApiClientOptions options = {});

  /// `target` with its query; `body` is JSON. Throws DaemonUnreachable.
  ApiReply get(const std::string& target, std::chrono::seconds deadline = std::chrono::seconds(10)) const;
  ApiReply post(const std::string& target, const std::string& body,
                std::chrono::seconds deadline = std::chrono::seconds(10)) const;

  [[nodiscard]] std::string url() const;
  /// The same without the Unix socket: what a browser would reach.
  [[nodiscard]] ApiClient without_socket() const;
  [[nodiscard]] const std::optional<std::string>& token() const { return token_; }

 private:
  [[nodiscard]] ApiReply request(bool post, const std::string& target, const std::string& body,
                                 std::chrono::seconds deadline) const;

  bool is_secure_ = false;
  Endpoint at_;
  std::optional<std::string> token_;
  ApiClientOptions options_;
};

/// The operate token: TOUCHCAL_TOKEN, else the file in the state directory of the daemon; nothing without
/// either.
std::optional<std::string> find_operate_token(const std::filesystem::path& state_directory);

}  // namespace cell
