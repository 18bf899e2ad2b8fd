#include "service/archive/cached_fleet.hpp"

#include <spdlog/spdlog.h>

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
  const auto is_old = [now = clock_()](Steady at) { return now - at >= kKept; };
  if (failure_ && !is_old(failure_->at)) throw std::runtime_error(failure_->text);
  std::erase_if(answers_, [&](const auto& one) { return is_old(one.second.at); });
  if (const auto known = answers_.find(key); known != answers_.end()) return known->second.text;
  try {
    std::string text = ask();
    failure_.reset();
    answers_[key] = {.at = clock_(), .text = text};  // it may have been waited for
    return text;
  } catch (const std::runtime_error& error) {
    failure_ = {.at = clock_(), .text = error.what()};
    spdlog::warn("the fleet cannot be shown: {}", error.what());
    throw;
  }
}

}  // namespace cell
