#include "tests/simulation/script.hpp"

namespace simulation {

void Script::see(std::string_view sight) {
  if (is_due_ || at_ == steps_.size() || steps_[at_].sight != sight) return;
  is_due_ = at_ + 1 == steps_.size() || !steps_[at_].then.empty();
  ++at_;
}

const std::vector<DrawnFault>* Script::take_due() {
  if (!is_due_) return nullptr;
  is_due_ = false;
  return &steps_[at_ - 1].then;
}

}  // namespace simulation
