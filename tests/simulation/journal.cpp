#include "tests/simulation/journal.hpp"

#include <spdlog/fmt/fmt.h>

namespace simulation {

void Journal::note(std::string_view who, std::string_view what) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(clock_.now()).count();
  fmt::format_to(std::back_inserter(text_), "{:>6}.{:03} s  {:<10}  {}\n", ms / 1000, ms % 1000, who, what);
}

}  // namespace simulation
