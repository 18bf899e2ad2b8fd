#include "service/base/durable_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace cell {
namespace {

std::runtime_error trouble(const std::filesystem::path& file) {
  return std::runtime_error(file.string() + ": " + std::strerror(errno));
}

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : file_(file), number_(::open(file.c_str(), flags | O_CLOEXEC, 0600)) {
    if (number_ < 0) throw trouble(file);
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t done = ::write(number_, bytes.data(), bytes.size());
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) throw trouble(file_);
      bytes.remove_prefix(static_cast<std::size_t>(done));
    }
  }
  void make_durable() const {
    if (::fsync(number_) != 0) throw trouble(file_);
  }

 private:
  std::filesystem::path file_;
  int number_;
};

}  // namespace

void make_directory_durable(const std::filesystem::path& directory) {
  Descriptor(directory.empty() ? "." : directory, O_RDONLY | O_DIRECTORY).make_durable();
}

void replace_file(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path beside = file;
  beside += ".new";
  {
    const Descriptor made(beside, O_WRONLY | O_CREAT | O_TRUNC);
    made.write(bytes);
    made.make_durable();
  }
  std::filesystem::rename(beside, file);
  make_directory_durable(file.parent_path());
}

void remove_file(const std::filesystem::path& file) {
  if (::unlink(file.c_str()) == 0) {
    make_directory_durable(file.parent_path());
  } else if (errno != ENOENT) {
    throw trouble(file);
  }
}

}  // namespace cell
