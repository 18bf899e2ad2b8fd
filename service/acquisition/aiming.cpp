// Which touch an Operation makes next, aimed with what the touches before it told, and the way there.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "service/acquisition/operation.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Touches that are put off in a row before there is said to be no way.
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

}  // namespace

void Operation::begin_aim() {
  aim_.emplace(planning_);
  begin_place_check();
  ahead_.reset();
  missed_ = false;
}

/// The touches that the aim does not know yet; true when the others contradict the last of them.
bool Operation::learn() {
  const std::vector<calib::Touch>& touches = run_->problem().touches;
  bool contradicted = false;
  while (aim_ && aim_->touch_count() < touches.size()) {
    const calib::PredictedContact contact = aim_->add(touches[aim_->touch_count()]);
    spdlog::log(contact.contradicts ? spdlog::level::warn : spdlog::level::info,
                "run {} touch {} was {:.2f} mm from where it was expected, {:.2f} mm predicted{}", run_->id(),
                aim_->touch_count(), calib::mm_from_metres(contact.position_error_m),
                calib::mm_from_metres(contact.predicted_position_error_m),
                contact.contradicts ? ": the other touches contradict it, it does not aim" : "");
    contradicted = contact.contradicts;
  }
  return contradicted;
}

void Operation::forget_made() {
  made_.reset();
  before_.reset();
}

/// Whether a contact was farther off than its search was made for: what is known of the arm is wrong there.
bool Operation::is_surprise(const calib::JointVector& contact) const {
  const calib::PlannedTouch& touch = made_->touch;
  const calib::Face& face = planning_.faces[static_cast<std::size_t>(touch.face)];
  const Eigen::Vector3d tip_m = calib::forward_kinematics(made_->problem.nominal, contact).translation();
  return std::abs(signed_distance_m(contact_plane(face, planning_.stylus), tip_m)) >
         touch.predicted_position_error_m;
}

/// Where the arm leaves from. At the clear posture of one of the last two touches, also of the run before, it
/// leaves as that touch was made; broken off on the way between them, as the one that was known better, for
/// which the way was clear. Anywhere else nothing is known.
calib::TransferEnd Operation::leaving(const calib::JointVector& joints) const {
  constexpr double kSamePostureRad = 1e-4;
  const calib::PlanningProblem* known = nullptr;
  for (const auto* touch : {&made_, &before_}) {
    if (!*touch) continue;
    if (((*touch)->touch.clear_joints - joints).cwiseAbs().maxCoeff() <= kSamePostureRad)
      return calib::transfer_end_of(**touch);
    if (!known || (*touch)->problem.nominal_position_error_m < known->nominal_position_error_m)
      known = &(*touch)->problem;
  }
  return {joints, std::nullopt, is_on(made_way_, joints) ? known : nullptr};
}

std::optional<Operation::PreparedTouch> Operation::with_way(std::variant<calib::AimedTouch, std::string> made,
                                                            const calib::TransferEnd& from) const {
  auto* aimed = std::get_if<calib::AimedTouch>(&made);
  if (!aimed) {
    spdlog::info("a touch cannot be made as it is aimed now: {}", std::get<std::string>(made));
    return std::nullopt;
  }
  auto via = calib::find_aimed_transfer(planning_, *aim_, from, calib::transfer_end_of(*aimed));
  if (!via) {
    spdlog::info("no way to a touch on plane {} as it is aimed now", aimed->touch.face + 1);
    return std::nullopt;
  }
  return PreparedTouch{.aimed = std::move(*aimed), .from = from.joints, .via = std::move(*via)};
}

/// The touch at this place of the plan. One that cannot be made as it is aimed is made with the nominal miss,
/// so that the plan's order stays; when there is no way to that either, it comes behind the others, once.
/// Nothing when it cannot be made then.
std::optional<Operation::PreparedTouch> Operation::prepared(std::size_t index,
                                                            const calib::TransferEnd& from) {
  for (int put_off = 0; put_off < kPutOffMax; ++put_off) {
    const calib::PlannedTouch* planned = run_->planned(index);
    if (!planned) break;
    auto touch = missed_ ? std::nullopt : with_way(calib::aim_touch(planning_, *aim_, *planned), from);
    const int aimed_with = touch ? static_cast<int>(aim_->touch_count()) : kNominalMiss;
    if (!touch) touch = with_way(calib::nominal_touch(planning_, *planned), from);
    if (touch) {
      touch->aimed_with = aimed_with;
      touch->planned = planned->joints;
      return touch;
    }
    if (!run_->defer(index)) break;
  }
  return std::nullopt;
}

/// True when the next touch is ready to be commanded; false when there is none or another state was entered.
asio::awaitable<bool> Operation::prepare_touch() {
  if (standing_ && ahead_ && ahead_->from == *standing_) co_return true;
  const auto from = co_await standing_joints();
  if (status_.state != State::kExecute) co_return false;
  if (!from) {
    co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    co_return false;
  }
  // One that is aimed stays so, also behind a hold or a restart: only the way to it is another.
  const bool is_next = ahead_ && ahead_->planned == run_->next()->joints;
  if (is_next) {
    PreparedTouch before = std::move(*ahead_);
    ahead_ = with_way(std::move(before.aimed), leaving(*from));
    if (ahead_) {
      ahead_->aimed_with = before.aimed_with;
      ahead_->planned = before.planned;
      co_return true;
    }
  }
  identify();
  learn();
  ahead_ = prepared(run_->touches_made(), leaving(*from));
  if (!ahead_) {
    const int plane = run_->next()->face + 1;
    raise({FaultCode::kNoSafeWay, fmt::format("to touch {} on plane {}", run_->touches_done() + 1, plane)},
          Event::kAbortFault);
  }
  co_return ahead_.has_value();
}

/// While the arm makes made_: the touch behind it.
void Operation::look_ahead() {
  const std::size_t behind = run_->touches_made() + 1;
  stop_when_good_enough(behind);
  ahead_ = prepared(behind, calib::transfer_end_of(*made_));
}

/// A run that reached the accuracy it was asked for leaves out the touches that it would still fit.
void Operation::stop_when_good_enough(std::size_t first) {
  if (!run_->meets_accuracy_goal()) return;
  const int dropped = run_->drop_fit_touches(first);
  if (dropped == 0) return;
  spdlog::info("run {} is accurate enough: {} touches are left out", run_->id(), dropped);
  try {
    store_.set_touches_total(run_->id(), run_->touches_total());
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
  }
  publish();
}

}  // namespace cell
