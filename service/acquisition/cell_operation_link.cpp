// What the controller tells a CellOperation.
#include <spdlog/spdlog.h>

#include <utility>

#include "service/acquisition/cell_operation.hpp"

namespace cell {

void CellOperation::on_controller_state(const cs8::State& state) {
  session_.on_controller_state(state);
  location_.on_controller_state(state);
  manual_.on_controller_state(active(), state);
  session_.check_task(state, moves_without_run() ? Event::kAbortFault : Event::kHoldFault);
}

bool CellOperation::moves_without_run() const { return location_.is_passing() || way_back_.is_under_way(); }

/// A run keeps its touches; the way around the block and the way back from a face have none and begin anew.
Event CellOperation::after_lost_link() const {
  if (is_interrupted()) return Event::kNotReadyFault;
  return moves_without_run() ? Event::kAbortFault : Event::kLinkDown;
}

void CellOperation::on_link_lost(const cs8::LinkError& error) {
  if (status_.is_ending()) return;
  session_.on_link_lost(error, after_lost_link());
  wake_.wake();
}

/// As what an act throws: it ends what moves, never the daemon with its STOP.
void CellOperation::on_failed_hook(std::string why) {
  spdlog::error("on what the controller told, in the state {}: {}", state_name(status_.state()), why);
  if (status_.state() == State::kAborting) return;
  if (is_active(status_.state()) || way_back_.is_under_way())
    status_.raise({FaultCode::kInternalError, std::move(why)}, Event::kAbortFault);
}

}  // namespace cell
