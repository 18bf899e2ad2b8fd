#include "service/acquisition/touch_preparation.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"

namespace cell {

namespace {

/// Touches put off in a row before the run is held for want of a path.
constexpr int kPutOffMax = 8;

/// Whether a posture lies on straight joint moves through these; straight lines of the tip leave them a
/// little.
bool is_on(const std::vector<calib::JointVector>& way, const calib::JointVector& joints) {
  constexpr double kOffMaxRad = 5e-3;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const calib::JointVector nearest = calib::nearest_on_move(way[i - 1], way[i], joints);
    if ((joints - nearest).cwiseAbs().maxCoeff() <= kOffMaxRad) return true;
  }
  return false;
}

double off_m(const calib::PlanningProblem& planning, int face, const Eigen::Isometry3d& block_from_tip) {
  return signed_distance_m(touched_surface(planning, face), block_from_tip);
}

}  // namespace

std::vector<calib::JointVector> path_of(const PreparedTouch& prepared) {
  const calib::PlannedTouch& touch = prepared.aimed.touch;
  std::vector<calib::JointVector> path = calib::whole_path(prepared.from, prepared.via, touch.clear_joints);
  path.insert(path.end(), {touch.approach_joints, touch.search_end_joints});
  return path;
}

void TouchPreparation::begin(calib::PlanningProblem problem) {
  planning_ = std::move(problem);
  aim_.emplace(planning_);
  next_.reset();
  missed_ = false;
}

void TouchPreparation::forget_all() {
  aim_.reset();
  next_.reset();
  forget_made();
  made_path_.clear();
}

bool TouchPreparation::add_contacts(const Run& run) {
  const std::vector<calib::Touch>& touches = run.problem().touches;
  bool contradicted = false;
  // After a change of place all of them are added anew: only the last one is news.
  while (aim_ && aim_->touch_count() + 1 < touches.size()) aim_->add(touches[aim_->touch_count()]);
  if (aim_ && aim_->touch_count() < touches.size()) contradicted = add_ahead(run, touches.back());
  return contradicted;
}

bool TouchPreparation::add_ahead(const Run& run, const calib::Touch& touch) {
  const calib::PredictedContact contact = aim_->add(touch);
  spdlog::log(contact.contradicts ? spdlog::level::warn : spdlog::level::info,
              "run {} touch {} was {:.2f} mm from where it was expected, {:.2f} mm predicted{}", run.id(),
              aim_->touch_count(), calib::mm_from_metres(contact.position_error_m),
              calib::mm_from_metres(contact.predicted_position_error_m),
              contact.contradicts ? ": the other touches contradict it, it is not used for aiming" : "");
  return contact.contradicts;
}

double TouchPreparation::height_m(int face, const calib::JointVector& joints) const {
  return off_m(planning_, face, calib::forward_kinematics(aim_->model(), joints));
}

bool TouchPreparation::is_surprise(const calib::JointVector& contact) const {
  const calib::PlannedTouch& touch = made_->touch;
  const Eigen::Isometry3d tip = calib::forward_kinematics(made_->problem.nominal, contact);
  return std::abs(off_m(made_->problem, touch.face, tip)) > touch.predicted_position_error_m;
}

bool TouchPreparation::is_ready_from(const calib::JointVector& joints) const {
  return next_ && next_->from == joints;
}

bool TouchPreparation::reroute_from(const calib::JointVector& joints, const calib::PlannedTouch& next) {
  if (!next_ || next_->planned != next.joints) return false;
  PreparedTouch before = std::move(*next_);
  next_ = with_path(std::move(before.aimed), leaving(joints));
  if (!next_) return false;
  next_->aimed_with = before.aimed_with;
  next_->planned = before.planned;
  return true;
}

bool TouchPreparation::prepare_next(Run& run, const calib::JointVector& joints) {
  next_ = prepared(run, run.touches_made(), leaving(joints));
  return next_.has_value();
}

bool TouchPreparation::can_leave(const calib::JointVector& joints) const {
  return calib::find_aimed_transfer(planning_, *aim_, leaving(joints),
                                    {planning_.park_joints, std::nullopt, nullptr})
      .has_value();
}

void TouchPreparation::look_ahead(Run& run, std::size_t place) {
  next_ = prepared(run, place, calib::transfer_end_of(*made_));
}

std::optional<PreparedTouch> TouchPreparation::prepare(calib::AimedTouch aimed,
                                                       const calib::JointVector& joints) const {
  return with_path(std::move(aimed), leaving(joints));
}

