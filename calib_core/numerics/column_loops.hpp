#pragma once

#include <Eigen/Core>
#include <cstring>

/// Loops over contiguous numbers that are inlined into their caller, and so use the registers that it was
/// compiled for (wide_registers.hpp).
namespace calib::column_loops {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // inlined: how registers would be passed does not matter

inline constexpr Eigen::Index kAtOnce = 4;

/// An extension of GCC and Clang, whose operators act on each number.
typedef double Numbers __attribute__((vector_size(kAtOnce * sizeof(double))));

[[gnu::always_inline]] inline Numbers load(const double* from) {
  Numbers numbers;
  std::memcpy(&numbers, from, sizeof(numbers));
  return numbers;
}

[[gnu::always_inline]] inline void store(const Numbers& numbers, double* to) {
  std::memcpy(to, &numbers, sizeof(numbers));
}

[[gnu::always_inline]] inline double dot_product(const double* a, const double* b, Eigen::Index count) {
  Numbers even{}, odd{};
  Eigen::Index i = 0;
  for (; i + 2 * kAtOnce <= count; i += 2 * kAtOnce) {
    even += load(a + i) * load(b + i);
    odd += load(a + i + kAtOnce) * load(b + i + kAtOnce);
  }
  if (i + kAtOnce <= count) {
    even += load(a + i) * load(b + i);
    i += kAtOnce;
  }
  even += odd;
  double sum = (even[0] + even[1]) + (even[2] + even[3]);
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

/// to += factor * from
[[gnu::always_inline]] inline void add_multiple(double* to, const double* from, double factor,
                                                Eigen::Index count) {
  Eigen::Index i = 0;
  for (; i + kAtOnce <= count; i += kAtOnce) store(load(to + i) + factor * load(from + i), to + i);
  for (; i < count; ++i) to[i] += factor * from[i];
}

/// to += factor_a * a + factor_b * b
[[gnu::always_inline]] inline void add_multiples(double* to, const double* a, double factor_a,
                                                 const double* b, double factor_b, Eigen::Index count) {
  Eigen::Index i = 0;
  for (; i + kAtOnce <= count; i += kAtOnce)
    store(load(to + i) + factor_a * load(a + i) + factor_b * load(b + i), to + i);
  for (; i < count; ++i) to[i] += factor_a * a[i] + factor_b * b[i];
}

#pragma GCC diagnostic pop

}  // namespace calib::column_loops
