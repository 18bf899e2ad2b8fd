// Arrays of any type (s7; size() since the first manual).
#include <algorithm>
#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"

namespace val3 {
namespace {

/// An array may not grow beyond this many elements.
constexpr std::size_t kElementsMax = 1'000'000;

void change_size(const Ref& place, std::size_t size) {
  if (place.field >= 0 || place.array->sizes.size() > 1)
    throw RunFailure(kErrorParameter, "only an array of one dimension changes its size");
  if (size > kElementsMax) throw RunFailure(kErrorRunMemory, "an array of more than a million elements");
  place.array->resize(size);
  place.array->sizes = {size};
}

double size_of(const Ref& place, double dimension) {
  const auto& sizes = place.array->sizes;
  if (!(dimension >= 1.0 && dimension <= static_cast<double>(std::max<std::size_t>(1, sizes.size()))))
    throw RunFailure(kErrorParameter, "a dimension that the array does not have");
  if (sizes.size() <= 1) return static_cast<double>(place.size());
  return static_cast<double>(sizes[static_cast<std::size_t>(dimension) - 1]);
}

Nothing resize(Context&, const Ref& place, double dimension, double size) {
  if (dimension != 1.0 || !(size >= 0.0)) throw RunFailure(kErrorParameter, "a dimension or a size");
  change_size(place, static_cast<std::size_t>(std::min(size, 1e9)));
  return {};
}

Nothing append(Context&, const Ref& place) {
  change_size(place, place.array->size() + 1);
  return {};
}

Nothing insert_element(Context&, const Ref& place) {
  ArrayBase& array = *place.array;
  change_size(place, array.size() + 1);
  const auto fresh = array.clone();
  fresh->clear();
  for (std::size_t i = array.size() - 1; i > place.index; --i) array.copy(i, array, i - 1);
  array.copy(place.index, *fresh, place.index);
  return {};
}

Nothing delete_element(Context&, const Ref& place) {
  ArrayBase& array = *place.array;
  if (place.index >= array.size()) throw RunFailure(kErrorIndex, "no element to delete");
  for (std::size_t i = place.index; i + 1 < array.size(); ++i) array.copy(i, array, i + 1);
  change_size(place, array.size() - 1);
  return {};
}

/// The keys of a collection in their order; "" behind the last one.
std::string first_key(Context&, const Ref& place) {
  const auto& keys = place.array->keys;
  return keys.empty() ? "" : keys.begin()->first;
}

std::string next_key(Context&, const Ref& place) {
  const auto& keys = place.array->keys;
  auto at = std::ranges::find_if(keys, [&](const auto& key) { return key.second == place.index; });
  if (at == keys.end() || ++at == keys.end()) return "";
  return at->first;
}

}  // namespace

void define_arrays(Builtins& list) {
  list.define<double, Ref>("size",
                           [](Context&, const Ref& place) { return static_cast<double>(place.size()); });
  list.define<double, Ref, double>(
      "size", [](Context&, const Ref& place, double dimension) { return size_of(place, dimension); });
  list.define<Nothing, Ref, double, double>("resize", resize);
  list.define<Nothing, Ref>("append", append);
  list.define<Nothing, Ref>("insert", insert_element);
  list.define<Nothing, Ref>("delete", delete_element);
  list.define<std::string, Ref>("first", first_key);
  list.define<std::string, Ref>("next", next_key);
}

}  // namespace val3
