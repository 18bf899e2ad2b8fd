#include "sim_controller/fault_plan.hpp"

namespace sim {

FaultPlan::FaultPlan(std::vector<PlannedFault> faults) {
  for (const PlannedFault& fault : faults) add(fault);
}

void FaultPlan::add(const PlannedFault& fault) {
  if (std::holds_alternative<AtOnce>(fault.on)) {
    waiting_.push_back({fault.what, fault.after_s});
  } else {
    faults_.push_back({fault});
  }
}

bool FaultPlan::comes(Counted& fault) { return ++fault.seen == fault.planned.nth || fault.planned.every; }

template <class IsMet>
std::vector<LinkFault> FaultPlan::meet_those(IsMet is_met) {
  std::vector<LinkFault> met;
  for (Counted& fault : faults_) {
    if (!is_met(fault.planned.on) || !comes(fault)) continue;
    const auto* link_fault = std::get_if<LinkFault>(&fault.planned.what);
    if (link_fault != nullptr && fault.planned.after_s == 0.0) {
      met.push_back(*link_fault);
    } else {
      waiting_.push_back({fault.planned.what, fault.planned.after_s});
    }
  }
  return met;
}

std::vector<LinkFault> FaultPlan::meet_connection() {
  return meet_those([](const Trigger& on) { return std::holds_alternative<AtConnection>(on); });
}

std::vector<LinkFault> FaultPlan::meet(cs8::MessageType type) {
  return meet_those([type](const Trigger& on) {
    const auto* wanted = std::get_if<cs8::MessageType>(&on);
    return wanted != nullptr && *wanted == type;
  });
}

void FaultPlan::take_touch() {
  for (Counted& fault : faults_) {
    if (std::holds_alternative<AtTouch>(fault.planned.on)) fault.in_its_touch = comes(fault);
  }
}

void FaultPlan::enter(cs8::Phase phase) {
  for (Counted& fault : faults_) {
    if (!fault.in_its_touch) continue;
    const bool is_its_phase = std::get<AtTouch>(fault.planned.on).phase == phase;
    if (is_its_phase) waiting_.push_back({fault.planned.what, fault.planned.after_s});
    // Phases do not come twice in a touch, but for a fault in the middle of one.
    if (is_its_phase || phase == cs8::Phase::kIdle) fault.in_its_touch = false;
  }
}

void FaultPlan::follow(std::uint32_t touch_sequence, cs8::Phase phase) {
  if (touch_sequence != touch_) {
    if (touch_ != 0) enter(cs8::Phase::kIdle);
    if (touch_sequence != 0) take_touch();
    phase_ = cs8::Phase::kIdle;
  }
  if (touch_sequence != 0 && phase != phase_) enter(phase);
  touch_ = touch_sequence;
  phase_ = phase;
}

std::vector<Misfortune> FaultPlan::pass(double seconds) {
  std::vector<Misfortune> due;
  for (Waiting& waiting : waiting_) {
    waiting.left_s -= seconds;
    if (waiting.left_s <= 0.0) due.push_back(waiting.what);
  }
  std::erase_if(waiting_, [](const Waiting& waiting) { return waiting.left_s <= 0.0; });
  return due;
}

}  // namespace sim
