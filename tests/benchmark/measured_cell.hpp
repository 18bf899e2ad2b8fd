#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "tests/benchmark/plain_http.hpp"
#include "tests/end_to_end/failing_calls.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/relay.hpp"

namespace bench {

using Clock = std::chrono::steady_clock;

inline double milliseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

/// The value that `share` of all stay under; 0 of none.
double percentile(std::vector<double> values, double share);

/// Prints "WHAT VALUE ms (at most LIMIT: met)" as one line; true when it is met.
bool tell(const std::string& what, double value_ms, double limit_ms);

/// A frame as it came out of the cable's end; State and Heartbeat are not kept.
struct SeenFrame {
  Clock::time_point at;
  cs8::Message message;
};

/// The cable between the daemon and the controller, on a thread of its own. It tells when each frame came.
class Wire {
 public:
  explicit Wire(std::uint16_t controller_port);
  ~Wire();
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  [[nodiscard]] std::uint16_t port() const { return relay_.port(); }
  /// All frames since the last call.
  std::vector<SeenFrame> take();
  /// Called for each frame that is kept: at once for those that take() would return, since the daemon greets
  /// the controller before anyone can watch; then on the wire's thread, before the frame is passed on.
  void on_frame(std::function<void(const SeenFrame&)> watch);
  /// How many Hello went over it: the links that the daemon made.
  [[nodiscard]] int links() const { return links_; }
  /// When the newest Stop came, as time since the clock's epoch, and how many there were.
  [[nodiscard]] std::pair<int, Clock::time_point> latest_stop();

 private:
  void watch(const cs8::Message& message);

  boost::asio::io_context io_{1};
  std::mutex mutex_;
  std::vector<SeenFrame> frames_;
  std::function<void(const SeenFrame&)> watch_;
  std::atomic<int> links_ = 0;
  int stops_ = 0;
  Clock::time_point stopped_at_;
  touchcal::testing::Relay relay_;
  std::thread thread_;
};

/// A daemon that says nothing for so long, or does not end, hangs; the end itself may wait 10 s for the disk.
inline constexpr std::chrono::seconds kDaemonPatience{60};

struct MeasuredCellOptions {
  std::string cell = "edf";
  int heartbeat_timeout_ms = 500;
  std::string speed = "max";
  bool noise = true;            // of the probe
  bool can_stall = false;       // the daemon's disk, by stall_disk()
  bool calls_can_fail = false;  // the daemon's, by calls(); not with `can_stall`
  nlohmann::json recipes;       // written beside the cell's own, an array of recipe documents
  std::vector<std::string> daemon_options = {};
};

/// cs8sim and touchcald as processes on a copy of a shipped cell, with a Wire in between, and a folder for
/// the daemon's state. Whatever goes wrong is std::runtime_error.
class MeasuredCell {
 public:
  explicit MeasuredCell(MeasuredCellOptions options);

  void start_daemon();
  /// False where it ended, or said something else, before it listened.
  bool try_to_start_daemon();
  [[nodiscard]] bool daemon_is_running() const { return daemon_ && daemon_->is_running(); }
  void signal_daemon(int number) const { daemon_->signal(number); }
  /// Waits for its end; std::runtime_error when there is none within `kDaemonPatience`.
  touchcal::testing::Finished wait_for_daemons_end() { return daemon_->wait(); }
  /// SIGKILL; returns when it is gone.
  void kill_daemon();
  /// SIGTERM; returns when it has ended.
  void end_daemon();

  [[nodiscard]] PlainAnswer get(const std::string& target) const;
  [[nodiscard]] PlainAnswer post(const std::string& target, const std::string& body = "") const;
  /// post() that has to be taken; its document.
  nlohmann::json command(const std::string& target, const std::string& body = "") const;
  [[nodiscard]] nlohmann::json status() const;
  /// Polls until the status is so; std::runtime_error with the last one after `patience`.
  nlohmann::json wait_until(const std::function<bool(const nlohmann::json&)>& condition,
                            std::chrono::seconds patience = std::chrono::seconds(300)) const;
  nlohmann::json wait_until_state(const std::string& state) const;
  /// A line of the simulator's control connection; std::runtime_error when it is refused.
  void inject(const std::string& line) const;
  /// The next fsync or fdatasync of the daemon takes a second. `can_stall` only.
  void stall_disk() const;
  /// Which call of the daemon fails. `calls_can_fail` only.
  [[nodiscard]] touchcal::testing::FailingCallsBlock& calls() const { return *calls_; }
  /// A stall was set off and no fsync came yet.
  [[nodiscard]] bool awaits_stall() const;

  [[nodiscard]] Wire& wire() { return *wire_; }
  [[nodiscard]] const DaemonAddress& address() const { return address_; }
  [[nodiscard]] std::filesystem::path state() const { return folder_ / "state"; }
  [[nodiscard]] std::string authorization() const;
  /// What the present daemon has logged.
  [[nodiscard]] std::string log() const;

 private:
  MeasuredCellOptions options_;
  touchcal::testing::Folder folder_;
  std::string cell_file_;
  std::optional<touchcal::testing::Process> controller_;
  std::uint16_t control_port_ = 0;
  touchcal::testing::FailingCallsBlock* calls_ = nullptr;  // mapped as long as the program lives
  std::unique_ptr<Wire> wire_;
  std::optional<touchcal::testing::Process> daemon_;
  DaemonAddress address_;
};

/// Waits without a busy loop: the files and sockets of other processes cannot be waited for.
void pause_ms(int milliseconds);

}  // namespace bench
