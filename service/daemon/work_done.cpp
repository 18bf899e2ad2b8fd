#include "service/daemon/work_done.hpp"

namespace cell {

WorkDone::~WorkDone() {
  watch_.begin(patience_, give_up_());
  disk_.join();  // first: nobody hears of what is computed any more
  arithmetic_.join();
}

}  // namespace cell
