// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/way_back.hpp"

#include <spdlog/spdlog.h>

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

WayBack::WayBack(ControllerSession& session, PublishedStatus& status, Wake& wake)
    : session_(session), status_(status), wake_(wake) {}

void WayBack::on_entered(State state) {
  if (state == State::kResetting) return;
  is_asked_ = false;
  is_under_way_ = false;
}

asio::awaitable<void> WayBack::make() {
  is_asked_ = false;
  is_under_way_ = true;
  session_.end_permit();  // what was confirmed before is not this
  session_.forget_standing();
  const bool permitted = co_await session_.obtain_permit(0);  // it is no run
  if (permitted) {
    const auto clear = co_await session_.standing_joints();
    session_.give_permit_back();
    if (clear && status_.state() == State::kResetting) spdlog::info("the arm was taken back from the face");
  }
  if (!session_.connected()) co_await wake_.wait(20ms);  // its hook is about to report it
  if (status_.state() == State::kResetting) is_under_way_ = false;
}

}  // namespace cell
