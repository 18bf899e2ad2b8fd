#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>
#include <stdexcept>

namespace cell {

/// This process gets no memory for a hash, to the end of its scope; small pieces it gets.
class RefusedMemory {
 public:
  RefusedMemory() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    constexpr rlim_t kSmall = rlim_t{24} * 1024 * 1024;
    rlimit limit{};
    if (pages == 0 || ::getrlimit(RLIMIT_AS, &before_) != 0) throw std::runtime_error("no limit is known");
    limit = before_;
    limit.rlim_cur = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + kSmall;
    if (::setrlimit(RLIMIT_AS, &limit) != 0) throw std::runtime_error("no limit can be set");
  }
  ~RefusedMemory() { ::setrlimit(RLIMIT_AS, &before_); }
  RefusedMemory(const RefusedMemory&) = delete;
  RefusedMemory& operator=(const RefusedMemory&) = delete;

 private:
  rlimit before_{};
};

}  // namespace cell
