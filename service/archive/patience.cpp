#include "service/archive/internal/patience.hpp"

#include <sys/socket.h>

#include <condition_variable>
#include <mutex>
#include <utility>

namespace cell {

Patience::Patience(const pqxx::connection_base& connection, std::chrono::milliseconds time,
                   std::stop_token ending)
    : socket_(connection.sock()),
      at_ending_(std::move(ending), [this] { ::shutdown(socket_, SHUT_RDWR); }),
      thread_([this, time](const std::stop_token& done) {
        std::mutex mutex;
        std::condition_variable_any woken;
        std::unique_lock lock(mutex);
        woken.wait_for(lock, done, time, [] { return false; });
        if (done.stop_requested()) return;
        is_over_ = true;
        ::shutdown(socket_, SHUT_RDWR);
      }) {}

}  // namespace cell
