// What an Operation touches beside its plan: the reference place, and a touch that does not fit the others.
// Each co_await stands alone in its statement, see drive.cpp.
#include "service/acquisition/touched_again.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "service/acquisition/operation.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// So many false triggers in a run are no chance.
constexpr int kFalseTriggersMany = 3;

}  // namespace

/// Told and kept while the run goes on.
void Operation::warn(Fault fault) {
  spdlog::warn("warning {}: {}", describe(fault.code).name, fault.message());
  status_.warning = std::move(fault);
  publish();
}

void Operation::begin_checks() {
  held_by_ = HeldBy::kNothing;
  history_ = {};
  misfit_.reset();
  reference_.reset();
  false_trigger_count_ = 0;
  status_.warning.reset();
  status_.reference_drift_m.reset();
}

/// True when the answer is a measurement, which the caller keeps and acknowledges; else the answer is dealt
/// with.
bool Operation::accept(const calib::PlannedTouch& touch, std::uint32_t sequence,
                       const cs8::TouchResult& result, HeldBy held_by) {
  using Next = TouchJudgement::Next;
  const TouchJudgement judged = judge_touch(cell_, touch, result, history_);
  for (const Fault& warning : judged.warnings) warn(warning);
  if (judged.next == Next::kKeep) {
    history_ = {.attempts = 0, .spread_m = {}, .last_contact = result.contact};
    return true;
  }
  acknowledge(sequence);
  ahead_.reset();
  if (judged.next == Next::kStopped) {
    if (result.phase == cs8::Phase::kSearch) warn({FaultCode::kStoppedInSearch, {}});
    expect_stop(result.outcome);
    return false;
  }
  const FaultCode code = judged.fault.code;
  if (code == FaultCode::kFalseTrigger && ++false_trigger_count_ == kFalseTriggersMany)
    warn({FaultCode::kFalseTriggersMany, fmt::format("{} in this run", false_trigger_count_)});
  if (judged.next == Next::kAgain) {
    ++history_.attempts;
    history_.spread_m = contact_spread_m(cell_, result);
    warn(judged.fault);
    return false;
  }
  history_.attempts = 0;  // a person's word begins anew
  history_.spread_m.reset();
  missed_ = code == FaultCode::kNoContact || code == FaultCode::kEarlyContact;
  if (code == FaultCode::kCollision) forget_made();  // what was known of the arm may be wrong
  held_by_ = held_by;
  raise(held_by == HeldBy::kTouch ? placed_fault(judged.fault, touch.face) : judged.fault, judged.event);
  return false;
}

/// Where a touch of this face has the ball, along the outward normal, as the arm is known now.
double Operation::height_m(int face, const calib::JointVector& joints) const {
  const calib::Face& touched = planning_.faces[static_cast<std::size_t>(face)];
  const Eigen::Vector3d tip_m = calib::forward_kinematics(aim_->model(), joints).translation();
  return signed_distance_m(contact_plane(touched, planning_.stylus), tip_m);
}

/// A touch that is not one of the plan, as it is given; nothing when there is no measurement.
asio::awaitable<std::optional<cs8::TouchResult>> Operation::touch_apart(calib::AimedTouch aimed,
                                                                        HeldBy held_by) {
  const auto from = co_await standing_joints();
  if (status_.state != State::kExecute) co_return std::nullopt;
  if (!from) {
    co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    co_return std::nullopt;
  }
  const auto ready = with_way(std::move(aimed), leaving(*from));
  if (!ready) {
    raise({FaultCode::kNoSafeWay, "to a place that was touched before"}, Event::kAbortFault);
    co_return std::nullopt;
  }
  before_ = std::move(made_);
  made_ = ready->aimed;
  const calib::PlannedTouch touch = made_->touch;
  made_way_ = calib::whole_path(*from, ready->via, touch.clear_joints);
  made_way_.insert(made_way_.end(), {touch.approach_joints, touch.search_end_joints});
  standing_.reset();
  history_.last_contact.reset();  // this is made to be where another was
  auto answer = client_.touch(touch_command(cell_, touch, ready->via));
  identify();
  const cs8::TouchReply reply = co_await std::move(answer);
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    const OutcomeFault refused = fault_of(*rejected);
    held_by_ = held_by;
    raise(refused.fault, refused.event());
  } else if (const auto* result = std::get_if<cs8::TouchResult>(&reply.answer)) {
    if (!accept(touch, reply.sequence, *result, held_by)) co_return std::nullopt;
    acknowledge(reply.sequence);
    missed_ = false;
    standing_ = touch.clear_joints;
    co_return *result;
  }  // a lost link has been told by lose()
  co_return std::nullopt;
}

