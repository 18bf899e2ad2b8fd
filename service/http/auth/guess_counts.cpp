#include "service/http/auth/guess_counts.hpp"

#include <algorithm>
#include <utility>

namespace cell {

bool GuessCounts::add(std::string key, TimePoint now) {
  Count& count = count_of(std::move(key));
  count.latest = now;
  // Each wrong one moves this ahead; it may be ahead of the clock by what is forgiven.
  const TimePoint next = std::max(count.forgotten_at, now) + kForgetOne;
  count.forgotten_at = std::min(next, now + kForgetAllMax);
  return next - now > kAtOnce * kForgetOne;
}

std::chrono::steady_clock::duration GuessCounts::wait(const std::string& key, TimePoint now) const {
  const auto known = counts_.find(key);
  if (known == counts_.end()) return {};
  return std::max(known->second.forgotten_at - now - (kAtOnce - 1) * kForgetOne,
                  std::chrono::steady_clock::duration::zero());
}

GuessCounts::Count& GuessCounts::count_of(std::string key) {
  const auto known = counts_.find(key);
  if (known != counts_.end()) return known->second;
  if (counts_.size() >= kKeysMax)
    counts_.erase(std::ranges::min_element(counts_, {}, [](const auto& one) { return one.second.latest; }));
  return counts_[std::move(key)];
}

}  // namespace cell
