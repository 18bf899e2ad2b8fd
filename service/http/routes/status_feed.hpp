#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <optional>
#include <string>

#include "service/run/status.hpp"

namespace cell {

class CellOperation;

/// Number of changes that a client may miss and still receive one by one.
inline constexpr std::size_t kChangesKept = 1024;

/// The status document, written once per change, and the last kChangesKept changes for event streams.
class StatusFeed {
 public:
  struct Change {
    std::uint64_t sequence = 0;
    std::optional<std::int64_t> run_id;
    bool is_active = false;  // a run is under way
    std::string before_age;  // the document before and after the age of its data
    std::string behind_age;

    /// `age_ms`: of the data; nothing is null.
    [[nodiscard]] std::string document(std::optional<std::int64_t> age_ms) const;
  };

  /// `operation` must outlive the feed.
  explicit StatusFeed(CellOperation& operation);
  ~StatusFeed();
  StatusFeed(const StatusFeed&) = delete;
  StatusFeed& operator=(const StatusFeed&) = delete;

  /// Records all changes from now on and passes them to `listener`. One feed per operation.
  void follow(std::function<void(const Status&)> listener);

  /// The status as it is.
  const Change& newest();
  [[nodiscard]] std::string document();
  /// Strong entity tag of the document without its age: "INSTANCE-SEQUENCE", in quotes.
  const std::string& etag();
  [[nodiscard]] const std::string& instance_id() const { return instance_id_; }

  /// The first change after `sequence`; null if there is none yet.
  [[nodiscard]] const Change* next(std::uint64_t sequence) const;
  /// True if every change after `sequence` is still available.
  [[nodiscard]] bool remembers(std::uint64_t sequence) const;
  /// Returns when there is a change after `sequence`, or after `wait`.
  boost::asio::awaitable<void> wait(std::uint64_t sequence, std::chrono::milliseconds wait);
  [[nodiscard]] std::size_t waiting_count() const { return waiting_.size(); }

 private:
  void keep(const Status& status);

  CellOperation& operation_;
  std::string instance_id_;
  std::string etag_;
  std::deque<Change> changes_;  // never empty; the newest is the last
  std::list<boost::asio::steady_timer*> waiting_;
  bool following_ = false;
};

}  // namespace cell
