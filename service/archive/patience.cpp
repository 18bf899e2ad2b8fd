#include "service/archive/internal/patience.hpp"

#include <sys/socket.h>

#include <utility>

namespace cell {

Patience::Patience(const pqxx::connection_base& connection, std::chrono::milliseconds time,
                   std::stop_token ending)
    : socket_(connection.sock()),
      at_ending_(std::move(ending), [this] { ::shutdown(socket_, SHUT_RDWR); }),
      thread_([this, time](const std::stop_token& done) {
        std::unique_lock lock(mutex_);
        for (int seen = answers_;; seen = answers_)
          if (!woken_.wait_for(lock, done, time, [&] { return answers_ != seen; })) break;
        if (done.stop_requested()) return;
        is_over_ = true;
        ::shutdown(socket_, SHUT_RDWR);
      }) {}

void Patience::answered() {
  const std::lock_guard lock(mutex_);
  ++answers_;
  woken_.notify_one();
}

}  // namespace cell
