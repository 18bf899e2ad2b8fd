#include "service/run.hpp"

#include <utility>

#include "config/identification_problem.hpp"
#include "service/acquisition/touch_command.hpp"

namespace cell {

calib::Touch to_touch(const StoredTouch& stored) {
  return {.face = stored.plane - 1, .joints = from_wire(stored.joints), .role = stored.role};
}

Run::Run(std::int64_t id, const TipRegions& regions, Recipe recipe, std::string started_at)
    : id_(id),
      regions_(regions),
      recipe_(std::move(recipe)),
      started_at_(std::move(started_at)),
      problem_(identification_problem(regions.cell(), recipe_)) {}

const calib::PlannedTouch* Run::next() const {
  return touches_done() < touches_total() ? &plan_.touches[touches_.size()] : nullptr;
}

const calib::PlannedTouch* Run::after_next() const {
  return touches_done() + 1 < touches_total() ? &plan_.touches[touches_.size() + 1] : nullptr;
}

void Run::add(TouchStore& store, const StoredTouch& touch) {
  store.append_touch(id_, touch);
  touches_.push_back(touch);
  problem_.touches.push_back(to_touch(touch));
}

bool Run::identify() {
  if (identified_count_ == touches_.size()) return false;
  identified_count_ = touches_.size();
  latest_ = calib::identify(problem_, recipe_.identification);
  predicted_tip_rms_m_.reset();
  if (latest_.certainty) {
    predicted_tip_rms_m_ = predicted_rms_m(regions_.tip().workspace_box, *latest_.certainty);
  }
  return true;
}

}  // namespace cell
