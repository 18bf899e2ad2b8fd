#pragma once

namespace calib {

/// Marks a function that is compiled for 256-bit registers with fused multiply-add, with everything that it
/// calls inline. Call it only where has_wide_registers(); beside it stands the same function without the
/// mark.
#if defined(__x86_64__)
#define CALIB_FOR_WIDE_REGISTERS [[gnu::target("avx2,fma"), gnu::flatten]]
#else
#define CALIB_FOR_WIDE_REGISTERS
#endif

/// Whether this processor has them (AVX2 and FMA).
inline bool has_wide_registers() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
#else
  return false;
#endif
}

}  // namespace calib
