// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/parking.hpp"

#include "calib_core/planning/aimed_transfer.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// An arm that stands so near to the park posture is there: less than its encoders' steps tell.
constexpr double kParkedRad = 1e-5;

}  // namespace

Parking::Parking(const Cell& cell, RunComputation& computation, TouchPreparation& preparation,
                 ControllerSession& session, PublishedStatus& status)
    : cell_(cell), computation_(computation), preparation_(preparation), session_(session), status_(status) {}

asio::awaitable<bool> Parking::park(ActiveRun& active) {
  if (active.guided) co_return true;  // the person does
  const State state = status_.state();
  const auto from = co_await session_.standing_joints();
  if (!from || status_.state() != state) co_return false;
  const calib::JointVector& to = cell_.park_joints;
  if ((*from - to).cwiseAbs().maxCoeff() < kParkedRad) co_return true;
  const auto find_way = [from = *from, to](const TouchPreparation& preparation, const Run&) {
    return calib::find_aimed_transfer(preparation.problem(), preparation.aim(), preparation.leaving(from),
                                      {to, std::nullopt, nullptr});
  };
  const auto via = co_await computation_.prepared(preparation_, active.run, find_way);
  if (status_.state() != state) co_return false;
  if (!via) {
    status_.raise({FaultCode::kNoSafeWay, "to the park posture"}, Event::kHoldFault);
    co_return false;
  }
  session_.forget_standing();
  const cs8::Travel command = travel_command(cell_, to, *via);
  const bool arrived = co_await session_.travel(command);
  co_return arrived;
}

}  // namespace cell