/// The first touch that is fitted says where the reference is.
void Operation::note_reference_place(const calib::PlannedTouch& planned, const cs8::TouchResult& result) {
  if (reference_ || run_->recipe().reference_every == 0 || planned.role != calib::TouchRole::kFit) return;
  reference_ = ReferencePlace{
      .planned = planned, .first_joints = from_wire(result.contact), .aimed = {}, .reference = {}};
}

/// Where the reference was for the daemon before this one; it is touched before anything else.
void Operation::restore_reference() {
  const std::vector<StoredTouch>& made = run_->touches();
  const auto first = std::ranges::find(made, calib::TouchRole::kFit, &StoredTouch::role);
  if (first == made.end() || run_->recipe().reference_every == 0) return;
  const calib::PlannedTouch* planned = run_->planned(static_cast<std::size_t>(first->number - 1));
  if (!planned) return;
  reference_ = ReferencePlace{.planned = *planned,
                              .first_joints = from_wire(first->joints),
                              .aimed = {},
                              .reference = {},
                              .due = true};
  const std::vector<ReferenceTouch> references = store_.references(run_->id());
  if (references.empty()) return;
  reference_->reference = from_wire(references.front().joints);
  reference_->count = references.back().number;
}

/// At the start, behind every so many touches, and at the end.
bool Operation::reference_due() const {
  if (!reference_) return false;
  const int done = run_->touches_done();
  if (reference_->count == 0 || reference_->due) return true;
  return done != reference_->made_at && (done % run_->recipe().reference_every == 0 || !run_->next());
}

asio::awaitable<void> Operation::touch_reference() {
  if (!reference_->aimed) {
    auto made = calib::aim_touch(planning_, *aim_, reference_->planned);
    if (std::holds_alternative<std::string>(made))
      made = calib::nominal_touch(planning_, reference_->planned);
    if (const auto* why = std::get_if<std::string>(&made)) {
      raise({FaultCode::kNoSafeWay, "to the reference place: " + *why}, Event::kAbortFault);
      co_return;
    }
    reference_->aimed = std::get<calib::AimedTouch>(std::move(made));
  }
  const auto result = co_await touch_apart(*reference_->aimed, HeldBy::kReference);
  if (!result) co_return;
  const calib::JointVector joints = from_wire(result->contact);
  const int face = reference_->planned.face;
  ++reference_->count;
  reference_->made_at = run_->touches_done();
  reference_->due = false;
  const bool is_first = !reference_->reference;
  if (is_first) reference_->reference = joints;
  reference_->drift_m = height_m(face, joints) - height_m(face, *reference_->reference);
  if (!is_first) status_.reference_drift_m = reference_->drift_m;
  const double drift_mm = calib::mm_from_metres(reference_->drift_m);
  try {
    store_.append_reference(run_->id(), {.number = reference_->count,
                                         .touches_done = run_->touches_done(),
                                         .joints = result->contact,
                                         .drift_mm = is_first ? std::nullopt : std::optional(drift_mm),
                                         .captured_at = now_text()});
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    co_return;
  }
  spdlog::info("run {} reference touch {}: drift {:.3f} mm", run_->id(), reference_->count, drift_mm);
  publish();
  judge_reference(joints);
}

