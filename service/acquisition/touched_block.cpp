#include "service/acquisition/touched_block.hpp"

#include <utility>

#include "service/acquisition/block_pass.hpp"

namespace cell {
namespace {

FoundBlock found_by(const calib::BlockRegistration& fit, const Locating& locating, const Cell& configured,
                    const std::optional<BlockPose>& before) {
  BlockPose place{.cell_from_block = fit.old_from_new,
                  .covariance = fit.covariance,
                  .std_block_pose = fit.std_block_pose,
                  .touches = locating.touches()};
  if (before) place.cell_from_block = before->cell_from_block * fit.old_from_new;
  Cell there = cell_with_block_pose(configured, place);
  auto pass = pass_postures(there, locating.touches());
  return {std::move(place), std::move(there), std::move(pass)};
}

}  // namespace

void TouchedBlock::take(const HandTouch& touch, const Cell& configured,
                        const std::optional<BlockPose>& before) {
  locating.take(touch);
  found.reset();
  if (const auto& fit = locating.fit()) found = found_by(*fit, locating, configured, before);
}

void TouchedBlock::undo() {
  locating.undo();
  found.reset();
}

}  // namespace cell
