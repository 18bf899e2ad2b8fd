#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cs8_protocol/codec.hpp"
#include "tests/val3/cabinet.hpp"
#include "tests/val3/controller.hpp"

namespace val3 {

/// The application for the real controller, running in a cabinet, with a host at its socket and a person at
/// the cell. All in simulated time.
class Bench {
 public:
  struct Hardware {
    bool latch = true;
    double clock_s = 0;  // since the controller was switched on
    /// What is otherwise about the cabinet when the application starts.
    std::function<void(Cabinet&)> differs = {};
  };
  explicit Bench(Hardware hardware);
  Bench() : Bench(Hardware{}) {}

  // The cabinet's variables in the application that are links to the world.
  static constexpr const char* kContact = "diContact";
  static constexpr const char* kLoop = "diLoop";
  static constexpr const char* kClosed = "diClosed";
  static constexpr const char* kConfirm = "diConfirm";
  static constexpr const char* kSocket = "siHost";
  static constexpr const char* kHasLatch = "kHasLatch";  // a constant: whether kContact has latch hardware

  /// 4 ms each; the host sends a heartbeat each 100 ms while `heartbeats` and a connection stand.
  void ticks(int count);
  void seconds(double s) { ticks(static_cast<int>(s / kTickSeconds + 0.5)); }

  // The host.
  [[nodiscard]] bool connect();
  /// Connects, sends Hello and takes Welcome.
  cs8::Welcome greet(std::uint32_t heartbeat_timeout_ms = 500);
  void disconnect() { socket().close_by_host(); }
  /// Hello once more on the same connection.
  cs8::Welcome greet_again();
  [[nodiscard]] bool connected() { return socket().link == Socket::Link::kOpen; }
  void send(std::uint32_t sequence, const cs8::Payload& payload);
  void send_bytes(const std::vector<std::uint8_t>& bytes);
  /// The next message that is not State, or nothing within that time.
  std::optional<cs8::Message> next(double within_s = 0.1);
  /// The next message that is not State; a failed expectation and zeros when it is another one or none.
  template <class Body>
  Body expect(std::optional<std::uint32_t> sequence = {}, double within_s = 0.1);
  /// The first message of that kind; those before it are kept. A failed expectation and zeros without one.
  template <class Body>
  Body await(double within_s = 0.1);
  /// The next State made from now on.
  cs8::State state();
  [[nodiscard]] int states_seen() const { return states_seen_; }
  void expect_silence(double s);
  /// As the newest Permit of this connection said; none without one.
  [[nodiscard]] cs8::PermitState permit() { return connected() ? permit_ : cs8::PermitState::kNone; }

  // The person at the cell.
  void
  touch_by_hand();  // in manual mode, as the touch test wants it; then back to remote with the cell closed
  void confirm();   // presses and lets go
  /// Touch test, connection, Begin, confirmation: motion commands are taken.
  void make_ready();

  // The world.
  struct Wires {
    bool hand = false;            // somebody presses the stylus
    std::optional<bool> contact;  // what the wire says whatever the probe does
    std::optional<bool> loop;
    bool stuck = false;    // a probe once touched stays so
    double bounce_mm = 0;  // the contact opens again this deep behind the face, for as long again
  };
  Wires wires;
  std::optional<double> face_mm;  // depth below the approach posture; nothing: no face
  bool cell_closed = true;
  bool confirm_key = false;

  /// A joint vector that deep below the approach posture, tool straight down; 10^-6 deg.
  [[nodiscard]] cs8::JointsMicrodeg at_depth(double mm) const;
  [[nodiscard]] double depth_mm() const;
  /// From 20 mm above the approach posture, search of 20 mm, no second touch.
  [[nodiscard]] cs8::Touch touch() const;
  [[nodiscard]] cs8::Travel travel_to(double depth_mm) const;

  [[nodiscard]] Socket& socket() { return *socket_; }
  [[nodiscard]] std::string log() const;
  template <class T>
  [[nodiscard]] T variable(const std::string& name) const {
    if constexpr (std::is_same_v<T, bool>) return controller.machine().truth(name);
    return controller.machine().number(name);
  }

  /// Every number, bool, string and joint of the application that is no constant gets a value that makes no
  /// sense, but for `kept`.
  void spoil_globals(const std::set<std::string>& kept);

  Cabinet cabinet;
  Controller controller;
  bool heartbeats = true;

 private:
  void set_up(const Hardware& hardware);
  [[nodiscard]] std::string link(const std::string& variable) const;
  void update_inputs();
  void read_frames();

  std::array<bool*, 4> inputs_{};  // of the cabinet: contact, loop, closed, confirm
  Socket* socket_ = nullptr;
  double z_of_approach_m_ = 0;
  bool was_touched_ = false;
  int ticks_ = 0;
  int states_seen_ = 0;
  std::size_t read_ = 0;  // of what the socket gave the host
  std::optional<cs8::State> state_;
  cs8::PermitState permit_{};
  std::deque<cs8::Message> inbox_;
};

/// "cs8_protocol/val3/touchcal/touchcal.pjx" in the source tree.
std::filesystem::path project_path();

}  // namespace val3

#include <gtest/gtest.h>

namespace val3 {

template <class Body>
Body Bench::expect(std::optional<std::uint32_t> sequence, double within_s) {
  const auto message = next(within_s);
  if (!message) {
    ADD_FAILURE() << "no message within " << within_s << " s\n" << log();
    return {};
  }
  if (sequence) {
    EXPECT_EQ(message->sequence, *sequence);
  }
  if (const Body* body = std::get_if<Body>(&message->payload)) return *body;
  ADD_FAILURE() << "another message: type " << static_cast<int>(cs8::type_of(*message)) << '\n' << log();
  return {};
}

template <class Body>
Body Bench::await(double within_s) {
  for (int left = static_cast<int>(within_s / kTickSeconds + 0.5);; --left) {
    for (auto message = inbox_.begin(); message != inbox_.end(); ++message) {
      const Body* body = std::get_if<Body>(&message->payload);
      if (body == nullptr) continue;
      const Body result = *body;
      inbox_.erase(message);
      return result;
    }
    if (left <= 0) break;
    ticks(1);
  }
  ADD_FAILURE() << "no such message within " << within_s << " s\n" << log();
  return {};
}

}  // namespace val3
