#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/val3/kinematics.hpp"
#include "tests/val3/values.hpp"

namespace val3 {

inline constexpr double kTickSeconds = 0.004;
inline constexpr double kStepSeconds = 0.0002;  // of the latch

/// A TCP server socket of the controller as VAL3 sees it, one client.
struct Socket {
  enum class Link { kNone, kOpen, kClosedByHost };
  Link link = Link::kNone;
  std::deque<std::uint8_t> to_controller;
  std::vector<std::uint8_t> to_host;
  std::size_t room = SIZE_MAX;  // bytes that sioSet can still take
  int connections = 0;
  double timeout_s = 5;  // as the pendant has it for a new one; -1: an access does not wait
  double clients = 2;
  bool nagle = true;

  /// False while a connection that is over still holds the socket.
  bool connect();
  /// What the host wrote before can still be read.
  void close_by_host();
};

/// Everything around the VAL3 language: arm, power, operator, inputs, sockets, clock. Tests set it.
struct Cabinet {
  NominalArm arm;
  Joint joints_deg{};
  bool powered = true;
  bool calibrated = true;
  bool held = false;
  int mode = 4;
  int emergency_stop = 0;
  double monitor_speed = 100;
  std::string version = "s7.7.2 - Mar 23 2012 - 16:01:17";
  std::string arm_type = "tx90-S1";                           // empty: the controller does not say
  std::map<std::string, double, std::less<>> socket_refuses;  // answers of sioCtrl, by what is set
  double clock_s = 0;                                         // set before the start, it counts on from there
  std::map<std::string, bool, std::less<>> inputs;            // by link
  std::map<std::string, bool, std::less<>> outputs;           // by link
  std::set<std::string, std::less<>> latch_inputs;            // those with latch hardware
  bool latch_blind = false;                                   // takes the command and never captures
  std::map<std::string, Socket, std::less<>> sockets;
  /// What clearBuffer does to a living connection is to be confirmed on a controller: both are tested.
  bool clear_buffer_closes = true;
  std::vector<std::string> log;
  int pop_ups = 0;
  /// Called each 0.2 ms behind the motion: the world, which sets inputs by where the arm is.
  std::function<void(Cabinet&)> world;

  // Motion. A move runs at an even speed; it starts and stops within `ramp_s`.
  double ramp_s = 0.008;
  struct Move {
    Joint to{};
    double duration_s = 0;  // at monitor speed 100 %
  };
  std::optional<int> moves_until_error;  // so many moves are taken, then one ends its task with error 150
  /// Appends a move and returns its id. The duration is that of the slowest joint or of the tool centre's
  /// way, whichever takes longer.
  double queue_move(const Joint& to, const Mdesc& mdesc, const Eigen::Isometry3d& flange_from_tool);
  void reset_motion();
  /// A task may still see an empty queue in the tick in which another one queued the first move.
  [[nodiscard]] bool is_empty() const {
    return queue_.empty() || (queued_by_ != nullptr && queued_by_ != caller);
  }
  [[nodiscard]] bool is_settled() const { return rate_ == 0 && still_s_ >= kTickSeconds; }
  [[nodiscard]] double move_id() const { return move_id_ + progress_; }
  [[nodiscard]] bool can_move() const { return powered && !held && !stopped && emergency_stop == 0; }
  bool stopped = false;          // by stopMove
  const void* caller = nullptr;  // the task that is on

  // Latch
  void arm_latch(const std::string& link);
  std::optional<Joint> latched;

  /// 0.2 ms pass: motion, world, latch. The clock is the caller's.
  void step();

 private:
  void advance_motion();
  [[nodiscard]] Joint last_queued() const;

  std::deque<Move> queue_;
  const void* queued_by_ = nullptr;  // the task that queued the first move in this tick
  std::optional<Move> dropped_;      // what the arm stops in after a reset
  Joint from_{};
  double progress_ = 0;  // of the first move
  double rate_ = 0;      // 0 stands, 1 nominal
  double still_s_ = 1;
  double move_id_ = 0;
  double moves_queued_ = 0;
  std::string armed_;
  bool armed_input_ = false;
};

}  // namespace val3
