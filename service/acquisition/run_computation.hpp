#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <optional>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"

namespace cell {

/// The arithmetic of a run, on a thread of its own: a millisecond for a result, some tenths of a second for
/// the documents at the end, in which the operation's thread keeps the link and takes a stop. It works on
/// copies; what a copy gave counts in the run unless that has changed meanwhile (Run::take_latest()).
class RunComputation {
 public:
  /// `cell` must outlive the executor's work. A test gives its one executor.
  RunComputation(boost::asio::any_io_executor executor, const Cell& cell)
      : executor_(std::move(executor)), cell_(cell) {}

  /// The same run with the result of all its touches.
  boost::asio::awaitable<Run> identified(Run run);
  /// What the run is worth, see conclude(); without an outcome only its documents.
  boost::asio::awaitable<Conclusion> conclude(ActiveRun active, std::optional<RunOutcome> outcome);

 private:
  boost::asio::any_io_executor executor_;
  const Cell& cell_;
};

}  // namespace cell
