#include "sim_controller/controller_state.hpp"

namespace sim {

void restart_application(ControllerState& state) {
  ++state.session;
  state.motion = {};
  reset_motion(state.cabinet.drives);
  state.permit = {};
  state.last_sequence = 0;
  state.stored_result.reset();
  state.cabinet.touch_test = TouchTest::kNone;
  state.cabinet.task_error = 0;
  state.cabinet.overruns = 0;
}

}  // namespace sim
