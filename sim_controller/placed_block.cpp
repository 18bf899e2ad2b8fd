#include "sim_controller/placed_block.hpp"

#include "config/block_place.hpp"
#include "config/config_error.hpp"
#include "sim_controller/contact.hpp"

namespace sim {

std::string no_such_place(const PlantByPlace& plants, const std::string& place) {
  std::string known = cell::in_quotes(cell::kFirstPlace);
  for (const auto& [name, unused] : plants)
    if (name != cell::kFirstPlace) known += ", " + cell::in_quotes(name);
  return "the block has no place " + cell::in_quotes(place) + "; give one of " + known;
}

std::optional<std::string> bring_block(const PlantByPlace& plants, const std::string& place, Plant& plant,
                                       Cabinet& cabinet) {
  const auto there = plants.find(place);
  if (there == plants.end()) return no_such_place(plants, place);
  if (!is_empty(cabinet.drives) || !is_settled(cabinet.drives)) return "the arm moves";
  World world = cabinet.world;
  take_plant(there->second, world);
  const Room room = room_around(there->second.scene, true_chain(there->second, world, world.joints), {});
  if (room.way_m <= 0.0) return "the arm is in the way: " + room.hit;
  plant = there->second;
  cabinet.world = world;
  return std::nullopt;
}

}  // namespace sim
