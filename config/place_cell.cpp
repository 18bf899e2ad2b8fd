#include "config/place_cell.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "config/moved_cell.hpp"
#include "config/touched_places.hpp"

namespace cell {
namespace {

/// A stand is wider than the block on it by at most this, on each side.
constexpr double kStandOverhangMetres = 0.075;
/// A block that is lifted by less stands where it stood.
constexpr double kLiftMinMetres = 2e-3;

/// Nearer to where it stood before, the touches of the faces in between need the room.
constexpr double kRoomBetweenMetres = 0.04;

/// The largest gap between two boxes along an axis; negative when they overlap.
double gap_m(const calib::Box& a, const calib::Box& b) {
  return (a.min_m - b.max_m).cwiseMax(b.min_m - a.max_m).maxCoeff();
}

/// What stands under a lifted block that has come from there.
std::optional<calib::Box> stand_under(const Cell& cell, const Eigen::Isometry3d& before_from_block) {
  const Eigen::Isometry3d block_from_before = before_from_block.inverse();
  const Eigen::Vector3d up = up_in_block(cell);
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  const double lift_m = -block_from_before.translation()[axis] * std::copysign(1.0, up[axis]);
  const calib::Box* solid = first_solid(cell.block);
  if (lift_m < kLiftMinMetres || !solid) return std::nullopt;
  calib::Box under = *solid;
  under.name = "stand";
  under.min_m.array() -= kStandOverhangMetres;
  under.max_m.array() += kStandOverhangMetres;
  if (up[axis] > 0.0) {
    under.max_m[axis] = solid->min_m[axis];
    under.min_m[axis] = under.max_m[axis] - lift_m;
  } else {
    under.min_m[axis] = solid->max_m[axis];
    under.max_m[axis] = under.min_m[axis] + lift_m;
  }
  return under;
}

/// The block at the places before, in R_-1 of this one: a person's word that it was brought may be a mistake,
/// and then the searches end without contact, but nothing drives into it. Where it will stand later is room
/// that the touches here may need.
std::vector<calib::Box> forgotten_blocks(const Block& block, const Recipe& recipe, int place) {
  const calib::Box* solid = first_solid(block);
  if (!solid) return {};
  const auto places = artefact_places(block, recipe, place);
  std::vector<calib::Box> forgotten;
  for (int before = 0; before < place; ++before) {
    const calib::ArtefactPlace& there = places[static_cast<std::size_t>(before)];
    for (calib::Box& box : boxes_after_move({*solid}, there.pose.inverse())) {
      box.name += " at " + there.name;
      if (gap_m(box, *solid) >= kRoomBetweenMetres) forgotten.push_back(std::move(box));
    }
  }
  return forgotten;
}

/// What of the block's solids stays where it is.
std::vector<calib::Box> take_standing_solids(Block& block) {
  const std::vector<bool> moves = solids_that_move(block);
  std::vector<calib::Box> standing, moving;
  for (std::size_t i = 0; i < moves.size(); ++i) (moves[i] ? moving : standing).push_back(block.solids[i]);
  block.solids = std::move(moving);
  return standing;
}

}  // namespace

std::vector<bool> solids_that_move(const Block& block) {
  const calib::Box* first = first_solid(block);
  std::vector<bool> moves;
  for (const calib::Box& solid : block.solids) {
    const bool is_on_first = first && solid.round_m > 0.0 && gap_m(solid, *first) < solid.round_m;
    moves.push_back(!first || &solid == first || is_on_first);
  }
  return moves;
}

Cell cell_at_place(const Cell& cell, const Recipe& recipe, int place) {
  if (place == 0) return cell;
  const Eigen::Isometry3d first_from_place =
      artefact_places(cell.block, recipe)[static_cast<std::size_t>(place)].pose;
  Cell there = with_block_moved(cell, first_from_place);
  const std::vector<calib::Box> standing =
      boxes_after_move(take_standing_solids(there.block), first_from_place);
  there.keep_out_boxes.insert(there.keep_out_boxes.end(), standing.begin(), standing.end());
  const std::vector<calib::Box> forgotten = forgotten_blocks(cell.block, recipe, place);
  there.keep_out_boxes.insert(there.keep_out_boxes.end(), forgotten.begin(), forgotten.end());
  return with_stand_under(there, first_from_place);
}

Cell with_stand_under(const Cell& cell, const Eigen::Isometry3d& before_from_block) {
  Cell there = cell;
  if (auto stand = stand_under(cell, before_from_block)) there.keep_out_boxes.push_back(std::move(*stand));
  return there;
}

}  // namespace cell
