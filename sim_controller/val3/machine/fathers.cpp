#include "sim_controller/val3/machine/fathers.hpp"

#include "sim_controller/val3/machine/geometry.hpp"
#include "sim_controller/val3/machine/run_error.hpp"

namespace val3 {
namespace {

/// Frames deeper than this are taken for a ring of fathers.
constexpr int kFathersMax = 64;

}  // namespace

Fathers::Fathers()
    : world_(std::make_unique<Array<Frame>>(Type{Kind::kFrame, -1}, 1)),
      flange_(std::make_unique<Array<Tool>>(Type{Kind::kTool, -1}, 1)),
      arrays_{{kWorldArray, {world_.get()}}, {kFlangeArray, {flange_.get()}}} {}

int Fathers::add(ArrayBase& array) { return add(array, false); }

int Fathers::add(ArrayBase& array, bool is_local) {
  arrays_.emplace(next_, Known{&array, is_local});
  return next_++;
}

const ArrayBase* Fathers::find(const Father& father) const {
  const auto found = arrays_.find(father.array);
  return found == arrays_.end() || father.element >= found->second.array->size() ? nullptr
                                                                                 : found->second.array;
}

void Fathers::demand_alive(const Father& father) const {
  if (father.array > kFlangeArray && father.array < next_ && !arrays_.contains(father.array))
    throw RunFailure(kErrorLinkedToLocal, "its father was a local variable of a call that is over");
}

void Fathers::demand_link(const Ref& place, const Father& father) const {
  const auto found = arrays_.find(father.array);
  if (place.array->is_global && found != arrays_.end() && found->second.is_local)
    throw RunFailure(kErrorLinkedToLocal, "a global variable would be linked to a local one");
}

Trsf Fathers::frame_in_world(const Father& father) const {
  if (world_->size() != 1 || !(world_->elements[0] == Frame{}))
    throw RunFailure(kErrorWorldChanged, "the frame world was changed");
  Trsf result;
  Father at = father;
  for (int depth = 0; at.array != kWorldArray; ++depth) {
    demand_alive(at);
    const ArrayBase* array = find(at);
    if (array == nullptr || array->type().kind != Kind::kFrame || depth > kFathersMax)
      throw depth == 0 ? RunFailure(kErrorPointWithoutFrame, "a point without its frame")
                       : RunFailure(kErrorFrameWithoutFather, "a frame without its father");
    const Frame& frame = static_cast<const Array<Frame>*>(array)->elements[at.element];
    result = depth == 0 ? frame.trsf : composed(frame.trsf, result);
    at = frame.father;
  }
  return result;
}

Trsf Fathers::flange_from(const Tool& tool) const {
  if (flange_->size() != 1 || !(flange_->elements[0] == Tool{}))
    throw RunFailure(kErrorFlangeChanged, "the tool flange was changed");
  Trsf result = tool.trsf;
  Father at = tool.father;
  for (int depth = 0; at.array != kFlangeArray; ++depth) {
    demand_alive(at);
    const ArrayBase* array = find(at);
    if (array == nullptr || array->type().kind != Kind::kTool || depth > kFathersMax)
      throw RunFailure(kErrorToolWithoutFather, "a tool without its father");
    const Tool& father = static_cast<const Array<Tool>*>(array)->elements[at.element];
    result = composed(father.trsf, result);
    at = father.father;
  }
  return result;
}

Father Fathers::father_of(const Ref& place) const {
  for (const auto& [id, known] : arrays_)
    if (known.array == place.array) return {id, place.index};
  return {};
}

void CallFathers::add(Fathers& fathers, ArrayBase& array) {
  fathers_ = &fathers;
  numbers_.push_back(fathers.add(array, true));
}

void CallFathers::give_back() {
  for (const int number : numbers_) fathers_->arrays_.erase(number);
  numbers_.clear();
}

}  // namespace val3
