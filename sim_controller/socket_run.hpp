#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "sim_controller/run_socket.hpp"
#include "sim_controller/scripted_run.hpp"
#include "sim_controller/val3_socket.hpp"

namespace sim {

/// A name that is no TCP socket of the application, that comes twice, or whose peer the script plays itself.
/// Says which, and the remedy.
class WrongSocket : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run whose application talks by real sockets: simulated time goes with the wall clock, faster only while
/// the arm moves.
class SocketRun {
 public:
  /// The run is started and outlives this. WrongSocket, SocketRefusal.
  SocketRun(ScriptedRun& run, std::span<const RunSocket> wanted, std::span<const ScriptStep> steps);

  /// To the end of the run, to `until_s` of simulated time, or to SIGINT or SIGTERM. What the application
  /// wrote before has gone out then. `speed`: as Val3Pace takes it. SocketRefusal when a port has been taken
  /// since.
  void run(double until_s, double speed);

 private:
  void add(const RunSocket& wanted, std::span<const ScriptStep> steps);
  void exchange();
  void tell_overruled(std::size_t socket);
  void end_connections();

  ScriptedRun& run_;
  boost::asio::io_context io_;
  /// Without it the io_context would not wait when no handler is left.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> waits_ =
      boost::asio::make_work_guard(io_);
  boost::asio::signal_set signals_{io_, SIGINT, SIGTERM};
  std::vector<std::unique_ptr<Val3Socket>> sockets_;
  std::vector<int> channels_;  // of the sockets
  std::set<int> overruled_;    // channels whose sioCtrl was told to change nothing
  bool is_stopped_ = false;    // by a signal
};

}  // namespace sim
