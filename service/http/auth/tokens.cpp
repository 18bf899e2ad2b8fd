#include "service/http/auth/tokens.hpp"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <iterator>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "service/base/state_directory.hpp"
#include "service/http/auth/token_file.hpp"

namespace cell {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw std::runtime_error(
      fmt::format("{}: {}: {}", file.string(), what, std::generic_category().message(errno)));
}

/// Beside the file, and then in its place: a part of a token, which who is killed in the middle would leave,
/// prevents the next start.
void write_for_owner_only(const std::filesystem::path& file, const std::string& token) {
  std::filesystem::path beside = file;
  beside += ".new";
  ::unlink(beside.c_str());  // of such a one; its rights may be anybody's
  const int descriptor = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) fail(file, "the token cannot be created");
  const std::string line = token + "\n";
  const bool written = ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const bool durable = written && ::fsync(descriptor) == 0;
  const bool in_place = durable && ::rename(beside.c_str(), file.c_str()) == 0;
  const int reason = errno;
  ::close(descriptor);
  if (in_place) return;
  ::unlink(beside.c_str());
  errno = reason;
  fail(file, "the token cannot be written");
}

std::string load_or_make(const std::filesystem::path& file) {
  if (auto token = read_token(file)) return *std::move(token);
  std::string token = random_hex(kTokenBytes);
  try {
    write_for_owner_only(file, token);
  } catch (const std::runtime_error& failure) {  // it has gone with its directory, or the disk is full
    throw TokenUnreadable(failure.what());
  }
  return token;
}

std::optional<std::string> why_not_there(const KnownDirectory& state_directory) {
  const std::string place = state_directory.path().string();
  switch (state_directory.look()) {
    case KnownDirectory::Found::kItself:
      return std::nullopt;
    case KnownDirectory::Found::kNothing:
      return place + ": the state directory is gone; move it back, or stop the daemon";
    case KnownDirectory::Found::kAnother:
      return place +
             ": the state directory is gone, and another stands in its place; move it back, or start "
             "the daemon again to take this one";
  }
  return std::nullopt;
}

}  // namespace

std::string random_hex(std::size_t bytes) {
  std::vector<unsigned char> random(bytes);
  // The library's own context is made at its first use. Without memory for it RAND_bytes() crashes.
  if (OSSL_LIB_CTX_get0_global_default() == nullptr) throw std::bad_alloc();
  if (RAND_bytes(random.data(), static_cast<int>(bytes)) != 1)
    throw std::runtime_error("no random numbers are available");
  std::string text;
  for (const unsigned char byte : random) text += fmt::format("{:02x}", byte);
  return text;
}

Tokens load_or_make_tokens(const std::filesystem::path& state_directory) {
  std::string operate = load_or_make(state_directory / kOperateTokenFile);
  std::string view = load_or_make(state_directory / kViewTokenFile);
  return {std::move(operate), std::move(view), read_operator_tokens(state_directory)};
}

CurrentTokens tokens_now(const KnownDirectory& state_directory, const Tokens& known) {
  // Whoever moved the directory withdrew nothing, and STOP needs a token: it is looked for before and after.
  if (auto trouble = why_not_there(state_directory)) return {known, {}, {*std::move(trouble)}};
  CurrentTokens now;
  now.tokens.sessions = known.sessions;  // no file of a token says anything of them
  const auto read = [&](std::string_view file, const std::string& before) -> std::string {
    try {
      return load_or_make(state_directory.path() / file);
    } catch (const TokenUnreadable& trouble) {
      (before.empty() ? now.troubles : now.kept).emplace_back(trouble.what());
      return before;
    } catch (const std::runtime_error& refused) {
      now.troubles.emplace_back(refused.what());
      return {};
    }
  };
  now.tokens.operate = read(kOperateTokenFile, known.operate);
  now.tokens.view = read(kViewTokenFile, known.view);
  CurrentOperators operators = operator_tokens_now(state_directory.path(), known.operators);
  now.tokens.operators = std::move(operators.tokens);
  std::ranges::move(operators.troubles, std::back_inserter(now.troubles));
  std::ranges::move(operators.kept, std::back_inserter(now.kept));
  if (auto trouble = why_not_there(state_directory)) return {known, {}, {*std::move(trouble)}};
  return now;
}

bool same_token(std::string_view expected, std::string_view presented) {
  return !expected.empty() && expected.size() == presented.size() &&
         CRYPTO_memcmp(expected.data(), presented.data(), expected.size()) == 0;
}

}  // namespace cell
