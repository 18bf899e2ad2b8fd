// Preloaded into a daemon: memory and files of which the n-th call fails. What fails, and which call, stands
// in the file $TOUCHCAL_FAILING_CALLS, so that a test can arm it in the middle of a run.
#include "tests/end_to_end/failing_calls.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

// What malloc and its like are in glibc itself: dlsym() allocates, and could not be asked for them.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

using touchcal::testing::FailingCall;
using touchcal::testing::FailingCallsBlock;

FailingCallsBlock* block = nullptr;  // until the library is loaded nothing is counted

__attribute__((constructor)) void map_block() {
  const char* const file = std::getenv("TOUCHCAL_FAILING_CALLS");
  if (file == nullptr) return;
  const int descriptor = ::open(file, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) std::abort();  // a test in which nothing fails would pass
  void* const place =
      ::mmap(nullptr, sizeof(FailingCallsBlock), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  if (place == MAP_FAILED) std::abort();
  block = static_cast<FailingCallsBlock*>(place);
}

/// Whether the call of this number is the one that fails.
bool is_the_one(std::int64_t number, FailingCall call) {
  if (block->call != call || number != block->at) return false;
  ++block->failed;
  return true;
}

bool allocation_fails() {
  if (block == nullptr) return false;
  if (!is_the_one(++block->allocations, FailingCall::kAllocation)) return false;
  errno = ENOMEM;
  return true;
}

bool is_file(int descriptor) {
  struct stat about {};
  return descriptor > STDERR_FILENO && ::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
}

/// One write to a file. `write_first(n)` writes its first n bytes and returns what the call returned.
template <class WriteFirst>
ssize_t counted_write(int descriptor, std::size_t size, WriteFirst write_first) {
  if (block == nullptr || !is_file(descriptor)) return write_first(size);
  const std::int64_t number = ++block->writes;
  if (is_the_one(number, FailingCall::kWrite)) {
    errno = ENOSPC;
    return -1;
  }
  if (is_the_one(number, FailingCall::kShortWrite)) return write_first((size + 1) / 2);
  if (is_the_one(number, FailingCall::kKill)) {
    write_first(size / 2);
    ::kill(::getpid(), SIGKILL);
  }
  return write_first(size);
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// Of files and of directories, whose names are made durable.
int counted_sync(int descriptor, int (*sync)(int)) {
  if (block != nullptr && is_the_one(++block->syncs, FailingCall::kSync)) {
    errno = EIO;
    return -1;
  }
  return sync(descriptor);
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept { return allocation_fails() ? nullptr : __libc_malloc(size); }

void* calloc(std::size_t count, std::size_t size) noexcept {
  return allocation_fails() ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) noexcept {
  return size > 0 && allocation_fails() ? nullptr : __libc_realloc(old, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return allocation_fails() ? nullptr : __libc_memalign(alignment, size);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t size) noexcept {
  if (allocation_fails()) return ENOMEM;
  *place = __libc_memalign(alignment, size);
  return *place == nullptr ? ENOMEM : 0;
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  static const auto next = real<ssize_t (*)(int, const void*, std::size_t)>("write");
  return counted_write(descriptor, size, [&](std::size_t first) { return next(descriptor, bytes, first); });
}

ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off64_t offset) {
  static const auto next = real<ssize_t (*)(int, const void*, std::size_t, off64_t)>("pwrite64");
  return counted_write(descriptor, size,
                       [&](std::size_t first) { return next(descriptor, bytes, first, offset); });
}

ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t offset) {
  return pwrite64(descriptor, bytes, size, offset);
}

int fdatasync(int descriptor) {
  static const auto next = real<int (*)(int)>("fdatasync");
  return counted_sync(descriptor, next);
}

int fsync(int descriptor) {
  static const auto next = real<int (*)(int)>("fsync");
  return counted_sync(descriptor, next);
}

}  // extern "C"
