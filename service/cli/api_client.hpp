#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace cell {

/// The daemon cannot be reached, or what answers is not it.
struct DaemonUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ApiReply {
  unsigned status = 0;
  std::string body;
};

/// One daemon's API, a connection a request.
class ApiClient {
 public:
  /// `url`: http://HOST:PORT or https://HOST:PORT. With https the daemon's certificate must name HOST and be
  /// signed by one in `ca_file` (PEM), or by one this machine trusts when that is empty. Throws
  /// std::invalid_argument when `url` is none of these.
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

/// The token that changes things: TOUCHCAL_TOKEN, else the daemon's file in its state directory; nothing when
/// neither is there.
std::optional<std::string> find_operate_token(const std::filesystem::path& state_directory);

}  // namespace cell
