#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim_controller/val3/program/values.hpp"

/// What lies under the language on a controller: clock, arm, inputs and outputs, sockets, panel, user page.
/// The machine calls it; a simulated cell, or a test's bench, is one.
namespace val3 {

/// Run-time errors as taskStatus tells them (manual 6, pages 86 and 179).
enum RunError : int {
  kErrorNone = 0,
  kErrorDivision = 10,
  kErrorArgument = 11,
  kErrorIndex = 20,
  kErrorIndexNegative = 21,
  kErrorTaskName = 29,
  kErrorNoTask = 30,
  kErrorTaskExists = 31,
  kErrorPeriods = 32,
  kErrorRunMemory = 41,
  kErrorTimeout = 60,
  kErrorInterpreter = 61,
  kErrorParameter = 70,
  kErrorNoLibrary = 80,
  kErrorNoLine = 90,
  kErrorVel = 100,
  kErrorAccel = 101,
  kErrorDecel = 102,
  kErrorTvel = 103,
  kErrorRvel = 104,
  kErrorReach = 105,
  kErrorLeave = 106,
  kErrorWriteToInput = 122,
  kErrorNotLinked = 123,
  kErrorInputOutput = 125,
  kErrorImpossibleMove = 150,
  kErrorInvalidMove = 154,
  kErrorFlangeChanged = 160,
  kErrorWorldChanged = 161,
  kErrorPointWithoutFrame = 162,
  kErrorFrameWithoutFather = 163,
  kErrorToolWithoutFather = 164,
  kErrorLinkedToLocal = 165,
};

/// The line that stores a motion, for the log.
struct MoveOrigin {
  std::string task;
  std::string file;
  int line = 0;
};

/// A motion that is put into the move store. Poses are of the tool's end in the world, mm.
struct MoveOrder {
  enum class Shape { kJoint, kLine, kCircle };
  Shape shape = Shape::kJoint;
  Joint to{};             // of kJoint, and the joints that a pose was solved to
  Trsf to_pose;           // of kLine and kCircle
  Trsf via_pose;          // of kCircle
  Trsf tool;              // flange to the tool's end
  Mdesc descriptor;       // lengths in mm
  bool reachable = true;  // false: no joints bring the tool there; it fails when the arm should begin it
  /// Of kLine and kCircle, what the end may be: kSame means as at the move's start. What the point asks for.
  Config config{Shoulder::kFree, Elbow::kFree, Wrist::kFree};
  MoveOrigin origin{};
};

class System {
 public:
  System() = default;
  virtual ~System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Seconds since boot; it goes on by the machine's ticks.
  [[nodiscard]] virtual double clock_s() const = 0;

  // ---- inputs and outputs ----
  /// The number of a link ("FastIO\fIn0", "io:fIn0" of s5 and s6 as "fIn0"), or nothing where it is not
  /// there.
  virtual std::optional<int> find_digital(std::string_view link) = 0;
  virtual std::optional<int> find_analogue(std::string_view link) = 0;
  [[nodiscard]] virtual bool digital(int id) const = 0;
  /// kErrorNone, kErrorWriteToInput.
  virtual RunError set_digital(int id, bool on) = 0;
  [[nodiscard]] virtual double analogue(int id) const = 0;
  virtual RunError set_analogue(int id, double value) = 0;

  // ---- sockets and serial ports ----
  virtual std::optional<int> find_channel(std::string_view link) = 0;
  /// Makes it active where it is not: a server listens, a client connects. True when a peer is there.
  virtual bool connect(int channel) = 0;
  /// The peer has closed the connection, and the program has not: nobody is there until it does (close()).
  [[nodiscard]] virtual bool peer_is_gone(int channel) const = 0;
  /// Bytes that can be read at once.
  [[nodiscard]] virtual std::size_t waiting(int channel) const = 0;
  /// Takes up to bytes.size() of them; returns how many.
  virtual std::size_t receive(int channel, std::span<std::uint8_t> bytes) = 0;
  /// Gives up to bytes.size(); returns how many there was room for.
  virtual std::size_t send(int channel, std::span<const std::uint8_t> bytes) = 0;
  /// Closes the connection; false where there was none.
  virtual bool close(int channel) = 0;
  /// Time-out in s of the channel: 0 waits for ever, -1 does not wait.
  [[nodiscard]] virtual double channel_timeout_s(int channel) const = 0;
  [[nodiscard]] virtual std::uint8_t end_of_string(int channel) const = 0;
  /// sioCtrl: 0, or its number of a refusal (-1 unknown name ... -5). Exactly one of the values is given.
  virtual int set_channel(int channel, std::string_view name, std::optional<double> number,
                          std::optional<bool> truth, const std::string* text) = 0;

