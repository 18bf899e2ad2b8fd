#include "tests/twins/parts.hpp"
#include "tests/twins/scenarios.hpp"

namespace twins {

/// Nothing goes wrong: touches, two-speed touches and travels in several orders, with several seeds.
std::vector<Scenario> whole_runs() {
  std::vector<Scenario> all;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const std::string name = " with seed " + std::to_string(seed);
    all.push_back(
        {.name = "four touches" + name, .steps = begun() + touches(1, 4) + finished(), .seed = seed});
    Steps two_speeds = begun();
    for (std::uint32_t i = 1; i <= 3; ++i)
      two_speeds += carried_out(i, two_speed_touch_at(static_cast<int>(i)));
    all.push_back({.name = "three two-speed touches" + name, .steps = two_speeds + finished(), .seed = seed});
    all.push_back({.name = "touches between travels" + name,
                   .steps = begun() + touches(1, 2) + carried_out(3, travel_to(0)) +
                            carried_out(4, two_speed_touch_at(1)) + carried_out(5, travel_to(4)) + finished(),
                   .seed = seed});
  }
  return all;
}

}  // namespace twins
