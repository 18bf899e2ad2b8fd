#pragma once

#include <boost/asio/awaitable.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/acquisition/clocks.hpp"
#include "service/acquisition/command_refusal.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/hand_touch.hpp"
#include "service/acquisition/locating.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// Where the block stands: the dialogue that finds it by a person's touches (locating.hpp), the pass around
/// it that proves the place, the file that keeps it, and the cell with its block there. Whether it still
/// stands there is asked in each run: place_check.hpp.
class BlockLocation {
 public:
  /// All must outlive it; `configured` is the cell as its file has it.
  BlockLocation(const Cell& configured, ControllerSession& session, PublishedStatus& status, Wake& wake,
                Clocks clocks);

  /// Where the place is kept; to be told before the cell operates. One that is there is used, unless it is of
  /// another cell. True when it is used. Throws what cannot be read.
  bool keep_in(const std::filesystem::path& file);

  /// With its block where it was found last. The same object for good.
  [[nodiscard]] const Cell& cell() const { return cell_; }
  [[nodiscard]] const TipRegions& regions() const { return *regions_; }
  /// Nothing as long as the block stands where the cell's file says.
  [[nodiscard]] const std::optional<BlockPose>& place() const { return place_; }

  /// Begins the dialogue; once the block is found, makes the pass ready: is_passing() is true then. The place
  /// counts for all runs that follow, also of later daemons.
  std::optional<CommandRefusal> locate();
  [[nodiscard]] bool is_locating() const { return locating_.has_value(); }
  [[nodiscard]] bool awaits_touch() const { return locating_ && !passing_; }
  [[nodiscard]] bool can_undo() const;
  /// The last touch is forgotten and asked for again.
  void undo();
  /// Takes where the arm stands as the touch that is awaited.
  std::optional<CommandRefusal> take();
  /// A touch of a person who jogs, where one is awaited.
  void on_controller_state(const cs8::State& state);
  /// Ends the dialogue without a place.
  void leave();
  /// What the person is told; nothing without a dialogue.
  [[nodiscard]] std::optional<HandGuide> guide() const;

  /// The arm is to go, or goes, around the block.
  [[nodiscard]] bool is_passing() const { return passing_; }
  /// Past every face at 30 mm, where any contact is a fault; then to the park posture. True when the block
  /// was found: its place is kept and used, and all that was planned before holds no more. Else it is still
  /// to be found, or another state was entered.
  boost::asio::awaitable<bool> pass();

 private:
  std::optional<CommandRefusal> prepare_pass();
  boost::asio::awaitable<bool> go_around_block();
  std::optional<std::string> take_touch(const HandTouch& touch);
  bool keep_found_place();
  void use(BlockPose place);

  const Cell& configured_;
  ControllerSession& session_;
  PublishedStatus& status_;
  Wake& wake_;
  Clocks clocks_;
  Cell cell_;
  std::optional<TipRegions> regions_;  // of cell_
  std::optional<BlockPose> place_;
  std::filesystem::path file_;  // empty: nowhere
  std::optional<Locating> locating_;
  std::optional<HandTouchWatch> watch_;         // as long as the dialogue lasts
  std::vector<calib::JointVector> pass_stops_;  // once around the block
  bool passing_ = false;
};

}  // namespace cell
