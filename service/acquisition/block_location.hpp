#pragma once

#include <boost/asio/any_io_executor.hpp>
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
#include "service/acquisition/locating_journal.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touched_block.hpp"
#include "service/base/clocks.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// The cell with its block where it was found last, as one value.
struct LocatedCell {
  Cell cell;
  std::optional<BlockPose> place;  // empty while the block is where the cell file says
  TipRegions::Shared regions;      // of this cell
};

/// Where the block stands: the dialogue that finds it by a person's touches (locating.hpp), of which each is
/// on the disk before it counts (locating_journal.hpp), the pass around it that proves the place, the file
/// that keeps it, and the cell with its block there. Whether it still stands there is asked in each run:
/// place_check.hpp.
class BlockLocation {
 public:
  /// All must outlive it; `operation` is the executor that it is used on, `computation` that of the place
  /// and of the pass around it, `configured` the cell as its file has it.
  BlockLocation(boost::asio::any_io_executor operation, boost::asio::any_io_executor computation,
                const Cell& configured, StoreQueue& store, ControllerSession& session,
                PublishedStatus& status, Wake& wake, Clocks clocks);

  /// Sets the file of the block's pose; call it before the cell operates. A pose in the file is used, unless
  /// it is of another cell. Returns whether one is used. Throws when the file cannot be read.
  bool keep_in(const std::filesystem::path& file);
  /// Sets the file of the dialogue's touches, behind keep_in(), and takes up the dialogue that the daemon
  /// before left there. Its touches count where the cell's files (`config_digest`) and the place before are
  /// those that they were made with, else it begins anew; the guide says which.
  void keep_dialogue_in(const std::filesystem::path& file, const std::optional<std::string>& config_digest);

  /// Tip regions that were computed before for the cell as its file has it: they are not computed again.
  void hand_in(TipRegions::Shared made);

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

  /// Begins the dialogue; once the block is found, asks for the pass: is_passing() is true then. Refused
  /// where there is no pass, before anything is changed. The place counts for all runs that follow, also of
  /// later daemons.
  std::optional<CommandRefusal> locate();
  [[nodiscard]] bool is_locating() const { return dialogue_.has_value(); }
  [[nodiscard]] bool awaits_touch() const { return dialogue_ && !passing_; }
  /// A touch, or one less, is on its way to the disk, or its place is computed; until both are done nothing
  /// else is taken.
  [[nodiscard]] bool is_storing() const { return journal_.is_writing(); }
  /// Returns when it is there, or cannot be; after a while also when the disk does not answer.
  boost::asio::awaitable<void> stored() { return journal_.written(); }
  /// Why nothing is done with the touches until then; nothing when all are on the disk.
  [[nodiscard]] std::optional<CommandRefusal> refusal_while_storing() const;
  [[nodiscard]] bool can_undo() const;
  /// Discards the last touch and asks for it again, once that is stored.
  void undo();
  /// Takes the arm's present position as the expected touch; it counts once it is stored.
  std::optional<CommandRefusal> take();
  /// Watches for a touch by a person who jogs, while one is expected.
  void on_controller_state(const cs8::State& state);
  /// Ends the dialogue without a place.
  void leave();
  /// The instruction shown to the person; empty without a dialogue.
  [[nodiscard]] std::optional<HandGuide> guide() const;

  /// True from the time the pass is asked for until it ends.
  [[nodiscard]] bool is_passing() const { return passing_; }
  /// Past every face at 30 mm, where any contact is a fault; then to the park posture. True when the block
  /// was found: its place is on the disk and used, and all that was planned before holds no more; a stop that
  /// came while it was written changes nothing of that. Else it is still to be found, or another state was
  /// entered.
  boost::asio::awaitable<bool> pass();

 private:
  /// What a person has touched so far.
  struct Dialogue {
    explicit Dialogue(const Cell& cell) : block{Locating(cell), std::nullopt}, watch(cell.arm.model) {}
    TouchedBlock block;
    HandTouchWatch watch;
    std::vector<LocatingTouch> made;  // those of `block`, as they are stored
    std::string note;  // what has become of touches of the daemon before, in front of the words
  };

  std::optional<CommandRefusal> prepare_pass();
  void take_up(const LocatingJournal::Left& left);
  void keep_touch(TouchedBlock touched, const LocatingTouch& made, const std::optional<std::string>& failure);
  void forget_touches();
  [[nodiscard]] std::optional<std::string> place_before() const;
  boost::asio::awaitable<bool> go_around_block();
  std::optional<std::string> take_touch(const HandTouch& touch);
  boost::asio::awaitable<bool> keep_found_place();
  void use(BlockPose place);
  void publish_cell();

  boost::asio::any_io_executor computation_;
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
  LocatingJournal journal_;
  std::optional<Dialogue> dialogue_;
  bool passing_ = false;
};

}  // namespace cell
