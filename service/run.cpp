#include "service/run.hpp"

#include <utility>

#include "service/acquisition/touch_command.hpp"

namespace cell {

std::vector<calib::Plane> contact_planes(const Cell& cell) {
  std::vector<calib::Plane> planes;
  for (const calib::Face& face : cell.block.faces)
    planes.push_back(calib::contact_plane(face, cell.probe.stylus));
  return planes;
}

calib::Touch to_touch(const StoredTouch& stored) {
  return {.face = stored.plane - 1, .joints = from_wire(stored.joints), .role = stored.role};
}

Run::Run(std::int64_t id, const Cell& cell, Recipe recipe, std::string started_at)
    : id_(id),
      recipe_(std::move(recipe)),
      started_at_(std::move(started_at)),
      problem_{cell.arm.model, contact_planes(cell), {}} {}

const calib::PlannedTouch* Run::next() const {
  return touches_done() < touches_total() ? &plan_.touches[touches_.size()] : nullptr;
}

void Run::add(TouchStore& store, const StoredTouch& touch) {
  store.append_touch(id_, touch);
  touches_.push_back(touch);
  problem_.touches.push_back(to_touch(touch));
  latest_ = calib::identify(problem_, recipe_.identification);
}

}  // namespace cell
