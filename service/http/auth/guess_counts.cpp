#include "service/http/auth/guess_counts.hpp"

#include <algorithm>
#include <utility>

namespace cell {

bool GuessCounts::add(std::string key, TimePoint now) {
  if (forgotten_at_.size() >= kKeysMax && !forgotten_at_.contains(key))
    forgotten_at_.erase(
        std::ranges::min_element(forgotten_at_, {}, [](const auto& one) { return one.second; }));
  TimePoint& forgotten_at = forgotten_at_[std::move(key)];
  // Each wrong one moves this ahead; it may be ahead of the clock by what is forgiven.
  const TimePoint next = std::max(forgotten_at, now) + kForgetOne;
  forgotten_at = std::min(next, now + kForgetAllMax);
  return next - now > kAtOnce * kForgetOne;
}

std::chrono::steady_clock::duration GuessCounts::wait(const std::string& key, TimePoint now) const {
  const auto known = forgotten_at_.find(key);
  if (known == forgotten_at_.end()) return {};
  return std::max(known->second - now - (kAtOnce - 1) * kForgetOne,
                  std::chrono::steady_clock::duration::zero());
}

bool GuessCounts::knows(const std::string& key, TimePoint now) const {
  const auto known = forgotten_at_.find(key);
  return known != forgotten_at_.end() && known->second > now;
}

void GuessCounts::take_back(const std::string& key) {
  const auto known = forgotten_at_.find(key);
  if (known != forgotten_at_.end()) known->second -= kForgetOne;
}

}  // namespace cell
