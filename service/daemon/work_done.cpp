#include "service/daemon/work_done.hpp"

namespace cell {

WorkDone::~WorkDone() {
  watch_.begin(patience_, give_up_());
  for (boost::asio::thread_pool* thread : threads_) thread->join();
}

}  // namespace cell
