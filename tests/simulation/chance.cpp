#include "tests/simulation/chance.hpp"

namespace simulation {

int Chance::below(int count) { return static_cast<int>(generator_() % static_cast<std::uint64_t>(count)); }

Time Chance::between(Time first, Time last) {
  const auto span = std::chrono::duration_cast<std::chrono::milliseconds>(last - first).count();
  return first + std::chrono::milliseconds(generator_() % static_cast<std::uint64_t>(span + 1));
}

}  // namespace simulation
