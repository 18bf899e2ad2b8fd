#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace cell {

/// The daemon cannot be reached, or the peer is not touchcald.
struct DaemonUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ApiReply {
  unsigned status = 0;
  std::string body;
};

/// Client of a daemon's API; one connection per request.
class ApiClient {
 public:
  /// `url`: http://HOST:PORT or https://HOST:PORT. With https the daemon's certificate must name HOST and be
  /// signed by one in `ca_file` (PEM), or, if that is empty, by one this machine trusts. Throws
  /// std::invalid_argument for any other `url`.
  ApiClient(const std::string& url, std::optional<std::string> token, std::filesystem::path ca_file = {});

  /// `target` with its query; `body` is JSON. Throws DaemonUnreachable.
  ApiReply get(const std::string& target, std::chrono::seconds deadline = std::chrono::seconds(10)) const;
  ApiReply post(const std::string& target, const std::string& body) const;

  [[nodiscard]] std::string url() const;
  [[nodiscard]] const std::optional<std::string>& token() const { return token_; }

 private:
  [[nodiscard]] ApiReply request(bool post, const std::string& target, const std::string& body,
                                 std::chrono::seconds deadline) const;

  bool is_secure_ = false;
  std::string host_;
  std::string port_;
  std::optional<std::string> token_;
  std::filesystem::path ca_file_;
};

/// The operate token: TOUCHCAL_TOKEN, else the file in the state directory of the daemon; nothing without
/// either.
std::optional<std::string> find_operate_token(const std::filesystem::path& state_directory);

}  // namespace cell
