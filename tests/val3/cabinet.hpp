#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim_controller/val3/machine/system.hpp"
#include "tests/val3/kinematics.hpp"

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

/// A controller that tests set by hand: arm, power, operator, inputs, sockets, clock.
class Cabinet final : public System {
 public:
  NominalArm arm;
  Joint joints_deg{};
  bool powered = true;
  bool calibrated = true;
  bool held = false;
  int mode = 4;
  int es_status = 0;
  double monitor_speed_percent = 100;
  std::string val3_version = "s7.7.2 - Mar 23 2012 - 16:01:17";
  std::string arm_type = "tx90-S1";                           // empty: the controller does not say
  std::map<std::string, double, std::less<>> socket_refuses;  // answers of sioCtrl, by what is set
  double now_s = 0;                                           // set before the start, it counts on from there
  std::map<std::string, bool, std::less<>> inputs;            // by link
  std::map<std::string, bool, std::less<>> outputs;           // by link
  std::map<std::string, double, std::less<>> analogues;       // outputs, by link
  std::set<std::string, std::less<>> latch_inputs;            // those with latch hardware
  bool latch_blind = false;                                   // takes the command and never captures
  std::map<std::string, Socket, std::less<>> sockets;
  /// What clearBuffer does to a living connection is to be confirmed on a controller: both are tested.
  bool clear_buffer_closes = true;
  std::vector<std::string> lines;  // of the log
  int pop_ups = 0;
  /// Called each 0.2 ms behind the motion: the world, which sets inputs by where the arm is.
  std::function<void(Cabinet&)> world;

  // Motion. A move runs at an even speed; it starts and stops within `ramp_s`.
  double ramp_s = 0.008;
  bool looks_empty_at_first = false;     // still in the tick in which the first move was queued
  std::optional<int> moves_until_error;  // so many moves are taken, then one ends its task with error 150
  bool stopped = false;                  // by stopMove
  std::optional<Joint> latched_joints;

  /// 0.2 ms pass: motion, world, latch. The clock is the caller's.
  void step();

  [[nodiscard]] double clock_s() const override { return now_s; }
  std::optional<int> find_digital(std::string_view link) override;
  std::optional<int> find_analogue(std::string_view link) override;
  [[nodiscard]] bool digital(int id) const override;
  RunError set_digital(int id, bool on) override;
  [[nodiscard]] double analogue(int id) const override;
  RunError set_analogue(int id, double value) override;
  std::optional<int> find_channel(std::string_view link) override;
  bool connect(int channel) override;
  [[nodiscard]] bool peer_is_gone(int channel) const override {
    return socket(channel).link == Socket::Link::kClosedByHost;
  }
  [[nodiscard]] std::size_t waiting(int channel) const override;
  std::size_t receive(int channel, std::span<std::uint8_t> bytes) override;
  std::size_t send(int channel, std::span<const std::uint8_t> bytes) override;
  bool close(int channel) override;
  [[nodiscard]] double channel_timeout_s(int channel) const override { return socket(channel).timeout_s; }
  [[nodiscard]] std::uint8_t end_of_string(int) const override { return 13; }
  int set_channel(int channel, std::string_view name, std::optional<double> number, std::optional<bool> truth,
                  const std::string* text) override;
  [[nodiscard]] Joint joints() const override { return joints_deg; }
  [[nodiscard]] Joint position_error() const override { return {}; }
  [[nodiscard]] double tool_speed(const Trsf&) const override { return 0; }
  [[nodiscard]] Joint joint_force() const override { return {}; }
  [[nodiscard]] Trsf flange_at(const Joint& joints) const override;
  [[nodiscard]] std::optional<Joint> solve(const Trsf& flange, const Config&,
                                           const Joint& near) const override;
  [[nodiscard]] Config config_of(const Joint&) const override { return {}; }
  [[nodiscard]] bool in_range(const Joint& joints) const override { return arm.in_range(joints); }
  RunError store(const MoveOrder& order) override;
  [[nodiscard]] bool store_is_full() const override { return false; }
  [[nodiscard]] RunError move_error() const override { return kErrorNone; }
  [[nodiscard]] Joint last_stored() const override { return queue_.empty() ? joints_deg : queue_.back().to; }
  void reset_motion(const std::optional<Joint>& start) override;
  void stop_move() override { stopped = true; }
  void restart_move() override { stopped = false; }
  void cancel_blend() override {}
  [[nodiscard]] bool is_empty() const override {
    return queue_.empty() || (looks_empty_at_first && queued_in_this_tick_);
  }
  [[nodiscard]] bool is_settled() const override { return rate_ == 0 && still_s_ >= kTickSeconds; }
  [[nodiscard]] double move_id() const override { return move_id_ + progress_; }
  [[nodiscard]] double last_move_id() const override { return moves_queued_; }
  void set_move_id(double id) override { moves_queued_ = id; }
  void set_auto_connect(bool) override {}
  [[nodiscard]] bool auto_connect() const override { return false; }
  RunError arm_latch(int digital) override;
  [[nodiscard]] std::optional<Joint> latched() const override { return latched_joints; }
  [[nodiscard]] int working_mode() const override { return mode; }
  [[nodiscard]] int mode_status() const override;
  [[nodiscard]] int emergency_stop() const override { return es_status; }
  [[nodiscard]] bool is_powered() const override { return powered; }
  [[nodiscard]] bool is_calibrated() const override { return calibrated; }
  void enable_power() override;
  void disable_power() override { powered = false; }
  [[nodiscard]] double monitor_speed() const override { return monitor_speed_percent; }
  int set_monitor_speed(double) override { return mode == 4 ? -2 : -1; }
  [[nodiscard]] std::string version(std::string_view item) const override;
  [[nodiscard]] std::string date(const std::string&) const override { return {}; }
  void show_page(bool) override {}
  void clear_page() override {}
  void go_to(int, int) override {}
  void put(const std::string&, bool) override {}
  void title(const std::string&) override {}
  std::optional<int> take_key() override { return std::nullopt; }
  [[nodiscard]] bool key_is_pressed(int) const override { return false; }
  void pop_up(const std::string&) override { ++pop_ups; }
  void log(const std::string& text) override { lines.push_back(text); }

 private:
  struct Move {
    Joint to{};
    double duration_s = 0;  // at monitor speed 100 %
  };
  [[nodiscard]] const Socket& socket(int channel) const;
  [[nodiscard]] Socket& socket(int channel);
  [[nodiscard]] bool can_move() const { return powered && !held && !stopped && es_status == 0; }
  void advance_motion();

  std::vector<std::string> signals_;   // by number
  std::vector<std::string> channels_;  // by number
  std::deque<Move> queue_;
  bool queued_in_this_tick_ = false;
  std::optional<Move> dropped_;  // what the arm stops in after a reset
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
