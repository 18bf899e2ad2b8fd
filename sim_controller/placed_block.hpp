#pragma once

#include <optional>
#include <string>

#include "sim_controller/cabinet.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// "the block has no place "x"; give one of ..."
std::string no_such_place(const PlantByPlace& plants, const std::string& place);

/// A person brings the block to another of its places. Nothing once it stands there, and then `plant` is that
/// of the place; else why it cannot be brought: a name that none of them has, the arm moves, the arm is where
/// the block is to stand.
std::optional<std::string> bring_block(const PlantByPlace& plants, const std::string& place, Plant& plant,
                                       Cabinet& cabinet);

}  // namespace sim
