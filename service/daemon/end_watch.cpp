#include "service/daemon/end_watch.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

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
  std::string why = fmt::format("the disk has not answered for {}", patience);
  signals_->async_wait([&](const boost::system::error_code& failure, int signal) {
    if (failure) return;
    why = fmt::format("signal {} while the disk does not answer", signal);
    context_.stop();
  });
  context_.run_for(patience);
  if (!came_in_time_) give_up(why);
}

}  // namespace cell