std::variant<calib::AimedTouch, std::string> TouchPreparation::aim_or_nominal(
    const calib::PlannedTouch& planned) const {
  auto made = calib::aim_touch(planning_, *aim_, planned);
  if (std::holds_alternative<std::string>(made)) made = calib::nominal_touch(planning_, planned);
  return made;
}

OutgoingTouch TouchPreparation::send_next() {
  OutgoingTouch outgoing = send(*std::move(next_));
  next_.reset();
  return outgoing;
}

OutgoingTouch TouchPreparation::send(PreparedTouch prepared) {
  made_path_ = path_of(prepared);
  before_ = std::move(made_);
  made_ = std::move(prepared.aimed);
  return {.touch = made_->touch, .via = std::move(prepared.via), .aimed_with = prepared.aimed_with};
}

void TouchPreparation::forget_made() {
  made_.reset();
  before_.reset();
}

calib::TransferEnd TouchPreparation::leaving(const calib::JointVector& joints) const {
  constexpr double kSamePostureRad = 1e-4;
  const calib::PlanningProblem* known = nullptr;
  for (const auto* touch : {&made_, &before_}) {
    if (!*touch) continue;
    if (((*touch)->touch.clear_joints - joints).cwiseAbs().maxCoeff() <= kSamePostureRad)
      return calib::transfer_end_of(**touch);
    if (!known || (*touch)->problem.nominal_position_error_m < known->nominal_position_error_m)
      known = &(*touch)->problem;
  }
  return {joints, std::nullopt, is_on(made_path_, joints) ? known : nullptr};
}

void TouchPreparation::recall(Run& run) {
  const std::vector<StoredTouch>& stored = run.touches();
  const std::vector<calib::Touch>& touches = run.problem().touches;
  if (stored.empty() || !run.planned(stored.size() - 1)) return;
  const calib::PlannedTouch& last = *run.planned(stored.size() - 1);
  if (run.moving_to() || run.place_of(last.face) != run.place()) return;  // all of it is of another place
  const int aimed_with = stored.back().aimed_with;
  const auto add_up_to = [&](std::size_t count) {
    while (aim_->touch_count() < std::min(count, touches.size())) aim_->add(touches[aim_->touch_count()]);
  };
  add_up_to(static_cast<std::size_t>(std::max(aimed_with, 0)));
  auto made = aimed_with == kNominalMiss ? calib::nominal_touch(planning_, last)
                                         : calib::aim_touch(planning_, *aim_, last);
  add_up_to(touches.size() - 1);
  auto* aimed = std::get_if<calib::AimedTouch>(&made);
  if (!aimed) return;
  made_ = std::move(*aimed);
  if (is_surprise(touches.back().joints)) return;
  look_ahead(run, stored.size());
  if (!next_) return;
  before_ = std::move(made_);  // the arm may stand on the way between both
  made_ = next_->aimed;
}

std::optional<PreparedTouch> TouchPreparation::prepared(Run& run, std::size_t place,
                                                        const calib::TransferEnd& from) {
  for (int put_off = 0; put_off < kPutOffMax; ++put_off) {
    const calib::PlannedTouch* planned = run.planned_here(place);
    if (!planned) break;
    auto touch = missed_ ? std::nullopt : with_path(calib::aim_touch(planning_, *aim_, *planned), from);
    const int aimed_with = touch ? static_cast<int>(aim_->touch_count()) : kNominalMiss;
    if (!touch) touch = with_path(calib::nominal_touch(planning_, *planned), from);
    if (touch) {
      touch->aimed_with = aimed_with;
      touch->planned = planned->joints;
      return touch;
    }
    if (!can_leave(from.joints) || !run.defer(place)) break;
  }
  return std::nullopt;
}

std::optional<PreparedTouch> TouchPreparation::with_path(std::variant<calib::AimedTouch, std::string> made,
                                                         const calib::TransferEnd& from) const {
  auto* aimed = std::get_if<calib::AimedTouch>(&made);
  if (!aimed) {
    spdlog::info("a touch cannot be made with the present estimate: {}", std::get<std::string>(made));
    return std::nullopt;
  }
  auto via = calib::find_aimed_transfer(planning_, *aim_, from, calib::transfer_end_of(*aimed));
  if (!via) {
    spdlog::info("no clear path to a touch on plane {} with the present estimate", aimed->touch.face + 1);
    return std::nullopt;
  }
  return PreparedTouch{.aimed = std::move(*aimed), .from = from.joints, .via = std::move(*via)};
}

}  // namespace cell
