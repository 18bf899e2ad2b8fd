#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace cell {

/// How often wrong tokens come from each network, so that guessing is slow. Counted by time alone: a good
/// token from the same place, as from behind a proxy, neither ends the count nor is held up by it. Of one
/// thread.
class WrongTokens {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  static constexpr int kAtOnce = 5;                         // typing errors, which are answered at once
  static constexpr std::chrono::minutes kForgetOne{1};      // one of them is forgotten in this time
  static constexpr std::chrono::minutes kForgetAllMax{15};  // all of them, however many there were
  static constexpr std::size_t kNetworksMax = 1024;

  /// Counts one more from this client's address, of IPv6 from its first 64 bits. Whether its network has sent
  /// more than is forgiven. Where kNetworksMax are known, the one that has been quiet longest goes for a new
  /// one.
  bool is_too_often(const std::string& remote, TimePoint now);

  [[nodiscard]] std::size_t network_count() const { return networks_.size(); }

 private:
  struct Network {
    TimePoint forgotten_at{};  // when all that has come from it is forgotten
    TimePoint latest{};
  };
  Network& network_of(const std::string& remote);

  std::map<std::string, Network> networks_;
};

}  // namespace cell
