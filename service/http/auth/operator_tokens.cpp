#include "service/http/auth/operator_tokens.hpp"

#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "service/base/state_directory.hpp"
#include "service/http/auth/token_file.hpp"

namespace cell {
namespace {

constexpr std::string_view kWrittenByHand = "write a new one into it ('openssl rand -hex 32') or remove it";

bool is_token_name(std::string_view name) {
  const auto is_taken = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return name.size() <= kTokenNameBytesMax && std::ranges::all_of(name, is_taken);
}

[[noreturn]] void refuse_place(const std::filesystem::path& place, std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", place.string(), what));
}

/// Of another owner than this user, root, or the directory that it stands in.
bool is_strangers(const std::filesystem::path& directory) {
  struct stat own = {}, above = {};
  if (::stat(directory.c_str(), &own) != 0 || own.st_uid == ::geteuid() || own.st_uid == 0) return false;
  return ::stat(directory.parent_path().c_str(), &above) != 0 || above.st_uid != own.st_uid;
}

/// By name, however the file system lists them.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& directory) {
  constexpr auto kOthersWrite = std::filesystem::perms::group_write | std::filesystem::perms::others_write;
  std::error_code failure;
  const auto status = std::filesystem::status(directory, failure);
  if (status.type() == std::filesystem::file_type::not_found) return {};
  if (!failure && status.type() != std::filesystem::file_type::directory)
    refuse_place(directory, "is not a directory; remove it, or make a directory with a file for each token");
  if (!failure && (status.permissions() & kOthersWrite) != std::filesystem::perms::none)
    refuse_place(directory, fmt::format("others than its owner may put tokens into it; look at what is "
                                        "there, then chmod 700 {}",
                                        directory.string()));
  if (!failure && is_strangers(directory))
    refuse_place(directory,
                 fmt::format("belongs to another user than the state directory, who may put tokens "
                             "into it; look at what is there, then chown -R --reference={} {}",
                             directory.parent_path().string(), directory.string()));
  std::vector<std::filesystem::path> files;
  std::filesystem::directory_iterator entry(directory, failure);
  for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
    if (files.size() == kOperatorTokensMax)
      refuse_place(directory, fmt::format("holds more than {} tokens; remove those that nobody uses",
                                          kOperatorTokensMax));
    files.push_back(entry->path());
  }
  if (failure == std::errc::permission_denied || failure == std::errc::operation_not_permitted)
    refuse_place(directory, "cannot be read by this user; make it this user's own");
  if (failure)
    throw TokenUnreadable(fmt::format("{}: cannot be read: {}; make it this user's own", directory.string(),
                                      failure.message()));
  std::ranges::sort(files);
  return files;
}

NamedToken read_named_token(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  if (!is_token_name(name))
    refuse_place(file, fmt::format("the name of a token is of at most {} letters, digits, '-' and '_'; "
                                   "rename the file or remove it",
                                   kTokenNameBytesMax));
  std::error_code ignored;  // read_token() tells it
  const auto type = std::filesystem::status(file, ignored).type();
  if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::none)
    refuse_place(file, "is not a file; remove it");
  auto token = read_token(file, kWrittenByHand);
  if (!token) refuse_place(file, "went while it was read; start again");
  return {.name = name, .token = *std::move(token)};
}

/// Throws as reading does where nothing is known of it.
NamedToken read_or_known(const std::filesystem::path& file, const std::vector<NamedToken>& known,
                         std::vector<std::string>& kept) try {
  return read_named_token(file);
} catch (const TokenUnreadable& trouble) {
  const auto before = std::ranges::find(known, file.filename().string(), &NamedToken::name);
  if (before == known.end()) throw;
  kept.emplace_back(trouble.what());
  return *before;
}

/// Nothing also where it is refused, which who reads it for its own sake tells.
std::optional<std::string> token_without_name(const std::filesystem::path& file) try {
  return read_token(file);
} catch (const std::runtime_error&) {
  return std::nullopt;
}

}  // namespace

CurrentOperators operator_tokens_now(const std::filesystem::path& state_directory,
                                     const std::vector<NamedToken>& known) {
  struct Held {
    std::filesystem::path place;
    std::string token;
  };
  CurrentOperators now;
  std::vector<std::filesystem::path> files;
  try {
    files = files_in(state_directory / kOperatorsDirectory);
  } catch (const TokenUnreadable& trouble) {
    now.tokens = known;
    (known.empty() ? now.troubles : now.kept).emplace_back(trouble.what());
    return now;
  } catch (const std::runtime_error& refused) {
    now.troubles.emplace_back(refused.what());
    return now;
  }
  if (files.empty()) return now;
  std::vector<Held> all;
  for (const std::string_view file : {kOperateTokenFile, kViewTokenFile})
    if (auto token = token_without_name(state_directory / file))
      all.push_back({state_directory / file, *std::move(token)});
  for (const std::filesystem::path& file : files) {
    try {
      NamedToken read = read_or_known(file, known, now.kept);
      const auto same = std::ranges::find(all, read.token, &Held::token);
      if (same != all.end())
        refuse_place(file,
                     fmt::format("holds the token of {} too; {}", same->place.string(), kWrittenByHand));
      all.push_back({file, read.token});
      now.tokens.push_back(std::move(read));
    } catch (const std::runtime_error& refused) {
      now.troubles.emplace_back(refused.what());
    }
  }
  return now;
}

std::vector<NamedToken> read_operator_tokens(const std::filesystem::path& state_directory) {
  CurrentOperators now = operator_tokens_now(state_directory);
  if (!now.troubles.empty()) throw std::runtime_error(now.troubles.front());
  return std::move(now.tokens);
}

}  // namespace cell
