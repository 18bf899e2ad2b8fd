#include "service/http/auth/token_file.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace cell {
namespace {

/// A file that is looked at once a second, whatever somebody makes of it: a pipe does not hold who opens it,
/// and of a large file only the beginning is read.
class OpenedFile {
 public:
  explicit OpenedFile(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)), error_(errno) {
    if (!is_open() || ::fstat(descriptor_, &status_) == 0) return;
    error_ = errno;
    ::close(descriptor_);
    descriptor_ = -1;
  }
  ~OpenedFile() {
    if (is_open()) ::close(descriptor_);
  }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] bool is_missing() const { return !is_open() && (error_ == ENOENT || error_ == ENOTDIR); }
  [[nodiscard]] bool is_regular() const { return S_ISREG(status_.st_mode); }
  [[nodiscard]] bool is_open_to_others() const { return (status_.st_mode & (S_IRWXG | S_IRWXO)) != 0; }
  [[nodiscard]] uid_t owner() const { return status_.st_uid; }
  [[nodiscard]] int error() const { return error_; }
  /// Without its end; at most so many characters. Nothing, and error() is why, if it cannot be read.
  [[nodiscard]] std::optional<std::string> first_line(std::size_t characters_max) {
    std::string text(characters_max, '\0');
    const ssize_t count = ::read(descriptor_, text.data(), text.size());
    error_ = errno;
    if (count < 0) return std::nullopt;
    text.resize(static_cast<std::size_t>(count));
    return text.substr(0, text.find('\n'));
  }

 private:
  int descriptor_ = -1;
  int error_ = 0;
  struct stat status_ = {};
};

[[noreturn]] void tell_unreadable(const std::filesystem::path& file, int error) {
  const std::string text = fmt::format("{}: the token cannot be read: {}; make the file this user's own",
                                       file.string(), std::generic_category().message(error));
  // Rights are somebody's decision, and a disk that fails is nobody's.
  if (error == EACCES || error == EPERM) throw std::runtime_error(text);
  throw TokenUnreadable(text);
}

/// Whose tokens count here: the directory's owner could put another file there anyhow.
bool is_trusted(uid_t owner, const std::filesystem::path& file) {
  if (owner == ::geteuid() || owner == 0) return true;
  struct stat directory = {};
  return ::stat(file.parent_path().c_str(), &directory) == 0 && directory.st_uid == owner;
}

}  // namespace

std::optional<std::string> read_token(const std::filesystem::path& file, std::string_view replacement) {
  OpenedFile existing(file);
  if (existing.is_missing()) return std::nullopt;
  if (!existing.is_open()) tell_unreadable(file, existing.error());
  if (!existing.is_regular())
    throw std::runtime_error(
        fmt::format("{}: is no file that holds a token; {}", file.string(), replacement));
  if (existing.is_open_to_others()) {
    throw std::runtime_error(
        fmt::format("{0}: others than its owner have access; {1}, or chmod 600 {0} when nobody has read it",
                    file.string(), replacement));
  }
  if (!is_trusted(existing.owner(), file)) {
    throw std::runtime_error(fmt::format(
        "{0}: belongs to another user than its directory, who knows it; {1}, or chown --reference={2} {0}",
        file.string(), replacement, file.parent_path().string()));
  }
  auto line = existing.first_line(kTokenCharactersMax + 1);
  if (!line) tell_unreadable(file, existing.error());
  const std::string& token = *line;
  const bool is_visible = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() < 2 * kTokenBytes || token.size() > kTokenCharactersMax || !is_visible) {
    throw NoToken(fmt::format("{}: does not hold a token; {}", file.string(), replacement));
  }
  return line;
}

}  // namespace cell