  // ---- arm ----
  /// herej(): commanded while powered, else as the encoders say.
  [[nodiscard]] virtual Joint joints() const = 0;
  [[nodiscard]] virtual Joint position_error() const = 0;
  /// Of the tool's end by the joint command, mm/s.
  [[nodiscard]] virtual double tool_speed(const Trsf& tool) const = 0;
  [[nodiscard]] virtual Joint joint_force() const = 0;
  /// World from flange, mm; the arm's nominal geometry.
  [[nodiscard]] virtual Trsf flange_at(const Joint& joints) const = 0;
  /// Joints nearest to `near` that bring the flange there in that configuration, or nothing.
  [[nodiscard]] virtual std::optional<Joint> solve(const Trsf& flange, const Config& config,
                                                   const Joint& near) const = 0;
  [[nodiscard]] virtual Config config_of(const Joint& joints) const = 0;
  [[nodiscard]] virtual bool in_range(const Joint& joints) const = 0;

  /// Stores a move. kErrorImpossibleMove when an earlier one failed and reset_motion() has not been called;
  /// what a move itself cannot do comes when the arm should begin it.
  virtual RunError store(const MoveOrder& order) = 0;
  /// The store is full: the instruction waits.
  [[nodiscard]] virtual bool store_is_full() const = 0;
  /// An earlier move failed: kErrorImpossibleMove until reset_motion(), else kErrorNone.
  [[nodiscard]] virtual RunError move_error() const = 0;
  /// Joints at the end of what is stored, or of the arm where nothing is.
  [[nodiscard]] virtual Joint last_stored() const = 0;
  /// Without a start: the next move begins wherever the arm is.
  virtual void reset_motion(const std::optional<Joint>& start) = 0;
  virtual void stop_move() = 0;
  virtual void restart_move() = 0;
  /// The blend of the last move is given up: the arm goes to its end.
  virtual void cancel_blend() = 0;
  [[nodiscard]] virtual bool is_empty() const = 0;
  [[nodiscard]] virtual bool is_settled() const = 0;
  [[nodiscard]] virtual double move_id() const = 0;
  /// What the last stored move was numbered.
  [[nodiscard]] virtual double last_move_id() const = 0;
  virtual void set_move_id(double id) = 0;
  virtual void set_auto_connect(bool on) = 0;
  [[nodiscard]] virtual bool auto_connect() const = 0;

  /// Waits for the next rising edge. kErrorParameter for an input without a latch.
  virtual RunError arm_latch(int digital) = 0;
  [[nodiscard]] virtual std::optional<Joint> latched() const = 0;

  // ---- panel ----
  [[nodiscard]] virtual int working_mode() const = 0;  // 0 changing, 1 manual, 2 test, 3 local, 4 remote
  [[nodiscard]] virtual int mode_status() const = 0;
  [[nodiscard]] virtual int emergency_stop() const = 0;  // 0 clear, 1 to be acknowledged, 2 active
  [[nodiscard]] virtual bool is_powered() const = 0;
  [[nodiscard]] virtual bool is_calibrated() const = 0;
  virtual void enable_power() = 0;
  virtual void disable_power() = 0;
  [[nodiscard]] virtual double monitor_speed() const = 0;
  /// 0, -1 not remote, -2 the operator owns it, -3 out of range.
  virtual int set_monitor_speed(double percent) = 0;
  /// getVersion: "" where it is not known.
  [[nodiscard]] virtual std::string version(std::string_view item) const = 0;
  /// getDate by its format (%y %Y %m %d %H %I %p %M %S).
  [[nodiscard]] virtual std::string date(const std::string& format) const = 0;

  // ---- user page ----
  virtual void show_page(bool fixed) = 0;
  virtual void clear_page() = 0;
  virtual void go_to(int column, int row) = 0;
  virtual void put(const std::string& text, bool new_line) = 0;
  virtual void title(const std::string& text) = 0;
  /// s8: what an element of a page of HTML shows, "page.element.attribute".
  virtual void set_page_element(const std::string& /*name*/, const std::string& /*text*/) {}
  /// The last key since the last call.
  virtual std::optional<int> take_key() = 0;
  [[nodiscard]] virtual bool key_is_pressed(int code) const = 0;
  virtual void pop_up(const std::string& text) = 0;
  virtual void log(const std::string& text) = 0;
};

}  // namespace val3
