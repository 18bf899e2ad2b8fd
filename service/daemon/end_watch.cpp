#include "service/daemon/end_watch.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <csignal>

namespace cell {

EndWatch::~EndWatch() {
  if (!thread_.joinable()) return;
  boost::asio::post(context_, [this] {
    came_in_time_ = true;
    context_.stop();
  });
  thread_.join();
}

void EndWatch::begin(std::chrono::milliseconds patience, GiveUp give_up) {
  signals_.emplace(context_, SIGINT, SIGTERM, SIGHUP);  // here: none is missed from now on
  thread_ = std::thread([this, patience, give_up = std::move(give_up)] { watch(patience, give_up); });
}

void EndWatch::watch(std::chrono::milliseconds patience, const GiveUp& give_up) {
  std::string why = fmt::format(
      "the end has not come within {}: the disk does not answer, or a "
      "computation does not end",
      patience);
  bool is_hurried = false;
  signals_->async_wait([&](const boost::system::error_code& failure, int signal) {
    if (failure) return;
    is_hurried = true;
    why = fmt::format("signal {} while the end waits for the disk or a computation", signal);
    context_.stop();
  });
  context_.run_for(patience);
  if (is_hurried && !came_in_time_) {  // one that answers is waited for all the same
    context_.restart();
    context_.run_for(std::min(patience, kHurriedPatience));
  }
  if (!came_in_time_) give_up(why);
}

}  // namespace cell
