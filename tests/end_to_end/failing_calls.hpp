#pragma once

#include <atomic>
#include <cstdint>

namespace touchcal::testing {

/// What can be made to fail in a process into which the library `failing_calls` is preloaded.
enum class FailingCall : std::uint32_t {
  kNone,
  kAllocation,  // malloc, calloc, realloc, aligned_alloc, posix_memalign: no memory
  kWrite,       // write, pwrite, writev to a file: no space (ENOSPC)
  kShortWrite,  // the same: half of the bytes are written and told
  kSync,        // fsync, fdatasync: EIO
  kKill         // half of the bytes of a write to a file, then SIGKILL
};

/// Lies at the beginning of the file $TOUCHCAL_FAILING_CALLS, which the process and the test map. Who arms it
/// sets the counts to 0 and `call` last. Writes to pipes, sockets and the standard streams are not counted.
struct FailingCallsBlock {
  std::atomic<FailingCall> call;
  std::atomic<std::int64_t> at;  // the call of that kind that fails, from 1; the others do what they do
  std::atomic<std::int64_t> allocations, writes, syncs;  // made since it was armed
  std::atomic<std::int64_t> failed;                      // how many were made to fail: 0 or 1
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace touchcal::testing
