#include "service/run/run.hpp"

#include <algorithm>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "config/identification_problem.hpp"
#include "config/touched_places.hpp"
#include "service/run/internal/touch_benefit.hpp"
#include "service/run/run_repeats.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

calib::Touch to_touch(const StoredTouch& stored) {
  return {.face = stored.plane - 1,
          .joints = from_wire(stored.joints),
          .role = stored.role,
          .deviation_m = calib::metres_from_um(stored.noise_um.value_or(0.0))};
}

std::vector<calib::Touch> to_touches(const std::vector<ReferenceTouch>& references,
                                     const std::vector<StoredTouch>& touches, int faces_per_place) {
  const auto place_of = [&](const StoredTouch& touch) {
    return faces_per_place == 0 ? 0 : (touch.plane - 1) / faces_per_place;
  };
  std::vector<calib::Touch> made;
  for (const ReferenceTouch& reference : references) {
    if (touches.empty()) break;
    const auto before =
        std::min(static_cast<std::size_t>(std::max(reference.touches_done, 1)), touches.size());
    const auto first = std::ranges::find_if(touches, [&](const StoredTouch& touch) {
      return touch.role == calib::TouchRole::kFit && place_of(touch) == place_of(touches[before - 1]);
    });
    if (first == touches.end()) continue;
    made.push_back({.face = first->plane - 1, .joints = from_wire(reference.joints), .role = first->role});
  }
  return made;
}

Run::Run(std::int64_t id, const TipRegions& regions, Recipe recipe, std::string started_at,
         std::optional<BlockTemperature> block_temperature, std::shared_ptr<const Verification> verification,
         std::optional<calib::TouchNoise> qualified)
    : id_(id),
      regions_(regions),
      recipe_(std::move(recipe)),
      started_at_(std::move(started_at)),
      block_temperature_(block_temperature),
      verification_(std::move(verification)),
      qualified_(qualified),
      problem_(identification_problem(with_block_temperature(regions.cell(), block_temperature_), recipe_)) {}

void Run::restore(const std::vector<StoredTouch>& touches, int touches_total) {
  touches_ = touches;
  for (const StoredTouch& touch : touches_) problem_.touches.push_back(to_touch(touch));
  restored_total_ = touches_total;
  revise();
}

void Run::change_plan(const PlanChange& change) {
  const auto place = static_cast<std::size_t>(change.place);
  switch (change.kind) {
    case PlanChange::Kind::kDefer:
      defer(place);
      break;
    case PlanChange::Kind::kDropFitTouches:
      drop_fit_touches(place);
      break;
    case PlanChange::Kind::kSkip:
      skip(place);
      break;
    case PlanChange::Kind::kBlockToMove:
      moving_to_ = change.place;
      plan_changes_.push_back(change);
      break;
    case PlanChange::Kind::kBlockMoved:
      place_ = change.place;
      moving_to_.reset();
      plan_changes_.push_back(change);
      break;
  }
}

void Run::set_plan(calib::TouchPlan plan) {
  plan_changes_.clear();
  place_ = 0;
  moving_to_.reset();
  plan_ = std::move(plan);
  deferred_.assign(plan_.touches.size(), false);
}

const calib::PlannedTouch* Run::next() const { return planned(touches_made()); }

const calib::PlannedTouch* Run::planned(std::size_t index) const {
  return index < plan_.touches.size() ? &plan_.touches[index] : nullptr;
}

const calib::PlannedTouch* Run::planned_here(std::size_t index) const {
  const calib::PlannedTouch* touch = planned(index);
  return touch && !moving_to_ && place_of(touch->face) == place_ ? touch : nullptr;
}

int Run::place_of(int face) const { return place_of_face(regions_.cell().block, recipe_, face); }

bool Run::defer(std::size_t index) {
  std::size_t last = index;
  for (std::size_t i = index; i < plan_.touches.size(); ++i) {
    const calib::PlannedTouch &other = plan_.touches[i], &touch = plan_.touches[index];
    if (other.role == touch.role && place_of(other.face) == place_of(touch.face)) last = i;
  }
  if (deferred_[index] || last == index) return false;
  plan_changes_.push_back({PlanChange::Kind::kDefer, static_cast<int>(index)});
  deferred_[index] = true;
  const auto rotate = [&](auto& values) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(index);
    std::rotate(from, from + 1, values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  };
  rotate(plan_.touches);
  rotate(deferred_);
  return true;
}

void Run::skip_next() { skip(touches_made()); }

void Run::skip(std::size_t index) {
  if (!planned(index)) return;
  plan_changes_.push_back({PlanChange::Kind::kSkip, static_cast<int>(index)});
  const auto place = static_cast<std::ptrdiff_t>(index);
  plan_.touches.erase(plan_.touches.begin() + place);
  deferred_.erase(deferred_.begin() + place);
  ++skipped_count_;
}

