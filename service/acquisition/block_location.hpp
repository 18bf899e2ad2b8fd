#pragma once

#include <boost/asio/awaitable.hpp>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/hand_touch.hpp"
#include "service/acquisition/locating.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/base/clocks.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// The cell with its block where it was found last, as one value.
struct LocatedCell {
  Cell cell;
  std::optional<BlockPose> place;  // empty while the block is where the cell file says
};

/// Where the block stands: the dialogue that finds it by a person's touches (locating.hpp), the pass around
/// it that proves the place, the file that keeps it, and the cell with its block there. Whether it still
/// stands there is asked in each run: place_check.hpp.
class BlockLocation {
 public:
  /// All must outlive it; `configured` is the cell as its file has it.
  BlockLocation(const Cell& configured, StoreQueue& store, ControllerSession& session,
                PublishedStatus& status, Wake& wake, Clocks clocks);

  /// Sets the file of the block's pose; call it before the cell operates. A pose in the file is used, unless
  /// it is of another cell. Returns whether one is used. Throws when the file cannot be read.
  bool keep_in(const std::filesystem::path& file);

  /// The cell with its block at the last found pose. Always the same object.
  [[nodiscard]] const Cell& cell() const { return cell_; }
  /// The same as a value that does not change, for any thread.
  [[nodiscard]] std::shared_ptr<const LocatedCell> located_cell() const {
    const std::lock_guard lock(located_mutex_);
    return located_;
  }
  [[nodiscard]] const TipRegions& regions() const { return *regions_; }
  /// Empty while the block is where the cell file says.
  [[nodiscard]] const std::optional<BlockPose>& place() const { return place_; }

  /// Begins the dialogue; once the block is found, makes the pass ready: is_passing() is true then. The place
  /// counts for all runs that follow, also of later daemons.
  std::optional<CommandRefusal> locate();
  [[nodiscard]] bool is_locating() const { return locating_.has_value(); }
  [[nodiscard]] bool awaits_touch() const { return locating_ && !passing_; }
  [[nodiscard]] bool can_undo() const;
  /// Discards the last touch and asks for it again.
  void undo();
  /// Takes the arm's present position as the expected touch.
  std::optional<CommandRefusal> take();
  /// Watches for a touch by a person who jogs, while one is expected.
  void on_controller_state(const cs8::State& state);
  /// Ends the dialogue without a place.
  void leave();
  /// The instruction shown to the person; empty without a dialogue.
  [[nodiscard]] std::optional<HandGuide> guide() const;

  /// True from the time the pass is ready until it ends.
  [[nodiscard]] bool is_passing() const { return passing_; }
  /// Past every face at 30 mm, where any contact is a fault; then to the park posture. True when the block
  /// was found: its place is on the disk and used, and all that was planned before holds no more; a stop that
  /// came while it was written changes nothing of that. Else it is still to be found, or another state was
  /// entered.
  boost::asio::awaitable<bool> pass();

 private:
  std::optional<CommandRefusal> prepare_pass();
  boost::asio::awaitable<bool> go_around_block();
  std::optional<std::string> take_touch(const HandTouch& touch);
  boost::asio::awaitable<bool> keep_found_place();
  void use(BlockPose place);

  const Cell& configured_;
  StoreQueue& store_;
  ControllerSession& session_;
  PublishedStatus& status_;
  Wake& wake_;
  Clocks clocks_;
  Cell cell_;
  std::optional<TipRegions> regions_;  // of cell_
  std::optional<BlockPose> place_;
  mutable std::mutex located_mutex_;  // held for the exchange of a pointer
  std::shared_ptr<const LocatedCell> located_;
  std::filesystem::path file_;  // empty: nowhere
  std::optional<Locating> locating_;
  std::optional<HandTouchWatch> watch_;         // as long as the dialogue lasts
  std::vector<calib::JointVector> pass_stops_;  // once around the block
  bool passing_ = false;
};

}  // namespace cell
