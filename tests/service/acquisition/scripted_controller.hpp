#pragma once

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

  ScriptedController();
  ~ScriptedController() override;

  /// An arm that rests, ready for a run.
  static cs8::State ready_state();
  /// A person confirmed the run.
  static cs8::Permit granted(std::uint32_t run);
  static cs8::MoveResult arrived();
  static cs8::LinkError lost();

  void listen(cs8::ClientHooks to_call) override;
  boost::asio::awaitable<cs8::ConnectReply> connect(cs8::ExpectedController expected) override;
  void close() override;
  [[nodiscard]] bool connected() const override { return is_connected; }

  boost::asio::awaitable<cs8::PermitReply> begin(std::uint32_t run,
                                                 std::chrono::milliseconds confirm_within) override;
  void finish() override;
  [[nodiscard]] std::optional<cs8::Permit> latest_permit() const override { return permit; }
  [[nodiscard]] std::optional<cs8::State> latest_state() const override;
  [[nodiscard]] std::uint32_t next_sequence() const override { return sequence + 1; }
  boost::asio::awaitable<cs8::TouchReply> touch(cs8::Touch command) override;
  boost::asio::awaitable<cs8::MoveReply> travel(cs8::Travel command) override;
  boost::asio::awaitable<cs8::MoveReply> retract(cs8::Retract command) override;
  boost::asio::awaitable<cs8::QueryReply> query(std::uint32_t of, std::chrono::milliseconds within) override;
  void stop() override;
  void acknowledge(std::uint32_t of) override;

  // The script.
  std::function<cs8::ConnectReply()> on_connect;
  std::function<cs8::PermitReply(std::uint32_t)> on_begin;
  std::function<TouchAnswer(const cs8::Touch&)> on_touch;
  std::function<MoveAnswer()> on_move;
  std::function<cs8::QueryReply(std::uint32_t)> on_query;

  cs8::ClientHooks hooks;
  bool is_connected = true;
  std::optional<cs8::State> state = ready_state();
  std::optional<cs8::Permit> permit;
  std::uint32_t sequence = 0;  // of the last command
  std::vector<std::string> asked;

 private:
  static boost::asio::awaitable<cs8::TouchReply> answer_touch(std::uint32_t sequence, TouchAnswer answer);
  static boost::asio::awaitable<cs8::MoveReply> answer_move(std::uint32_t sequence, MoveAnswer answer);
};

}  // namespace cell
