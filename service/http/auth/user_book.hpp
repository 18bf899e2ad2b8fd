#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/http/auth/session.hpp"

/// Who may sign in and who has: a value, which the functions here change. It knows neither file nor clock.
namespace cell {

struct User {
  std::string name;
  UserRole role = UserRole::kView;
  std::string secret_hash;  // hash_secret()
  std::string created_at;   // RFC 3339
  std::optional<std::string> created_by = {};
  std::optional<std::string> last_sign_in_at = {};

  bool operator==(const User&) const = default;
};

struct UserBook {
  std::vector<User> users;        // by name
  std::vector<Session> sessions;  // oldest first; is_over of none is set

  bool operator==(const UserBook&) const = default;
};

inline constexpr std::size_t kUsersMax = 100;
inline constexpr std::size_t kSessionsOfUserMax = 10;
inline constexpr std::size_t kUserNameBytesMax = 64;
/// Six digits at least, which is little: GuessCounts says how long they hold. A passphrase is better wherever
/// others than the people of the cell reach the daemon.
inline constexpr std::size_t kSecretBytesMin = 6;
inline constexpr std::size_t kSecretBytesMax = 128;

/// A shift: nobody has to sign in anew in the middle of it.
inline constexpr std::chrono::hours kSessionTime{10};
/// So long after its end a session can stop the arm.
inline constexpr std::chrono::hours kOverSessionKept{24};

/// What a name or a secret must be; nothing where it is that.
std::optional<std::string> why_no_user_name(std::string_view name);
std::optional<std::string> why_no_secret(std::string_view secret, std::string_view name);

/// Null where there is no such user.
const User* find_user(const UserBook& book, std::string_view name);

/// Adds the user, or takes the place of one with this name, whose sessions end. The time of creation and of
/// the last sign-in stay those of one who is there. False where kUsersMax are there already.
bool put_user(UserBook& book, User user);
/// With the sessions. False where there is no such user.
bool remove_user(UserBook& book, std::string_view name);
/// Gives the user another secret; their sessions end but the one with this digest. False where there is no
/// such user.
bool change_secret(UserBook& book, std::string_view name, std::string secret_hash,
                   std::string_view but_digest);
/// All sessions of the user end, but the one with this digest.
void end_sessions_of(UserBook& book, std::string_view name, std::string_view but_digest = {});

/// A session of a user who is there, which begins now. Where they have kSessionsOfUserMax, their oldest ends.
void begin_session(UserBook& book, std::string_view name, std::string token_digest,
                   std::chrono::system_clock::time_point now);
void end_session(UserBook& book, std::string_view token_digest);

/// Whether its time is, by the clock that dates it. SessionEnds tells what counts.
bool is_over(const Session& session, std::chrono::system_clock::time_point now);
/// How many of the user's are not over.
int session_count(const std::vector<Session>& sessions, std::string_view name);

}  // namespace cell