double Run::remaining_s(double elapsed_s) const {
  double made_s = 0.0;
  for (std::size_t i = 0; i < touches_made() && planned(i); ++i)
    made_s += planned(i)->travel_s + planned(i)->touch_s;
  const double remaining_s = plan_.duration_s() - made_s;
  return made_s > 0.0 ? remaining_s * elapsed_s / made_s : remaining_s;
}

int Run::drop_fit_touches(std::size_t first) {
  const std::size_t before = plan_.touches.size();
  if (first >= before) return 0;
  plan_changes_.push_back({PlanChange::Kind::kDropFitTouches, static_cast<int>(first)});
  const auto from = plan_.touches.begin() + static_cast<std::ptrdiff_t>(first);
  plan_.touches.erase(
      std::remove_if(from, plan_.touches.end(),
                     [](const calib::PlannedTouch& touch) { return touch.role == calib::TouchRole::kFit; }),
      plan_.touches.end());
  deferred_.assign(plan_.touches.size(), false);
  return static_cast<int>(before - plan_.touches.size());
}

void Run::add(const StoredTouch& touch) {
  touches_.push_back(touch);
  problem_.touches.push_back(to_touch(touch));
  revise();
}

void Run::replace(const StoredTouch& again) {
  const auto index = static_cast<std::size_t>(again.number - 1);
  touches_.at(index) = again;
  problem_.touches.at(index) = to_touch(again);
  revise();
}

void Run::confirm(int number, const cs8::JointsMicrodeg& again) {
  touches_.at(static_cast<std::size_t>(number - 1)).again = again;
  revise();
}

void Run::withdraw_last() {
  touches_.pop_back();
  problem_.touches.pop_back();
  revise();
  if (!touches_.empty()) return;
  latest_ = {};  // without a touch there is nothing to identify from
  predicted_tip_rms_m_.reset();
  touch_benefit_.reset();
}

void Run::note_references(std::vector<ReferenceTouch> references) {
  references_ = std::move(references);
  revise();
}

void Run::revise() {
  const int faces = faces_per_place(regions_.cell().block, recipe_);
  note_repeats(repeats_of(touches_, references_, qualified_, faces), problem_);
  ++revision_;
}

bool Run::identify() {
  if (!identification_is_due()) return false;
  identified_revision_ = revision_;
  latest_ = calib::identify(problem_, recipe_.identification);
  predicted_tip_rms_m_.reset();
  touch_benefit_.reset();
  if (latest_.uncertainty) {
    predicted_tip_rms_m_ = predicted_rms_m(regions_.tip().workspace_box, *latest_.uncertainty);
    touch_benefit_ = estimate_touch_benefit();
  }
  return true;
}

Run Run::copy_to_identify() {
  Run copy = *this;
  identified_revision_ = revision_;
  return copy;
}

bool Run::take_latest(const Run& identified) {
  if (identified.id_ != id_ || identified.identified_revision_ != revision_) return false;
  latest_ = identified.latest_;
  predicted_tip_rms_m_ = identified.predicted_tip_rms_m_;
  touch_benefit_ = identified.touch_benefit_;
  return true;
}

bool Run::sees_all_attainable() const {
  return latest_.status == calib::IdentificationStatus::kConverged &&
         static_cast<int>(latest_.identifiable.columns.size()) >= latest_.attainable.count;
}

bool Run::meets_accuracy_goal() const {
  if (!recipe_.goal.tip_rms_max_m || !latest_.uncertainty || !sees_all_attainable()) return false;
  if (latest_.lack_of_fit && !(latest_.lack_of_fit->p >= calib::kLackOfFitDoubtful)) return false;
  const bool over_ranges = recipe_.goal.criterion == calib::PlanCriterion::kTipInJointRanges;
  const auto rms_m =
      over_ranges ? predicted_rms_m(regions_.tip().joint_ranges, *latest_.uncertainty) : predicted_tip_rms_m_;
  return rms_m && *rms_m <= *recipe_.goal.tip_rms_max_m;
}

std::optional<std::string> Run::estimate_touch_benefit() const {
  if (!predicted_tip_rms_m_ || !sees_all_attainable()) return std::nullopt;
  std::vector<calib::Touch> candidates;
  const auto add_from = [&](std::size_t first) {
    for (std::size_t i = first; i < plan_.touches.size(); ++i) {
      const calib::PlannedTouch& touch = plan_.touches[i];
      if (touch.role == calib::TouchRole::kFit) candidates.push_back({touch.face, touch.joints});
    }
  };
  if (plan_.touches.empty()) return std::nullopt;  // restored, and not planned again yet
  add_from(touches_made());
  if (candidates.empty()) add_from(0);
  const auto further = most_beneficial_touches(problem_, recipe_.identification, latest_, candidates,
                                               regions_.tip().workspace_box, *predicted_tip_rms_m_);
  if (!further) return std::nullopt;
  return describe(*further, *predicted_tip_rms_m_);
}

}  // namespace cell
