#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "service/acquisition/active_run.hpp"
#include "service/acquisition/block_location.hpp"
#include "service/run/tip_prediction.hpp"
#include "service/store/run_store.hpp"

namespace cell {

class CellOperation;

/// What documents are made of besides the status: stored runs, the cell as its block was located last, the
/// result of the run under way. Each thread has its own.
class Reads {
 public:
  /// On the thread of the operation: what it has itself. `operation` must outlive it.
  Reads(const CellOperation& operation);  // NOLINT(google-explicit-constructor): the same, to be read
  /// On another thread: a connection of its own to the file of the store, and copies.
  Reads(const CellOperation& operation, const std::filesystem::path& store_file);
  Reads(const Reads&) = delete;
  Reads& operator=(const Reads&) = delete;

  /// Takes the cell as it is located now; call it before a request. `live`: a copy of the run under way, if
  /// the request is about it.
  void update(std::shared_ptr<const ActiveRun> live = nullptr);

  [[nodiscard]] const RunStore& store() const { return store_; }
  [[nodiscard]] const Cell& cell() const { return located_->cell; }
  [[nodiscard]] const std::optional<BlockPose>& place() const { return located_->place; }
  /// What takes long on this thread looks at it in between: nobody waits for the answer any more.
  [[nodiscard]] bool is_ending() const { return ending_.stop_requested(); }
  void end_with(std::stop_token ending) { ending_ = std::move(ending); }
  /// By the clock of the operation.
  [[nodiscard]] std::chrono::system_clock::time_point now() const;
  [[nodiscard]] const TipRegions& tip_regions() const { return *regions_; }
  /// Of the cell's files at the daemon's start; it does not change.
  [[nodiscard]] const std::optional<std::string>& config_digest() const;
  /// The result document of this run if it is the one under way; nothing before there is a result.
  [[nodiscard]] std::optional<std::string> live_result(std::int64_t run_id) const;

 private:
  const CellOperation& operation_;
  std::unique_ptr<const RunStore> own_store_;  // null on the thread of the operation
  const RunStore& store_;
  std::shared_ptr<const LocatedCell> located_;
  std::optional<TipRegions> regions_;  // of located_
  std::shared_ptr<const ActiveRun> live_;
  std::stop_token ending_;
};

}  // namespace cell
