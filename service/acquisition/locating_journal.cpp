#include "service/acquisition/locating_journal.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <utility>

#include "service/base/durable_file.hpp"

namespace cell {

namespace {

/// Why it failed; nothing of what leaves its thread is thrown.
std::optional<std::string> failure_of_reckoning(const std::function<void()>& reckon) {
  try {
    reckon();
    return std::nullopt;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

LocatingJournal::LocatingJournal(StoreQueue& store, boost::asio::any_io_executor operation,
                                 boost::asio::any_io_executor computation)
    : store_(store),
      operation_(std::move(operation)),
      computation_(std::move(computation)),
      patience_(operation_) {}

void LocatingJournal::keep_in(std::filesystem::path file, std::optional<std::string> config_digest) {
  file_ = std::move(file);
  config_digest_ = std::move(config_digest);
}

LocatingJournal::Left LocatingJournal::left(const std::optional<std::string>& from_place) const {
  Left left;
  if (file_.empty()) return left;
  try {
    left.record = read_locating(file_);
  } catch (const std::exception& damage) {
    left.why_not = damage.what();
  }
  if (!left.record) return left;
  if (left.record->config_digest != config_digest_) {
    left.why_not = "the cell's files have changed since";
  } else if (left.record->from_place != from_place) {
    left.why_not = "the place of the block has changed since";
  }
  return left;
}

void LocatingJournal::write(std::vector<LocatingTouch> touches, std::optional<std::string> from_place,
                            std::function<void()> reckon, Then then) {
  is_writing_ = true;
  patience_.expires_after(kWrittenPatience);
  const auto tell = [this, of = std::weak_ptr(dialogue_), then = std::move(then)](const auto& failure) {
    if (of.expired()) return;  // it is over, or the daemon is
    is_writing_ = false;
    then(failure);
    patience_.cancel();
  };
  const auto reckon_and_tell = [operation = operation_, reckon = std::move(reckon),
                                tell](std::optional<std::string> failure) {
    if (!failure) failure = failure_of_reckoning(reckon);
    boost::asio::post(operation, [tell, failure = std::move(failure)] { tell(failure); });
  };
  if (file_.empty()) {
    boost::asio::post(computation_, [reckon_and_tell] { reckon_and_tell(std::nullopt); });
    return;
  }
  const auto write = [file = file_, record = LocatingRecord{config_digest_, std::move(from_place),
                                                            std::move(touches)}](RunStore& store) {
    store.demand_in_place();
    if (record.touches.empty()) {
      remove_file(file);
    } else {
      write_locating(file, record);
    }
  };
  store_.write_then(write, computation_, reckon_and_tell);
}

boost::asio::awaitable<void> LocatingJournal::written() {
  if (!is_writing_) co_return;
  boost::system::error_code ignored;
  co_await patience_.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, ignored));
}

void LocatingJournal::forget(std::function<void(const std::string&)> on_failure) {
  dialogue_ = std::make_shared<int>();
  is_writing_ = false;
  patience_.cancel();
  if (file_.empty()) return;
  const auto remove = [file = file_](RunStore& store) {
    store.demand_in_place();
    remove_file(file);
  };
  store_.write_then(remove, operation_,
                    [of = std::weak_ptr(dialogue_), on_failure = std::move(on_failure)](const auto& failure) {
                      if (failure && !of.expired()) on_failure(*failure);
                    });
}

}  // namespace cell
