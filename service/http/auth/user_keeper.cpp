#include "service/http/auth/user_keeper.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/utc_text.hpp"
#include "service/base/durable_file.hpp"
#include "service/base/utc_time.hpp"
#include "service/http/auth/secret_hash.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigestDigits = 64;

void demand_own_file(const fs::path& file) {
  const auto rights = fs::status(file).permissions();
  if ((rights & (fs::perms::group_all | fs::perms::others_all)) == fs::perms::none) return;
  throw std::runtime_error(fmt::format(
      "{0}: others than its owner have access to who may sign in; chmod 600 {0} when nobody has changed it",
      file.string()));
}

UserRole role_at(const JsonObject& entry) {
  const auto role = user_role_named(entry.at("role").text());
  if (!role) entry.at("role").fail("must be 'view', 'operate' or 'engineer'");
  return *role;
}

/// In the one form that texts of times are compared in.
std::string time_at(const JsonObject& entry, std::string_view key) {
  const auto time = time_from_utc(entry.at(key).text());
  if (!time) entry.at(key).fail("must be a time in UTC such as '2026-01-31T08:15:30.000Z'");
  return format_utc(*time);
}

User user_in(const JsonValue& value) {
  const JsonObject entry =
      value.object({"name", "role", "secret_hash", "created_at", "created_by", "last_sign_in_at"});
  User user{.name = entry.at("name").text(),
            .role = role_at(entry),
            .secret_hash = entry.at("secret_hash").text(),
            .created_at = time_at(entry, "created_at")};
  if (const auto why = why_no_user_name(user.name)) entry.at("name").fail(*why);
  if (!is_secret_hash(user.secret_hash)) entry.at("secret_hash").fail("is no hash that this daemon makes");
  if (!entry.at("created_by").is_null()) user.created_by = entry.at("created_by").text();
  if (!entry.at("last_sign_in_at").is_null()) user.last_sign_in_at = time_at(entry, "last_sign_in_at");
  return user;
}

Session session_in(const JsonValue& value, const UserBook& book) {
  const JsonObject entry = value.object({"token_sha256", "user", "ends_at"});
  const User* user = find_user(book, entry.at("user").text());
  if (!user) entry.at("user").fail("is not among the users");
  std::string digest = entry.at("token_sha256").text();
  if (digest.size() != kDigestDigits || digest.find_first_not_of("0123456789abcdef") != std::string::npos)
    entry.at("token_sha256").fail("must be 64 hexadecimal digits");
  return {.token_digest = std::move(digest),
          .user = user->name,
          .role = user->role,
          .ends_at = time_at(entry, "ends_at")};
}

UserBook book_in(const fs::path& file) {
  const std::string source = file.string();
  const nlohmann::json json = read_json_file(file);
  const JsonObject document =
      JsonValue(source, json).document(kUserFileSchema, {"schema", "users", "sessions"});
  UserBook book;
  for (const JsonValue& value : document.at("users").items(0, kUsersMax)) {
    User user = user_in(value);
    if (find_user(book, user.name)) value.fail("names a user a second time");
    put_user(book, std::move(user));
  }
  for (const JsonValue& value : document.at("sessions").items(0, kUsersMax * kSessionsOfUserMax))
    book.sessions.push_back(session_in(value, book));
  return book;
}

}  // namespace

UserBook read_user_file(const fs::path& file) {
  if (!fs::exists(file)) return {};
  demand_own_file(file);
  try {
    return book_in(file);
  } catch (const ConfigError& error) {
    throw std::runtime_error(fmt::format(
        "{}; mend it, or remove the file: then nobody can sign in until users are made anew", error.what()));
  }
}

void write_user_file(const fs::path& file, const UserBook& book) {
  nlohmann::ordered_json document{{"schema", kUserFileSchema}};
  auto& users = document["users"] = nlohmann::ordered_json::array();
  for (const User& user : book.users) {
    nlohmann::ordered_json& entry = users.emplace_back();
    entry = {{"name", user.name},
             {"role", user_role_name(user.role)},
             {"secret_hash", user.secret_hash},
             {"created_at", user.created_at},
             {"created_by", nullptr},
             {"last_sign_in_at", nullptr}};
    if (user.created_by) entry["created_by"] = *user.created_by;
    if (user.last_sign_in_at) entry["last_sign_in_at"] = *user.last_sign_in_at;
  }
  auto& sessions = document["sessions"] = nlohmann::ordered_json::array();
  for (const Session& session : book.sessions)
    sessions.push_back(
        {{"token_sha256", session.token_digest}, {"user", session.user}, {"ends_at", session.ends_at}});
  replace_file(file, document.dump(1) + '\n');
}

UserKeeper::UserKeeper(std::optional<fs::path> file) : file_(std::move(file)) {
  if (file_) book_ = read_user_file(*file_);
}

bool UserKeeper::change(const std::function<Effect(UserBook&)>& change) {
  UserBook changed = book_;
  const Effect effect = change(changed);
  if (changed == book_) return true;
  if (effect == Effect::kGives) {
    // Where writing fails the file may hold it nevertheless: keep() writes again what counts.
    is_kept_ = false;
    if (file_) write_user_file(*file_, changed);
    book_ = std::move(changed);
    is_kept_ = true;
    is_logged_ = false;
    return true;
  }
  book_ = std::move(changed);
  is_kept_ = false;
  return keep();
}

bool UserKeeper::keep() {
  if (is_kept_) return true;
  try {
    if (file_) write_user_file(*file_, book_);
    is_kept_ = true;
    is_logged_ = false;
  } catch (const std::exception& error) {
    if (!is_logged_)
      spdlog::error("who was removed, changed or signed out counts, and a restart would undo it: {}",
                    error.what());
    is_logged_ = true;
  }
  return is_kept_;
}

}  // namespace cell
