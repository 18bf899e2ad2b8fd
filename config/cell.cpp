#include "config/cell.hpp"

namespace cell {

calib::CollisionScene Cell::collision_scene() const {
  calib::CollisionScene scene{arm.bodies, block.solids};
  scene.bodies.insert(scene.bodies.end(), probe.bodies.begin(), probe.bodies.end());
  scene.obstacles.insert(scene.obstacles.end(), keep_out_boxes.begin(), keep_out_boxes.end());
  return scene;
}

}  // namespace cell
