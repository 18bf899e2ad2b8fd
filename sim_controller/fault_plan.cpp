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

bool FaultPlan::count_trigger(Counted& fault) {
  return ++fault.seen == fault.planned.nth || fault.planned.every;
}

template <class Matches>
std::vector<LinkFault> FaultPlan::matching_faults(Matches matches) {
  std::vector<LinkFault> found;
  for (Counted& fault : faults_) {
    if (!matches(fault.planned.on) || !count_trigger(fault)) continue;
    const auto* link_fault = std::get_if<LinkFault>(&fault.planned.what);
    if (link_fault != nullptr && fault.planned.after_s == 0.0) {
      found.push_back(*link_fault);
    } else {
      waiting_.push_back({fault.planned.what, fault.planned.after_s});
    }
  }
  return found;
}

std::vector<LinkFault> FaultPlan::faults_at_connection() {
  return matching_faults([](const Trigger& on) { return std::holds_alternative<AtConnection>(on); });
}

std::vector<LinkFault> FaultPlan::faults_at(cs8::MessageType type) {
  return matching_faults([type](const Trigger& on) {
    const auto* wanted = std::get_if<cs8::MessageType>(&on);
    return wanted != nullptr && *wanted == type;
  });
}

void FaultPlan::count_touch() {
  for (Counted& fault : faults_) {
    if (std::holds_alternative<AtTouch>(fault.planned.on)) fault.in_its_touch = count_trigger(fault);
  }
}

void FaultPlan::start_faults_of(cs8::Phase phase) {
  for (Counted& fault : faults_) {
    if (!fault.in_its_touch) continue;
    const bool is_its_phase = std::get<AtTouch>(fault.planned.on).phase == phase;
    if (is_its_phase) waiting_.push_back({fault.planned.what, fault.planned.after_s});
    // Phases do not come twice in a touch, but for a fault in the middle of one.
    if (is_its_phase || phase == cs8::Phase::kIdle) fault.in_its_touch = false;
  }
}

void FaultPlan::on_touch_phase(std::uint32_t touch_sequence, cs8::Phase phase) {
  if (touch_sequence != touch_) {
    if (touch_ != 0) start_faults_of(cs8::Phase::kIdle);
    if (touch_sequence != 0) count_touch();
    phase_ = cs8::Phase::kIdle;
  }
  if (touch_sequence != 0 && phase != phase_) start_faults_of(phase);
  touch_ = touch_sequence;
  phase_ = phase;
}

std::vector<InjectedEvent> FaultPlan::advance(double seconds) {
  std::vector<InjectedEvent> due;
  for (Waiting& waiting : waiting_) {
    waiting.left_s -= seconds;
    if (waiting.left_s <= 0.0) due.push_back(waiting.what);
  }
  std::erase_if(waiting_, [](const Waiting& waiting) { return waiting.left_s <= 0.0; });
  return due;
}

}  // namespace sim
