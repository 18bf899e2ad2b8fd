#include "service/http/routes/status_feed.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/json_view.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

StatusFeed::Change change_of(Status status) {
  status.data_age_ms.reset();
  status.sinks.clear();
  const std::string document = status_document(status), live = members_text(LiveFields{});
  const std::size_t place = document.find(live);
  if (place == document.npos) throw std::logic_error("the status document has no data age");
  return {.sequence = status.sequence,
          .run_id = status.run_id,
          .is_active = is_active(status.state),
          .before_live = document.substr(0, place),
          .behind_live = document.substr(place + live.size())};
}

}  // namespace

std::string StatusFeed::Change::document(const LiveFields& live) const {
  return before_live + members_text(live) + behind_live;
}

/// Written by the thread of the operation, read by the one that serves.
struct StatusFeed::Published {
  std::mutex mutex;  // held to add one or to take all
  std::deque<std::shared_ptr<const Status>> statuses;
  bool is_told = false;  // the serving thread has been woken and has not come yet

  /// True if the serving thread is to be woken.
  bool add(std::shared_ptr<const Status> status) {
    const std::lock_guard lock(mutex);
    statuses.push_back(std::move(status));
    if (statuses.size() > kChangesKept) statuses.pop_front();
    return !std::exchange(is_told, true);
  }
  std::deque<std::shared_ptr<const Status>> take() {
    const std::lock_guard lock(mutex);
    is_told = false;
    return std::exchange(statuses, {});
  }
};

StatusFeed::StatusFeed(CellOperation& operation)
    : operation_(operation), published_(std::make_shared<Published>()) {
  const Status status = operation.status();
  instance_id_ = status.instance_id;
  keep(status);
}

StatusFeed::~StatusFeed() {
  if (following_) operation_.on_change({});
}

void StatusFeed::follow(std::function<void(const Status&)> listener, asio::any_io_executor executor) {
  following_ = true;
  listener_ = std::move(listener);
  executor_ = std::move(executor);
  operation_.on_change([this](const Status& status) { publish(status); });
}

void StatusFeed::tell_sinks(std::shared_ptr<const SinkStates> sinks, std::shared_ptr<LatestText> latest) {
  sinks_ = std::move(sinks);
  latest_ = std::move(latest);
  latest_->put(document());
}

void StatusFeed::publish(const Status& status) {
  if (!published_->add(std::make_shared<const Status>(status)) || !executor_) return;
  asio::post(executor_, [this, alive = std::weak_ptr(published_)] {
    if (alive.lock()) take_in();
  });
}

/// A sequence that does not follow the one before: the queue was full, and nobody can go on across the gap.
void StatusFeed::take_in() {
  const auto statuses = published_->take();
  for (const std::shared_ptr<const Status>& status : statuses) {
    if (status->sequence != changes_.back().sequence + 1) changes_.clear();
    keep(*status);
    listener_(*status);
    if (latest_) latest_->put(status_document(*status));
  }
  if (!statuses.empty()) wake();
}

void StatusFeed::wake() {
  for (asio::steady_timer* timer : waiting_) timer->cancel();
}

void StatusFeed::keep(const Status& status) {
  status_ = status;
  changes_.push_back(change_of(status));
  if (changes_.size() > kChangesKept) changes_.pop_front();
  etag_ = fmt::format("\"{}-{}\"", instance_id_, status.sequence);
}

const StatusFeed::Change& StatusFeed::newest() {
  if (following_) {
    take_in();
  } else if (changes_.back().sequence != operation_.sequence()) {
    keep(operation_.status());
  }
  return changes_.back();
}

Status StatusFeed::status() {
  newest();
  Status status = status_;
  status.data_age_ms = operation_.data_age_ms();
  status.sinks = sinks_->all();
  return status;
}

std::string StatusFeed::document() {
  return newest().document(live_fields(operation_.data_age_ms(), sinks_->all()));
}

std::string StatusFeed::document(const Change& change) const {
  return change.document(live_fields({}, sinks_->all()));
}

const std::string& StatusFeed::etag() {
  newest();
  return etag_;
}

const StatusFeed::Change* StatusFeed::next(std::uint64_t sequence) const {
  const auto found = std::ranges::upper_bound(changes_, sequence, {}, &Change::sequence);
  return found == changes_.end() ? nullptr : &*found;
}

bool StatusFeed::remembers(std::uint64_t sequence) const {
  return sequence <= changes_.back().sequence && sequence + 1 >= changes_.front().sequence;
}

asio::awaitable<void> StatusFeed::wait(std::uint64_t sequence, std::chrono::milliseconds wait) {
  if (newest().sequence != sequence) co_return;
  asio::steady_timer timer(co_await asio::this_coro::executor, wait);
  waiting_.push_back(&timer);
  boost::system::error_code ignored;
  co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  waiting_.remove(&timer);
}

}  // namespace cell
