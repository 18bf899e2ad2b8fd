#include "service/acquisition/wake.hpp"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace cell {

namespace asio = boost::asio;

asio::awaitable<void> TimerWake::wait(std::chrono::milliseconds at_most) {
  timer_.expires_after(at_most);
  boost::system::error_code ignored;
  co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
}

}  // namespace cell
