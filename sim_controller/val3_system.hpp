#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "sim_controller/cabinet.hpp"
#include "sim_controller/controller_arm.hpp"
#include "sim_controller/user_page.hpp"
#include "sim_controller/val3/machine/system.hpp"
#include "sim_controller/val3_channels.hpp"
#include "sim_controller/val3_signals.hpp"

namespace sim {

/// What a simulated controller says of itself, and what differs from one to the next.
struct Val3SystemOptions {
  CellLinks links = touchcal_links();
  CardNames cards{};               // of fieldbuses
  double wrist_to_flange_m = 0.1;  // of a TX90
  /// getVersion(), beside ArmType and ArmSN: the plant's arm.
  std::map<std::string, std::string, std::less<>> versions{{"VAL3", "s7.7.2 - Mar 23 2012 - 16:01:17"},
                                                           {"System", "s7.7.2 - Mar 23 2012"},
                                                           {"ControllerSN", "F09_9EF3A1_C_01"},
                                                           {"Tuning", "R3"},
                                                           {"Mounting", "floor"}};
  double clock_s = 0.0;                         // clock() at the start
  std::chrono::sys_seconds date{};              // getDate() at the start
  bool operator_owns_monitor_speed = true;      // setMonitorSpeed() answers -2
  std::size_t moves_max = 500;                  // in the move store; that of a CS8 is not known
  std::function<void(const std::string&)> log;  // logMsg, popUpMsg; may be empty
};

/// A joint's following error is what it goes in this time: the command of so long ago (add-on manual, pages
/// 13 and 16).
inline constexpr double kFollowingSeconds = 0.012;

/// The controller under a VAL3 application: the simulated cabinet with its arm, signals and panel, and what
/// only an application sees: channels, user page, latch, clock. Plant and cabinet outlive it.
class Val3System final : public val3::System {
 public:
  Val3System(const Plant& plant, Cabinet& cabinet, Val3SystemOptions options);

  /// 4 ms of the cell; what an application reads changes here and nowhere else.
  CabinetTick tick();

  [[nodiscard]] const ControllerArm& arm() const { return arm_; }
  [[nodiscard]] Val3Signals& signals() { return signals_; }
  [[nodiscard]] Val3Channels& channels() { return channels_; }
  [[nodiscard]] UserPage& page() { return page_; }
  /// Messages of logMsg and popUpMsg, the newest last; kMessagesMax of them.
  [[nodiscard]] const std::deque<std::string>& messages() const { return messages_; }
  /// Which move set move_error() and why it is impossible; empty where nothing did, or something else. It
  /// goes to the messages when the move fails.
  [[nodiscard]] const std::string& why_move_failed() const;
  /// Digital and analogue levels, joints and time as before; channels closed, motion reset: as at the end of
  /// an application (manual 6, page 61).
  void end_application();

  static constexpr std::size_t kMessagesMax = 1'000;

  // ---- val3::System ----
  [[nodiscard]] double clock_s() const override;

  std::optional<int> find_digital(std::string_view link) override;
  std::optional<int> find_analogue(std::string_view link) override;
  [[nodiscard]] bool digital(int id) const override;
  val3::RunError set_digital(int id, bool on) override;
  [[nodiscard]] double analogue(int id) const override;
  val3::RunError set_analogue(int id, double value) override;

  std::optional<int> find_channel(std::string_view link) override;
  bool connect(int channel) override;
  [[nodiscard]] bool peer_is_gone(int channel) const override;
  [[nodiscard]] std::size_t waiting(int channel) const override;
  std::size_t receive(int channel, std::span<std::uint8_t> bytes) override;
  std::size_t send(int channel, std::span<const std::uint8_t> bytes) override;
  bool close(int channel) override;
  [[nodiscard]] double channel_timeout_s(int channel) const override;
  [[nodiscard]] std::uint8_t end_of_string(int channel) const override;
  int set_channel(int channel, std::string_view name, std::optional<double> number, std::optional<bool> truth,
                  const std::string* text) override;

