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

#include "service/acquisition/status.hpp"

namespace cell {

class CellOperation;

/// As many changes as a reader may miss and still get them one by one.
inline constexpr std::size_t kChangesKept = 1024;

/// The status as text, made once a change: what is asked for again costs a copy. It also keeps the last
/// kChangesKept changes for readers of the event streams.
class StatusFeed {
 public:
  struct Change {
    std::uint64_t sequence = 0;
    std::optional<std::int64_t> run_id;
    bool is_active = false;  // a run is under way
    std::string before_age;  // the document up to the age of its data, and behind it
    std::string behind_age;

    /// `age_ms`: of the data; nothing is null.
    [[nodiscard]] std::string document(std::optional<std::int64_t> age_ms) const;
  };

  /// `operation` must outlive the feed.
  explicit StatusFeed(CellOperation& operation);
  ~StatusFeed();
  StatusFeed(const StatusFeed&) = delete;
  StatusFeed& operator=(const StatusFeed&) = delete;

  /// Keeps all changes from now on, and tells them to `told`. One feed an operation.
  void follow(std::function<void(const Status&)> told);

  /// The status as it is.
  const Change& newest();
  [[nodiscard]] std::string document();
  /// A strong tag of the document, its age apart: "INSTANCE-SEQUENCE", in quotes.
  const std::string& etag();
  [[nodiscard]] const std::string& instance_id() const { return instance_id_; }

  /// The first change behind `sequence`; null when there is none yet.
  [[nodiscard]] const Change* next(std::uint64_t sequence) const;
  /// Every change behind `sequence` is still here.
  [[nodiscard]] bool remembers(std::uint64_t sequence) const;
  /// Returns when there is a change behind `sequence`, or after `wait`.
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
