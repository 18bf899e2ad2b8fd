#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "service/base/latest_text.hpp"
#include "service/documents/status_document.hpp"
#include "service/run/status.hpp"
#include "service/store/sink_state.hpp"

namespace cell {

class CellOperation;

/// Number of changes that a client may miss and still receive one by one.
inline constexpr std::size_t kChangesKept = 1024;

/// The status document, written once per change, and the last kChangesKept changes for event streams. Of the
/// thread that serves; the operation publishes on its own and waits for nothing here. Changes that this
/// thread has not taken in wait in a queue of kChangesKept: when it is full the oldest is dropped, and a
/// stream that misses it begins again.
class StatusFeed {
 public:
  struct Change {
    std::uint64_t sequence = 0;
    std::optional<std::int64_t> run_id;
    bool is_active = false;   // a run is under way
    std::string before_live;  // the document before and after its LiveFields
    std::string behind_live;

    [[nodiscard]] std::string document(const LiveFields& live) const;
  };

  /// `operation` must outlive the feed.
  explicit StatusFeed(CellOperation& operation);
  ~StatusFeed();
  StatusFeed(const StatusFeed&) = delete;
  StatusFeed& operator=(const StatusFeed&) = delete;

  /// Records all changes from now on and passes them to `listener`. One feed per operation. Before the
  /// threads of both run; `executor`: of the thread that serves, which is woken by a change. Without one,
  /// whoever asks takes in what has changed.
  void follow(std::function<void(const Status&)> listener, boost::asio::any_io_executor executor = {});
  /// What the feed does at each change, on the thread of the operation: for who listens there in its place.
  void publish(const Status& status);

  /// These sinks are told with the status from now on, and each new status is put into `latest` for them.
  /// Before the threads run.
  void tell_sinks(std::shared_ptr<const SinkStates> sinks, std::shared_ptr<LatestText> latest);
  [[nodiscard]] const SinkStates& sinks() const { return *sinks_; }

  /// The status as it was published last.
  const Change& newest();
  /// The same as a value, with the age of its data and the sinks.
  [[nodiscard]] Status status();
  [[nodiscard]] std::string document();
  /// Of a change in the past, whose age of the data is not known.
  [[nodiscard]] std::string document(const Change& change) const;
  /// Strong entity tag of the document without its LiveFields: "INSTANCE-SEQUENCE", in quotes.
  const std::string& etag();
  [[nodiscard]] const std::string& instance_id() const { return instance_id_; }

  /// The first change after `sequence`; null if there is none yet.
  [[nodiscard]] const Change* next(std::uint64_t sequence) const;
  /// True if every change after `sequence` is still available.
  [[nodiscard]] bool remembers(std::uint64_t sequence) const;
  /// Returns when there is a change after `sequence`, after `wait`, or by wake().
  boost::asio::awaitable<void> wait(std::uint64_t sequence, std::chrono::milliseconds wait);
  /// Whoever waits looks again, as after a change.
  void wake();
  [[nodiscard]] std::size_t waiting_count() const { return waiting_.size(); }

 private:
  struct Published;
  void take_in();
  void keep(const Status& status);

  CellOperation& operation_;
  std::shared_ptr<Published> published_;  // what the operation has told and this thread has not taken in
  std::shared_ptr<const SinkStates> sinks_ = std::make_shared<SinkStates>();
  std::shared_ptr<LatestText> latest_;  // null: nobody takes it
  std::function<void(const Status&)> listener_;
  boost::asio::any_io_executor executor_;
  Status status_;
  std::string instance_id_;
  std::string etag_;
  std::deque<Change> changes_;  // never empty; the newest is the last
  std::list<boost::asio::steady_timer*> waiting_;
  bool following_ = false;
};

}  // namespace cell
