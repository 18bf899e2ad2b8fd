#pragma once

#include <malloc.h>

namespace cell {

/// Keeps what is freed for the next calibration, up to 64 MiB a thread; call it first in main(). A
/// calibration takes and frees some 400 KB, and giving them back to the system each time took half of the
/// time of ten thousand on two threads. Not for the daemon, which has hours between two results.
inline void keep_freed_memory() {
  constexpr int kKept = 64 << 20;        // bytes
  constexpr int kTakenAtOnce = 1 << 20;  // bytes
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kTakenAtOnce);
}

}  // namespace cell
