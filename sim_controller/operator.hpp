#pragma once

#include <deque>

#include "config/fault_file.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/plant.hpp"

/// The person at the simulated cell: a script of acts with simulated time between them. A fault file can
/// disable single acts; then nobody performs them.
namespace sim {

enum class Act {
  kPowerOn,
  kPowerOff,
  kManualMode,
  kLocalMode,
  kRemoteMode,
  kOpenCell,
  kCloseCell,
  kTouchStylus,  // holds it deflected by hand
  kReleaseStylus,
  kPressConfirm,
  kReleaseConfirm,
  kHold,
  kMove,  // the move/hold key lets the queue move
  kEmergencyStop,
  kReleaseEmergencyStop,
  kAcknowledgeEmergencyStop,
  kJogHome,  // frees the arm and brings it to its start posture
};

using cell::OperatorDuties;

/// Enabling power takes a CS8 two to five seconds.
inline constexpr double kPowerUpSeconds = 2.5;
/// From the wish for a confirmation to the pressed key.
inline constexpr double kConfirmSeconds = 1.0;

struct PlannedAct {
  double after_s = 0.0;  // simulated, from the act before
  Act act{};
};

struct Operator {
  OperatorDuties duties;
  double confirms_after_s = kConfirmSeconds;
  std::deque<PlannedAct> plan;
};

void start(Operator& person);
void asked_for_touch_test(Operator& person);
void asked_to_confirm(Operator& person);
void called_to_free_arm(Operator& person);

/// What the act does, at once; a mode change and an emergency stop take the power.
void perform(const Plant& plant, Cabinet& cabinet, Act act);

/// One tick: performs what is due.
void tick(const Plant& plant, Operator& person, Cabinet& cabinet);

}  // namespace sim
