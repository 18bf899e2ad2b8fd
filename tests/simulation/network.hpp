#pragma once

#include <sys/epoll.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// How the cable between host and controller behaves, from now on.
struct NetworkConditions {
  Time latency{std::chrono::microseconds(200)};
  std::size_t piece_max = 0;  // 0: what was sent together arrives together; else in pieces of drawn sizes
  bool refuses = false;       // who connects is told that nobody listens
  bool swallows = false;      // who connects hears nothing
};

/// The sockets of one world: TCP as programs see it, without a kernel. Bytes arrive in their order, in whole
/// or in pieces, when the world's clock says so; connections end as TCP's do. The calls are those of the
/// system, with its results and its errno; a descriptor of this network is never one of the system.
/// `readable` and `writable` are told as epoll does with EPOLLET, by the numbers in their order.
class Network {
 public:
  explicit Network(VirtualClock& clock, std::uint64_t seed);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  static constexpr int kFirstDescriptor = 1 << 20;
  static Network* current();
  [[nodiscard]] static bool owns(int descriptor) { return descriptor >= kFirstDescriptor; }

  /// Connections to this port go over the cable between host and controller, which the next members are
  /// about; others stay on the daemon's machine. 0: all do.
  std::uint16_t cable_port = 0;
  NetworkConditions conditions;
  /// Called with bytes in the moment in which a program sends or reads them. `from_host`: who connected.
  std::function<void(bool from_host, bool sent, std::span<const std::uint8_t> bytes)> tap;
  std::function<void()> on_connection;  // of a host, that was taken
  std::function<void()> on_host_close;  // by the host, or told to it
  /// Both ends of every connection are told at once that it was reset.
  void cut();
  /// As with the cable pulled: from now on nothing of the present connections arrives.
  void half_open();
  /// What is under way arrives so much later, all behind it too.
  void hold_up(Time time);
  /// What the host sends from now on leaves it no more, to the controller or to its own clients: the process
  /// is dead.
  void silence_host() { host_is_dead_ = true; }
  void new_host() { host_is_dead_ = false; }
  /// What is due arrives. True when something did.
  bool deliver();
  [[nodiscard]] std::optional<Time> next_due() const;

  // What the programs call.
  int open_socket();
  int bind(int descriptor, std::uint16_t port);
  int listen(int descriptor);
  int connect(int descriptor, std::uint16_t port);
  int accept(int descriptor);
  int close(int descriptor);
  int shutdown_send(int descriptor);
  std::int64_t send(int descriptor, std::span<const std::uint8_t> bytes);
  std::int64_t receive(int descriptor, std::uint8_t* into, std::size_t size);
  [[nodiscard]] std::uint16_t port_of(int descriptor) const;
  [[nodiscard]] std::size_t available(int descriptor) const;
  int take_error(int descriptor);
  [[nodiscard]] std::uint32_t readiness(int descriptor) const;

  // An epoll. Descriptors of the system in it (Asio's interrupter) are told once whenever they are set.
  int open_epoll();
  int control(int epoll, int operation, int descriptor, const epoll_event* event);
  int collect(int epoll, epoll_event* events, int events_max);

 private:
  struct Socket;
  struct Watched {
    std::uint32_t interest = 0;
    std::uint64_t data = 0;
    bool is_told = false;  // since it was last set or became ready
  };
  struct Arrival {
    Time due{};
    std::vector<std::uint8_t> bytes;
    bool is_end = false;
    bool is_reset = false;
  };
  enum class Stage { kNew, kListening, kConnecting, kConnected, kBroken };

  [[nodiscard]] bool is_on_cable(std::uint16_t port) const { return cable_port == 0 || port == cable_port; }
  Socket* find(int descriptor) const;
  void schedule(Socket& to, Arrival arrival);
  void take(Socket& socket, Arrival arrival);
  void reset(Socket& socket);
  void wake(int descriptor);
  Time draw_gap();

  VirtualClock& clock_;
  std::mt19937_64 chance_;
  std::map<int, std::unique_ptr<Socket>> sockets_;
  std::map<int, std::map<int, Watched>> epolls_;
  int next_descriptor_ = kFirstDescriptor;
  bool host_is_dead_ = false;
};

}  // namespace simulation