  [[nodiscard]] val3::Joint joints() const override;
  [[nodiscard]] val3::Joint position_error() const override;
  [[nodiscard]] double tool_speed(const val3::Trsf& tool) const override;
  /// Zero: motor currents are not simulated.
  [[nodiscard]] val3::Joint joint_force() const override { return {}; }
  [[nodiscard]] val3::Trsf flange_at(const val3::Joint& joints) const override;
  [[nodiscard]] std::optional<val3::Joint> solve(const val3::Trsf& flange, const val3::Config& config,
                                                 const val3::Joint& near) const override;
  [[nodiscard]] val3::Config config_of(const val3::Joint& joints) const override;
  [[nodiscard]] bool in_range(const val3::Joint& joints) const override;

  /// Every move stops at its end: blends are not simulated, which is told where one would have been made.
  val3::RunError store(const val3::MoveOrder& order) override;
  [[nodiscard]] bool store_is_full() const override;
  [[nodiscard]] val3::RunError move_error() const override;
  [[nodiscard]] val3::Joint last_stored() const override;
  void reset_motion(const std::optional<val3::Joint>& start) override;
  void stop_move() override;
  void restart_move() override;
  void cancel_blend() override {}
  [[nodiscard]] bool is_empty() const override;
  [[nodiscard]] bool is_settled() const override;
  [[nodiscard]] double move_id() const override;
  [[nodiscard]] double last_move_id() const override;
  void set_move_id(double id) override;
  void set_auto_connect(bool on) override;
  [[nodiscard]] bool auto_connect() const override;

  val3::RunError arm_latch(int digital) override;
  [[nodiscard]] std::optional<val3::Joint> latched() const override;

  [[nodiscard]] int working_mode() const override;
  [[nodiscard]] int mode_status() const override;
  [[nodiscard]] int emergency_stop() const override;
  [[nodiscard]] bool is_powered() const override;
  [[nodiscard]] bool is_calibrated() const override;
  void enable_power() override;
  void disable_power() override;
  [[nodiscard]] double monitor_speed() const override;
  int set_monitor_speed(double percent) override;
  [[nodiscard]] std::string version(std::string_view item) const override;
  [[nodiscard]] std::string date(const std::string& format) const override;

  void show_page(bool fixed) override;
  void clear_page() override;
  void go_to(int column, int row) override;
  void put(const std::string& text, bool new_line) override;
  void title(const std::string& text) override;
  void set_page_element(const std::string& name, const std::string& text) override;
  std::optional<int> take_key() override;
  [[nodiscard]] bool key_is_pressed(int code) const override;
  void pop_up(const std::string& text) override;
  void log(const std::string& text) override;

 private:
  [[nodiscard]] calib::JointVector joint_speeds() const;
  void power_up();
  void draw_for_search();
  void watch_latch(const CabinetTick& seen);
  void tell_blend(const val3::MoveOrder& order);
  void keep(const std::string& message);

  const Plant& plant_;
  Cabinet& cabinet_;
  Val3SystemOptions options_;
  ControllerArm arm_;
  Val3Signals signals_;
  Val3Channels channels_;
  std::set<int> told_clients_;  // channels
  UserPage page_;
  std::deque<std::string> messages_;
  std::int64_t ticks_ = 0;
  TickMotion motion_;  // of the last tick
  std::optional<int> power_up_ticks_;
  struct Latch {
    std::optional<int> armed;  // a digital input
    bool was_on = false;       // of one that a script sets
    std::optional<calib::JointVector> joints;
  } latch_;
  bool searched_ = false;  // since the last joint move
  bool last_move_blends_ = false;
  bool told_blend_ = false;
};

/// getDate(): %y %Y %m %d %H %I %p %M %S, the rest as it stands.
std::string date_text(const std::string& format, std::chrono::sys_seconds at);

}  // namespace sim
