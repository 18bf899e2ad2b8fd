#include "service/http/auth/session_ends.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "config/utc_text.hpp"

namespace cell {

std::vector<Session> SessionEnds::sessions_at(const UserBook& book, std::chrono::system_clock::time_point now,
                                              std::chrono::steady_clock::time_point steady) {
  std::set<std::string_view> digests;
  for (const Session& session : book.sessions) digests.insert(session.token_digest);
  std::erase_if(ends_, [&](const auto& end) { return !digests.contains(end.first); });
  std::vector<Session> sessions;
  for (Session session : book.sessions) {
    End& end = end_of(session, now, steady);
    end.is_over = end.is_over || is_over(session, now) || steady >= end.at;
    if (is_over(session, now - kOverSessionKept) || steady >= end.at + kOverSessionKept) continue;
    session.is_over = end.is_over;
    sessions.push_back(std::move(session));
  }
  return sessions;
}

SessionEnds::End& SessionEnds::end_of(const Session& session, std::chrono::system_clock::time_point now,
                                      std::chrono::steady_clock::time_point steady) {
  const auto known = ends_.find(session.token_digest);
  if (known != ends_.end()) return known->second;
  using Duration = std::chrono::steady_clock::duration;
  const auto ends_at = time_from_utc(session.ends_at);
  // A clock that stood ahead when the session began, or stands behind now, makes it no longer.
  const Duration left = ends_at ? std::clamp(std::chrono::duration_cast<Duration>(*ends_at - now),
                                             Duration::zero(), Duration(kSessionTime))
                                : Duration::zero();
  return ends_[session.token_digest] = {.at = steady + left};
}

}  // namespace cell
