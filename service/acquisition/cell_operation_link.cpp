// What the controller tells a CellOperation.
#include "service/acquisition/cell_operation.hpp"

namespace cell {

void CellOperation::on_controller_state(const cs8::State& state) {
  session_.on_controller_state(state);
  location_.on_controller_state(state);
  manual_.on_controller_state(active(), state);
  session_.check_task(state);
}

void CellOperation::on_link_lost(const cs8::LinkError& error) {
  if (status_.is_ending()) return;
  session_.on_link_lost(error, is_interrupted() ? Event::kNotReadyFault : Event::kLinkDown);
  wake_.wake();
}

}  // namespace cell
