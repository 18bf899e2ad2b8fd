#include "sim_controller/operator.hpp"

namespace sim {
namespace {

void power_up(Operator& person) { person.plan.push_back({kPowerUpSeconds, Act::kPowerOn}); }

void set_mode(Panel& panel, cs8::WorkingMode mode) {
  panel.powered = panel.powered && panel.mode == mode;
  panel.mode = mode;
}

void set_cell(Cabinet& cabinet, bool closed) {
  // What was tested before somebody went in may have been changed in there.
  if (!closed && cabinet.panel.cell_closed) cabinet.touch_test = TouchTest::kNone;
  cabinet.panel.cell_closed = closed;
}

}  // namespace

void start(Operator& person) {
  if (person.duties.powers_up) power_up(person);
}

void asked_for_touch_test(Operator& person) {
  if (!person.duties.touches_probe || !person.plan.empty()) return;
  person.plan = {{1.0, Act::kManualMode},    {1.0, Act::kOpenCell},  {2.0, Act::kTouchStylus},
                 {0.3, Act::kReleaseStylus}, {2.0, Act::kCloseCell}, {1.0, Act::kRemoteMode}};
  power_up(person);
}

void asked_to_confirm(Operator& person) {
  if (!person.duties.confirms) return;
  person.plan.push_back({person.confirms_after_s, Act::kPressConfirm});
  person.plan.push_back({0.3, Act::kReleaseConfirm});
}

void called_to_free_arm(Operator& person) {
  if (!person.duties.frees_arm) return;
  person.plan = {{0.0, Act::kJogHome}};
  power_up(person);
}

void perform(const Plant& plant, Cabinet& cabinet, Act act) {
  Panel& panel = cabinet.panel;
  switch (act) {
    case Act::kPowerOn:
      panel.powered = panel.emergency_stop == 0;
      break;
    case Act::kPowerOff:
      panel.powered = false;
      break;
    case Act::kManualMode:
      set_mode(panel, cs8::WorkingMode::kManual);
      break;
    case Act::kLocalMode:
      set_mode(panel, cs8::WorkingMode::kLocal);
      break;
    case Act::kRemoteMode:
      set_mode(panel, cs8::WorkingMode::kRemote);
      break;
    case Act::kOpenCell:
      set_cell(cabinet, false);
      break;
    case Act::kCloseCell:
      set_cell(cabinet, true);
      break;
    case Act::kTouchStylus:
      cabinet.world.probe.troubles.stylus = StylusTrouble::kStaysTouched;
      break;
    case Act::kReleaseStylus:
      free_probe(cabinet.world.probe);
      break;
    case Act::kPressConfirm:
      panel.confirm_key = true;
      break;
    case Act::kReleaseConfirm:
      panel.confirm_key = panel.confirm_key_stuck;
      break;
    case Act::kHold:
      panel.held = true;
      break;
    case Act::kMove:
      panel.held = false;
      cabinet.drives.connect_agreed = true;
      break;
    case Act::kEmergencyStop:
      panel.emergency_stop = 2;
      panel.powered = false;
      break;
    case Act::kReleaseEmergencyStop:
      if (panel.emergency_stop == 2) panel.emergency_stop = 1;
      break;
    case Act::kAcknowledgeEmergencyStop:
      if (panel.emergency_stop == 1) panel.emergency_stop = 0;
      break;
    case Act::kJogHome:
      displace(cabinet.drives, plant.start_joints);
      free_probe(cabinet.world.probe);
      cabinet.jogged = true;
      break;
  }
}

void tick(const Plant& plant, Operator& person, Cabinet& cabinet) {
  if (person.plan.empty()) return;
  person.plan.front().after_s -= kTickSeconds;
  while (!person.plan.empty() && person.plan.front().after_s <= 0.0) {
    const Act act = person.plan.front().act;
    person.plan.pop_front();
    perform(plant, cabinet, act);
  }
}

}  // namespace sim
