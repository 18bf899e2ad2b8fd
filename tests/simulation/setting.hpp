#pragma once

#include <memory>

#include "config/cell.hpp"
#include "service/documents/plan.hpp"
#include "service/run/tip_prediction.hpp"
#include "sim_controller/plant.hpp"

namespace simulation {

/// What all worlds of a process have in common, since it takes seconds to make: the cell, its true arm and
/// the plan of a run. A seed makes the first touches of it.
struct Setting {
  cell::Cell cell;
  sim::Plant plant;
  std::shared_ptr<const cell::Plan> plan;
  std::shared_ptr<const cell::TipRegions> regions;  // of the cell here
};

inline constexpr const char* kRecipe = "simulated";
/// Touches of a seed's run, and of the whole plan, which every hundredth seed makes.
inline constexpr int kTouchesMin = 6;
inline constexpr int kTouchesMax = 20;

/// Of the cell `edf`: few parameters, so that a result is there from few touches; made once.
const Setting& setting();

/// The plan's first touches, as a plan of its own.
std::shared_ptr<const cell::Plan> first_touches(const cell::Plan& plan, int count);

}  // namespace simulation
