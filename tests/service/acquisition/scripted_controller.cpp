#include "tests/service/acquisition/scripted_controller.hpp"

namespace cell {

ScriptedController::ScriptedController()
    : on_connect([] { return cs8::Welcome{}; }),
      on_begin([](std::uint32_t run) {
        cs8::Permit granted;
        granted.run = run;
        granted.state = cs8::PermitState::kGranted;
        return granted;
      }),
      on_touch([](const cs8::Touch&) { return lost(); }),
      on_move([] { return arrived(); }),
      on_query([](std::uint32_t of) { return cs8::ResultUnknown{of}; }) {}

ScriptedController::~ScriptedController() = default;

cs8::State ScriptedController::ready_state() {
  cs8::State state;
  state.flags = cs8::kPowered | cs8::kArmCalibrated | cs8::kSettled | cs8::kQueueEmpty | cs8::kCellClosed |
                cs8::kTouchTested | cs8::kProbeLoopClosed;
  state.mode = cs8::WorkingMode::kRemote;
  state.monitor_speed_percent = 100;
  return state;
}

cs8::Permit ScriptedController::granted(std::uint32_t run) {
  cs8::Permit permit;
  permit.run = run;
  permit.state = cs8::PermitState::kGranted;
  return permit;
}

cs8::MoveResult ScriptedController::arrived() {
  cs8::MoveResult result;
  result.outcome = cs8::Outcome::kArrived;
  return result;
}

cs8::LinkError ScriptedController::lost() { return {cs8::LinkErrorKind::kSilent, "scripted"}; }

void ScriptedController::listen(cs8::ClientHooks to_call) { hooks = std::move(to_call); }

boost::asio::awaitable<cs8::ConnectReply> ScriptedController::connect(cs8::ExpectedController) {
  asked.emplace_back("connect");
  cs8::ConnectReply reply = on_connect();
  is_connected = std::holds_alternative<cs8::Welcome>(reply);
  co_return reply;
}

void ScriptedController::close() {
  asked.emplace_back("close");
  is_connected = false;
}

boost::asio::awaitable<cs8::PermitReply> ScriptedController::begin(std::uint32_t run,
                                                                   std::chrono::milliseconds) {
  asked.push_back("begin " + std::to_string(run));
  cs8::PermitReply reply = on_begin(run);
  if (const auto* given = std::get_if<cs8::Permit>(&reply)) permit = *given;
  co_return reply;
}

void ScriptedController::finish() { asked.emplace_back("finish"); }

std::optional<cs8::State> ScriptedController::latest_state() const {
  return is_connected ? state : std::nullopt;
}

boost::asio::awaitable<cs8::TouchReply> ScriptedController::touch(cs8::Touch command) {
  asked.push_back("touch " + std::to_string(++sequence));
  return answer_touch(sequence, on_touch(command));
}

boost::asio::awaitable<cs8::MoveReply> ScriptedController::travel(cs8::Travel) {
  asked.push_back("travel " + std::to_string(++sequence));
  return answer_move(sequence, on_move());
}

boost::asio::awaitable<cs8::MoveReply> ScriptedController::retract(cs8::Retract) {
  asked.push_back("retract " + std::to_string(++sequence));
  if (state) state->flags &= ~static_cast<std::uint32_t>(cs8::kRetractDue);
  return answer_move(sequence, on_move());
}

boost::asio::awaitable<cs8::QueryReply> ScriptedController::query(std::uint32_t of,
                                                                  std::chrono::milliseconds) {
  asked.push_back("query " + std::to_string(of));
  co_return on_query(of);
}

void ScriptedController::stop() { asked.emplace_back("stop"); }

void ScriptedController::acknowledge(std::uint32_t of) {
  asked.push_back("acknowledge " + std::to_string(of));
}

boost::asio::awaitable<cs8::TouchReply> ScriptedController::answer_touch(std::uint32_t sequence,
                                                                         TouchAnswer answer) {
  cs8::TouchReply reply{sequence, std::move(answer)};
  co_return reply;
}

boost::asio::awaitable<cs8::MoveReply> ScriptedController::answer_move(std::uint32_t sequence,
                                                                       MoveAnswer answer) {
  cs8::MoveReply reply{sequence, std::move(answer)};
  co_return reply;
}

}  // namespace cell
