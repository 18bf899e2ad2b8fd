#include "service/http/auth/user_book.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "service/base/utc_time.hpp"

namespace cell {
namespace {

bool has_control_character(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

/// Whether each character follows from the one before it by the same step: 123456, 987654, 000000, abcdef,
/// and digits also over their end, 890123.
bool is_sequence(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool is_number = std::ranges::all_of(text, is_digit);
  for (const int step : {0, 1, -1}) {
    const auto follows = [&](char before, char next) {
      return is_number ? (before - '0' + step + 10) % 10 == next - '0' : before + step == next;
    };
    std::size_t i = 1;
    while (i < text.size() && follows(text[i - 1], text[i])) ++i;
    if (i >= text.size()) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string> why_no_user_name(std::string_view name) {
  const bool is_step = name == "." || name == "..";  // of a path, which a browser would take
  const bool has_blank_end = !name.empty() && (name.front() == ' ' || name.back() == ' ');
  if (!name.empty() && name.size() <= kUserNameBytesMax && !has_blank_end && !is_step &&
      !has_control_character(name))
    return std::nullopt;
  return fmt::format(
      "a name of 1 to {} bytes is required, without control characters and without a blank at its ends",
      kUserNameBytesMax);
}

std::optional<std::string> why_no_secret(std::string_view secret, std::string_view name) {
  if (secret.size() < kSecretBytesMin || secret.size() > kSecretBytesMax || has_control_character(secret))
    return fmt::format("a PIN or a passphrase of {} to {} bytes is required, without control characters",
                       kSecretBytesMin, kSecretBytesMax);
  if (secret == name) return "the name is no secret; choose another one";
  if (is_sequence(secret))
    return "one character over and over, or each the next of the one before (123456), is the first that is "
           "tried; choose another secret";
  return std::nullopt;
}

const User* find_user(const UserBook& book, std::string_view name) {
  const auto found = std::ranges::find(book.users, name, &User::name);
  return found == book.users.end() ? nullptr : &*found;
}

bool put_user(UserBook& book, User user) {
  const auto place = std::ranges::lower_bound(book.users, user.name, {}, &User::name);
  if (place != book.users.end() && place->name == user.name) {
    end_sessions_of(book, user.name);
    user.created_at = place->created_at;
    user.created_by = place->created_by;
    user.last_sign_in_at = place->last_sign_in_at;
    *place = std::move(user);
    return true;
  }
  if (book.users.size() >= kUsersMax) return false;
  book.users.insert(place, std::move(user));
  return true;
}

bool remove_user(UserBook& book, std::string_view name) {
  end_sessions_of(book, name);
  return std::erase_if(book.users, [&](const User& user) { return user.name == name; }) > 0;
}

bool change_secret(UserBook& book, std::string_view name, std::string secret_hash,
                   std::string_view but_digest) {
  const auto user = std::ranges::find(book.users, name, &User::name);
  if (user == book.users.end()) return false;
  user->secret_hash = std::move(secret_hash);
  end_sessions_of(book, name, but_digest);
  return true;
}

void end_sessions_of(UserBook& book, std::string_view name, std::string_view but_digest) {
  std::erase_if(book.sessions, [&](const Session& session) {
    return session.user == name && session.token_digest != but_digest;
  });
}

void begin_session(UserBook& book, std::string_view name, std::string token_digest,
                   std::chrono::system_clock::time_point now) {
  const auto user = std::ranges::find(book.users, name, &User::name);
  if (user == book.users.end()) return;
  std::erase_if(book.sessions,
                [&](const Session& session) { return is_over(session, now - kOverSessionKept); });
  const auto is_theirs = [&](const Session& session) { return session.user == name; };
  if (static_cast<std::size_t>(std::ranges::count_if(book.sessions, is_theirs)) >= kSessionsOfUserMax)
    book.sessions.erase(std::ranges::find_if(book.sessions, is_theirs));
  user->last_sign_in_at = format_utc(now);
  book.sessions.push_back({.token_digest = std::move(token_digest),
                           .user = user->name,
                           .role = user->role,
                           .ends_at = format_utc(now + kSessionTime)});
}

void end_session(UserBook& book, std::string_view token_digest) {
  std::erase_if(book.sessions, [&](const Session& session) { return session.token_digest == token_digest; });
}

bool is_over(const Session& session, std::chrono::system_clock::time_point now) {
  // RFC 3339 in UTC with milliseconds: the order of the texts is that of the times.
  return session.ends_at <= format_utc(now);
}

int session_count(const std::vector<Session>& sessions, std::string_view name) {
  return static_cast<int>(std::ranges::count_if(
      sessions, [&](const Session& session) { return session.user == name && !session.is_over; }));
}

}  // namespace cell
