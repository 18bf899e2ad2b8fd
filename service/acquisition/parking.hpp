#pragma once

#include <boost/asio/awaitable.hpp>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/run_computation.hpp"
#include "service/acquisition/touch_preparation.hpp"

namespace cell {

/// Takes the arm to the park posture: at the end of a run, and before the block is brought to another place.
class Parking {
 public:
  /// All must outlive it.
  Parking(const Cell& cell, RunComputation& computation, TouchPreparation& preparation,
          ControllerSession& session, PublishedStatus& status);

  /// In the present state. False when another state was entered, when there is no clear way, which raises a
  /// fault, or when the link is lost, which the controller's hook reports.
  boost::asio::awaitable<bool> park(ActiveRun& active);

 private:
  const Cell& cell_;
  RunComputation& computation_;
  TouchPreparation& preparation_;
  ControllerSession& session_;
  PublishedStatus& status_;
};

}  // namespace cell
