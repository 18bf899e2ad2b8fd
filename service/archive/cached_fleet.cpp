#include "service/archive/cached_fleet.hpp"

#include <utility>

#include "service/archive/fleet_reader.hpp"

namespace cell {

CachedFleet::CachedFleet(std::string url, std::function<Steady()> clock)
    : url_(std::move(url)), clock_(std::move(clock)) {}

std::string CachedFleet::fleet() {
  return answer("fleet", [this] { return document_text(fleet_of(url_, kPatience)); });
}

std::string CachedFleet::trends(int months) {
  return answer("trends of " + std::to_string(months),
                [&] { return document_text(trends_of(url_, months, kPatience)); });
}

std::string CachedFleet::answer(const std::string& key, const std::function<std::string()>& ask) {
  std::erase_if(answers_, [&](const auto& one) { return clock_() - one.second.at >= kKept; });
  auto known = answers_.find(key);
  if (known == answers_.end()) {
    Answer now{.at = {}, .text = {}, .failure = {}};
    try {
      now.text = ask();
    } catch (const std::runtime_error& error) {
      now.failure = error.what();
    }
    now.at = clock_();  // it may have been waited for
    known = answers_.emplace(key, std::move(now)).first;
  }
  if (!known->second.failure.empty()) throw std::runtime_error(known->second.failure);
  return known->second.text;
}

}  // namespace cell
