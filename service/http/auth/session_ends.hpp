#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "service/http/auth/user_book.hpp"

namespace cell {

/// When sessions end in this process, whatever is done to the clock that dates them: none lasts longer than
/// kSessionTime of the steady clock after it was seen first, and none that was seen over begins again. Of one
/// thread.
class SessionEnds {
 public:
  /// The sessions of the book as they are now: without those that were over kOverSessionKept ago.
  std::vector<Session> sessions_at(const UserBook& book, std::chrono::system_clock::time_point now,
                                   std::chrono::steady_clock::time_point steady);

 private:
  struct End {
    std::chrono::steady_clock::time_point at;
    bool is_over = false;
  };
  End& end_of(const Session& session, std::chrono::system_clock::time_point now,
              std::chrono::steady_clock::time_point steady);

  std::map<std::string, End> ends_;  // by digest of the token
};

}  // namespace cell
