#pragma once

#include <cstddef>
#include <string>

#include "service/http/auth/guess_counts.hpp"

namespace cell {

/// The network that a client's address is of, of IPv6 its first 64 bits. What is no address, as of a Unix
/// socket, is a network of its own.
std::string network_of(const std::string& remote);

/// How often wrong tokens come from each network, so that guessing is slow. A good token from the same place,
/// as from behind a proxy, neither ends the count nor is held up by it. Of one thread.
class WrongTokens {
 public:
  using TimePoint = GuessCounts::TimePoint;

  static constexpr int kAtOnce = GuessCounts::kAtOnce;
  static constexpr auto kForgetOne = GuessCounts::kForgetOne;
  static constexpr auto kForgetAllMax = GuessCounts::kForgetAllMax;
  static constexpr std::size_t kNetworksMax = GuessCounts::kKeysMax;

  /// Counts one more from this client's address. Whether its network has sent more than is forgiven.
  bool is_too_often(const std::string& remote, TimePoint now) { return counts_.add(network_of(remote), now); }

  [[nodiscard]] std::size_t network_count() const { return counts_.size(); }

 private:
  GuessCounts counts_;
};

}  // namespace cell
