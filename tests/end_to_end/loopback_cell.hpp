#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "service/acquisition/cell_operation.hpp"
#include "service/store/run_store.hpp"
#include "sim_controller/server.hpp"
#include "tests/end_to_end/folder.hpp"

namespace touchcal::testing {

/// A recipe with just enough touches, added to every LoopbackCell: 7 to fit and one held out on each of the
/// paper's planes.
inline constexpr const char* kShortRecipe = "short";
inline constexpr int kShortTouchCount = 4 * (7 + 1);

/// `quick` of a cell, planned from so few candidates that it takes a second: see LoopbackCell::use().
inline constexpr const char* kFewCandidates = "few candidates";

/// A daemon's CellOperation and the simulated controller on one io_context, over real sockets on loopback,
/// with a store in a folder of its own. Change `cell` before launch().
class LoopbackCell {
 public:
  explicit LoopbackCell(const std::string& cell_name = "edf");
  /// Shuts the operation down as the daemon does at a signal.
  ~LoopbackCell();

  /// Another cell with `kFewCandidates` among its recipes, which is returned to be changed; before serve().
  cell::Recipe& use(cell::Cell other, int candidate_count);

  /// The simulated controller with the cell's truth, instead of the one before, on the same port.
  void serve(std::vector<sim::PlannedFault> faults = {}, double speed = sim::kSpeedMax);
  void serve(sim::Plant plant, sim::ServerOptions options);
  void stop_serving() { server_.reset(); }
  /// A fault of the simulated cell, written as in a line of its control connection.
  void inject(const std::string& line);
  [[nodiscard]] sim::Plant true_plant() const;
  [[nodiscard]] sim::Server& server() { return *server_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// Ends the operation as the daemon does at a signal, and begins another on the same store.
  void relaunch();
  /// Begins the operation; `port` is where it looks for the controller, the server's own by default.
  void launch(std::optional<std::uint16_t> port = {});

  /// Carries bytes until the condition holds; std::runtime_error with the status after kPatience.
  void run_until(const std::function<bool(const cell::Status&)>& condition);
  void run_until(cell::State state);
  void run_until_touches(int count);
  /// Until the run has ended, one way or other, or waits for a person with a fault.
  void run_until_over();

  /// The id of the run that was started; std::runtime_error with the reason when it was refused.
  std::int64_t start(const std::string& recipe = kShortRecipe);
  /// What the operation answers.
  std::variant<cell::Started, cell::CommandRefusal> ask_to_start(const cell::StartRequest& request);
  /// std::runtime_error with the reason when it was refused.
  void command(cell::Command command);
  /// A run of the recipe from the start of everything until it is over, against this truth at full speed.
  void run_whole(const std::string& recipe, const cell::Truth& truth);
  /// From ABORTED to IDLE, as an operator goes: clear, then reset.
  void leave_aborted();
  [[nodiscard]] bool is_refused(cell::Command command);

  [[nodiscard]] cell::CellOperation& operation() { return *operation_; }
  [[nodiscard]] cell::Status status() const { return operation_->status(); }
  [[nodiscard]] std::string fault_name() const;  // empty without a fault
  [[nodiscard]] cell::RunStore& store() { return store_; }
  [[nodiscard]] std::filesystem::path store_file() const { return folder_ / "touchcal.sqlite"; }
  [[nodiscard]] boost::asio::io_context& io() { return io_; }

  cell::Cell cell;
  std::filesystem::path place_file;  // where the operation keeps the block's place; nowhere when empty

 private:
  void shut_down();

  Folder folder_;
  cell::RunStore store_;
  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  std::unique_ptr<sim::Server> server_;
  std::uint16_t port_ = 0;
  std::optional<cell::CellOperation> operation_;
  boost::asio::thread_pool computation_{1};  // ends before the operation
  boost::asio::thread_pool planner_{1};
};

}  // namespace touchcal::testing
