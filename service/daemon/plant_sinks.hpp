#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "service/base/clocks.hpp"
#include "service/base/latest_text.hpp"
#include "service/plant/sink_thread.hpp"
#include "service/store/run_store.hpp"

namespace cell {

struct DaemonOptions;

/// The names of the sinks that are configured.
std::vector<std::string> configured_sinks(const DaemonOptions& options);

/// Those who hear of the cell's facts, each on a thread of its own. What they confirm is written on `disk`.
class PlantSinks {
 public:
  /// `store` must outlive the work of `disk`.
  PlantSinks(const RunStore& store, boost::asio::any_io_executor disk);

  /// The threads of those that are configured run from now on. `instance`: count of the daemon's starts.
  void begin(const DaemonOptions& options, const std::string& cell, std::int64_t instance,
             const Clocks& clocks);

  [[nodiscard]] std::shared_ptr<const SinkStates> states() const { return states_; }
  /// Where the cell's status is put for them.
  [[nodiscard]] const std::shared_ptr<LatestText>& status() const { return status_; }

 private:
  void add(const std::string& name, std::function<std::unique_ptr<Sink>(const std::stop_token&)> connect,
           std::chrono::seconds may_lose, const Clocks& clocks);

  const RunStore& store_;
  boost::asio::any_io_executor disk_;
  std::shared_ptr<SinkStates> states_ = std::make_shared<SinkStates>();
  std::shared_ptr<LatestText> status_ = std::make_shared<LatestText>();
  std::list<SinkThread> threads_;
};

}  // namespace cell
