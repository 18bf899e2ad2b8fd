#pragma once

#include <deque>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "service/acquisition/controller.hpp"

namespace cell {

/// A controller that answers as a test says, at once, and writes down what it was asked.
class ScriptedController : public Controller {
 public:
  using TouchAnswer = std::variant<cs8::TouchResult, cs8::Rejected, cs8::LinkError>;
  using MoveAnswer = std::variant<cs8::MoveResult, cs8::Rejected, cs8::LinkError>;

  /// An arm that rests, ready for a run.
  static cs8::State ready_state() {
    cs8::State state;
    state.flags = cs8::kPowered | cs8::kArmCalibrated | cs8::kSettled | cs8::kQueueEmpty | cs8::kCellClosed |
                  cs8::kTouchTested | cs8::kProbeLoopClosed;
    state.mode = cs8::WorkingMode::kRemote;
    state.monitor_speed_percent = 100;
    return state;
  }
  static cs8::MoveResult arrived() {
    cs8::MoveResult result;
    result.outcome = cs8::Outcome::kArrived;
    return result;
  }
  static cs8::LinkError lost() { return {cs8::LinkErrorKind::kSilent, "scripted"}; }

  void listen(cs8::ClientHooks to_call) override { hooks = std::move(to_call); }
  boost::asio::awaitable<cs8::ConnectReply> connect(cs8::ExpectedController) override {
    asked.emplace_back("connect");
    cs8::ConnectReply reply = on_connect();
    is_connected = std::holds_alternative<cs8::Welcome>(reply);
    co_return reply;
  }
  void close() override {
    asked.emplace_back("close");
    is_connected = false;
  }
  [[nodiscard]] bool connected() const override { return is_connected; }

  boost::asio::awaitable<cs8::PermitReply> begin(std::uint32_t run, std::chrono::milliseconds) override {
    asked.push_back("begin " + std::to_string(run));
    cs8::PermitReply reply = on_begin(run);
    if (const auto* told = std::get_if<cs8::Permit>(&reply)) permit = *told;
    co_return reply;
  }
  void finish() override { asked.emplace_back("finish"); }
  [[nodiscard]] std::optional<cs8::Permit> latest_permit() const override { return permit; }
  [[nodiscard]] std::optional<cs8::State> latest_state() const override {
    return is_connected ? state : std::nullopt;
  }
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> heard_at() const override {
    return heard;
  }

  [[nodiscard]] std::uint32_t next_sequence() const override { return sequence + 1; }
  boost::asio::awaitable<cs8::TouchReply> touch(cs8::Touch command) override {
    asked.push_back("touch " + std::to_string(++sequence));
    return answer_touch(sequence, on_touch(command));
  }
  boost::asio::awaitable<cs8::MoveReply> travel(cs8::Travel) override {
    asked.push_back("travel " + std::to_string(++sequence));
    return answer_move(sequence, on_move());
  }
  boost::asio::awaitable<cs8::MoveReply> retract(cs8::Retract) override {
    asked.push_back("retract " + std::to_string(++sequence));
    if (state) state->flags &= ~static_cast<std::uint32_t>(cs8::kRetractDue);
    return answer_move(sequence, on_move());
  }
  boost::asio::awaitable<cs8::QueryReply> query(std::uint32_t of, std::chrono::milliseconds) override {
    asked.push_back("query " + std::to_string(of));
    co_return on_query(of);
  }
  void stop() override { asked.emplace_back("stop"); }
  void acknowledge(std::uint32_t of) override { asked.push_back("acknowledge " + std::to_string(of)); }

  std::function<cs8::ConnectReply()> on_connect = [] { return cs8::Welcome{}; };
  std::function<cs8::PermitReply(std::uint32_t)> on_begin = [](std::uint32_t run) {
    cs8::Permit granted;
    granted.run = run;
    granted.state = cs8::PermitState::kGranted;
    return granted;
  };
  std::function<TouchAnswer(const cs8::Touch&)> on_touch = [](const cs8::Touch&) { return lost(); };
  std::function<MoveAnswer()> on_move = [] { return arrived(); };
  std::function<cs8::QueryReply(std::uint32_t)> on_query = [](std::uint32_t of) {
    return cs8::ResultUnknown{of};
  };

  cs8::ClientHooks hooks;
  bool is_connected = true;
  std::optional<cs8::State> state = ready_state();
  std::optional<cs8::Permit> permit;
  std::optional<std::chrono::steady_clock::time_point> heard;
  std::uint32_t sequence = 0;  // of the last command
  std::vector<std::string> asked;

 private:
  static boost::asio::awaitable<cs8::TouchReply> answer_touch(std::uint32_t sequence, TouchAnswer answer) {
    cs8::TouchReply reply{sequence, std::move(answer)};
    co_return reply;
  }
  static boost::asio::awaitable<cs8::MoveReply> answer_move(std::uint32_t sequence, MoveAnswer answer) {
    cs8::MoveReply reply{sequence, std::move(answer)};
    co_return reply;
  }
};

}  // namespace cell
