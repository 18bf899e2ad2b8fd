#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "service/acquisition/store_queue.hpp"
#include "service/documents/locating_file.hpp"

namespace cell {

/// The dialogue that finds the block, on the disk: how a touch by hand is kept before it counts, and what the
/// daemon before has left. It writes on the store's thread, one thing at a time. One thread, the operation's.
class LocatingJournal {
 public:
  using Then = std::function<void(std::optional<std::string>)>;
  /// Longest wait for a disk that does not answer: whoever waited is told then that it is being written.
  static constexpr std::chrono::seconds kWrittenPatience{2};

  /// `operation` is where it is told that something is written, `computation` where something is made of it.
  LocatingJournal(StoreQueue& store, boost::asio::any_io_executor operation,
                  boost::asio::any_io_executor computation);

  /// Sets the file, and the digest of the cell's files that its touches belong to. Until then nothing is
  /// kept.
  void keep_in(std::filesystem::path file, std::optional<std::string> config_digest);

  /// What the daemon before left, and why it does not count any more, where it does not; both empty without
  /// a dialogue. `from_place` is as LocatingRecord has it. Before the store's thread begins.
  struct Left {
    std::optional<LocatingRecord> record;
    std::optional<std::string> why_not;
  };
  [[nodiscard]] Left left(const std::optional<std::string>& from_place) const;

  /// Writes all touches of the dialogue, without any the file goes. `reckon` is called once they are on the
  /// disk, on the thread of the arithmetic: what it refers to must outlive that. Calls `then` with why either
  /// failed, with nothing when both are done. Not while it is writing, which lasts until then.
  void write(std::vector<LocatingTouch> touches, std::optional<std::string> from_place,
             std::function<void()> reckon, Then then);
  [[nodiscard]] bool is_writing() const { return is_writing_; }
  /// Returns when nothing is being written any more, at the latest kWrittenPatience after that began.
  boost::asio::awaitable<void> written();
  /// The dialogue is over: its file goes, and who waits for a write is not told of it. `on_failure` is called
  /// with why the file could not be removed: the next daemon would take its touches up again.
  void forget(std::function<void(const std::string&)> on_failure);

 private:
  StoreQueue& store_;
  boost::asio::any_io_executor operation_;
  boost::asio::any_io_executor computation_;
  boost::asio::steady_timer patience_;  // from the beginning of a write to its end
  std::filesystem::path file_;          // empty: nowhere
  std::optional<std::string> config_digest_;
  bool is_writing_ = false;
  std::shared_ptr<int> dialogue_ = std::make_shared<int>();  // a write that outlives it tells nobody
};

}  // namespace cell