void Operation::judge_reference(const calib::JointVector& joints) {
  const double limit_m = reference_drift_max_m(cell_);
  const double limit_mm = calib::mm_from_metres(limit_m);
  if (reference_->count == 1) {
    const int face = reference_->planned.face;
    const double bias_m = height_m(face, reference_->first_joints) - height_m(face, joints);
    if (std::abs(bias_m) > limit_m) {
      warn({FaultCode::kFirstTouchBiased, fmt::format("by {:.3f} mm", calib::mm_from_metres(bias_m))});
    }
  } else if (std::abs(reference_->drift_m - reference_->allowed_drift_m) > limit_m) {
    held_by_ = HeldBy::kDrift;
    raise({FaultCode::kReferenceDrift,
           fmt::format("by {:.3f} mm, over {:.3f} mm", calib::mm_from_metres(reference_->drift_m), limit_mm)},
          Event::kHoldFault);
    return;
  }
  if (const auto other = stylus_fault(run_->problem(), run_->latest()); other && !stylus_allowed_) {
    held_by_ = HeldBy::kStylus;
    raise(*other, Event::kHoldFault);
  }
}

/// The newest touch is known to the aim at once; one that the others contradict is made again while the arm
/// is there.
void Operation::watch_fit() {
  calib::OnlineArmEstimate before = *aim_;
  if (learn()) misfit_ = Misfit{.aimed = *made_, .before = std::move(before)};
}

asio::awaitable<void> Operation::touch_misfit_again() {
  const auto result = co_await touch_apart(misfit_->aimed, HeldBy::kMisfit);
  if (!result) co_return;
  const int face = misfit_->aimed.touch.face;
  const StoredTouch& first = run_->touches().back();
  const double apart_m =
      std::abs(height_m(face, from_wire(result->contact)) - height_m(face, from_wire(first.joints)));
  const std::string detail = fmt::format("touch {}, {:.3f} mm apart from its repetition", first.number,
                                         calib::mm_from_metres(apart_m));
  if (apart_m <= agreement_max_m(cell_)) {
    warn({FaultCode::kTouchOutlier, detail});
    misfit_.reset();
    co_return;
  }
  calib::OnlineArmEstimate without = misfit_->before;
  StoredTouch again = first;
  again.joints = result->contact;
  again.source = result->source;
  again.overtravel_dmm = result->overtravel_dmm;
  again.captured_at = now_text();
  again.sequence = 0;  // no command of the plan
  if (without.add(to_touch(again)).contradicts) {
    held_by_ = HeldBy::kMisfit;
    raise({FaultCode::kTouchDoesNotFit, detail}, Event::kHoldFault);
    co_return;
  }
  try {
    run_->replace_last(store_, again, "it did not fit the others, its repetition does");
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    co_return;
  }
  spdlog::warn("run {} touch {} is replaced by its repetition, which fits the others", run_->id(),
               again.number);
  aim_ = std::move(without);
  misfit_.reset();
  publish();
}

/// A person's word on what held the run, beside going on.
void Operation::settle_hold(Command command) {
  const HeldBy held_by = std::exchange(held_by_, command == Command::kRetry ? held_by_ : HeldBy::kNothing);
  if (held_by == HeldBy::kDrift && command == Command::kRetry) reference_->made_at = -1;
  if (held_by == HeldBy::kDrift && command != Command::kRetry) {
    reference_->allowed_drift_m = reference_->drift_m;
    warn({FaultCode::kReferenceDrift, "a person lets the run go on"});
  }
  if (held_by == HeldBy::kReference && command == Command::kSkip) {
    reference_->made_at = run_->touches_done();
    reference_->count = std::max(reference_->count, 1);
    reference_->due = false;
  }
  if (held_by == HeldBy::kStylus) stylus_allowed_ = command != Command::kRetry;
  if (held_by == HeldBy::kMisfit && command == Command::kResume) {
    warn({FaultCode::kTouchOutlier, fmt::format("touch {}", run_->touches_done())});
    misfit_.reset();
  }
  if (command != Command::kSkip || (held_by != HeldBy::kTouch && held_by != HeldBy::kMisfit)) return;
  if (held_by == HeldBy::kMisfit) {
    try {
      run_->withdraw_last(store_, "it did not fit the others, and a person left it out");
    } catch (const std::exception& error) {
      raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
      return;
    }
    aim_ = misfit_->before;
    misfit_.reset();
  }
  spdlog::warn("run {}: touch {} of the plan is left out, the run stays incomplete", run_->id(),
               run_->touches_made() + 1);
  run_->skip_next();
}

}  // namespace cell
