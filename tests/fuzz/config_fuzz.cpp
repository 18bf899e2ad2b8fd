#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/arm_file.hpp"
#include "config/block_file.hpp"
#include "config/config_error.hpp"
#include "config/probe_file.hpp"
#include "config/read_config.hpp"

namespace {

/// A file in memory that is written anew for each input.
class FileInMemory {
 public:
  FileInMemory() : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0) std::abort();
  }
  std::filesystem::path with(std::string_view bytes) const {
    if (ftruncate(descriptor_, 0) != 0) std::abort();
    if (pwrite(descriptor_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
      std::abort();
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace

/// The first byte says which file of a cell the others are: it is taken, or refused with its place and words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FileInMemory memory;
  using Path = const std::filesystem::path&;
  static const std::vector<std::function<void(Path)>> readers{
      [](Path file) { (void)cell::read_cell(file); },
      [](Path file) { (void)cell::read_arm(file); },
      [](Path file) { (void)cell::read_block(file); },
      [](Path file) { (void)cell::read_probe(file); },
  };
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    readers[data[0] % readers.size()](memory.with(bytes));
  } catch (const cell::ConfigError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  return 0;
}
