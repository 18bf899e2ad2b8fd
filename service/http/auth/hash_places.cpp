#include "service/http/auth/hash_places.hpp"

namespace cell {

std::optional<HashPlaces::Place> HashPlaces::take_as_stranger(const std::string& network) {
  if (of_strangers_ >= kOfStrangers) return std::nullopt;
  const auto known = of_network_.find(network);
  if (known != of_network_.end() && known->second >= kOfNetwork) return std::nullopt;
  ++of_network_[network];
  ++of_strangers_;
  return Place(*this, network);
}

std::optional<HashPlaces::Place> HashPlaces::take_by_token() {
  if (of_tokens_ >= kOfTokens) return std::nullopt;
  ++of_tokens_;
  return Place(*this, std::nullopt);
}

void HashPlaces::leave(const std::optional<std::string>& network) {
  if (!network) {
    --of_tokens_;
    return;
  }
  --of_strangers_;
  const auto known = of_network_.find(*network);
  if (--known->second == 0) of_network_.erase(known);
}

}  // namespace cell
