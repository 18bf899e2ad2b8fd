#pragma once

#include <cstdint>
#include <random>

namespace calib {

/// Uniform random numbers in [0, 1). The sequence of a seed is the same on every platform, which the standard
/// does not promise for the distributions of <random>.
class UniformChance {
 public:
  explicit UniformChance(std::uint64_t seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_() >> 11) * 0x1.0p-53; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace calib
