#pragma once

#include <cstdint>
#include <random>

#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// What is drawn in a world. The figures of the standard library's distributions are its own; these are the
/// same everywhere.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : generator_(seed) {}

  /// 0 to count - 1.
  int below(int count);
  /// From first to last, to the millisecond.
  Time between(Time first, Time last);
  /// Once in `times`.
  bool once_in(int times) { return below(times) == 0; }
  std::uint64_t seed() { return generator_(); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace simulation
