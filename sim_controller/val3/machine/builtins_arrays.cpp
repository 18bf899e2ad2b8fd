// Arrays of any type (s7; size() since the first manual).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/libraries.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// An array may not grow beyond this many elements, those of a user's type with the values of their fields.
constexpr std::size_t kElementsMax = 1'000'000;

void demand_room(const ArrayBase& array, double elements) {
  if (elements > static_cast<double>(array.size()) &&
      elements * static_cast<double>(array.values_of_new()) > static_cast<double>(kElementsMax))
    throw RunFailure(kErrorRunMemory,
                     "an array of more than a million elements, or values of the fields of its elements");
}

void demand_one_dimension(const Ref& place) {
  if (place.field >= 0 || place.array->sizes.size() > 1)
    throw RunFailure(kErrorParameter, "only an array of one dimension changes its size");
}

void change_size(Context& context, const Ref& place, std::size_t size) {
  demand_one_dimension(place);
  ArrayBase& array = *place.array;
  demand_room(array, static_cast<double>(size));
  const std::size_t before = array.size();
  context.tasks.charge((std::max(size, before) - std::min(size, before)) * array.values_of_new());
  array.resize(size);
  array.sizes = {size};
}

double size_of(const Ref& place, double dimension) {
  const auto& sizes = place.array->sizes;
  if (!(dimension >= 1.0 && dimension <= static_cast<double>(std::max<std::size_t>(1, sizes.size()))))
    throw RunFailure(kErrorParameter, "a dimension that the array does not have");
  if (sizes.size() <= 1) return static_cast<double>(place.size());
  return static_cast<double>(sizes[static_cast<std::size_t>(dimension) - 1]);
}

/// Where the element at `index` of an array of sizes `from` is in one of sizes `to`; nothing beyond it.
std::optional<std::size_t> moved(std::size_t index, const std::vector<std::size_t>& from,
                                 const std::vector<std::size_t>& to) {
  std::size_t result = 0, stride = 1;
  for (std::size_t k = from.size(); k-- > 0;) {
    const std::size_t along = index % from[k];
    if (along >= to[k]) return std::nullopt;
    result += along * stride;
    stride *= to[k];
    index /= from[k];
  }
  return result;
}

/// One dimension of several: every element keeps its indices.
void change_dimension(Context& context, ArrayBase& array, std::size_t dimension, std::size_t size) {
  const std::vector<std::size_t> before = array.sizes;
  std::vector<std::size_t> now = before;
  now[dimension] = size;
  double count = 1.0;
  for (const std::size_t one : now) count *= static_cast<double>(one);
  demand_room(array, count);
  context.tasks.charge(array.values() + static_cast<std::size_t>(count) * array.values_of_new());
  const auto old = array.clone();
  array.resize(0);
  array.resize(static_cast<std::size_t>(count));
  array.sizes = now;
  for (std::size_t i = 0; i < old->size(); ++i)
    if (const auto to = moved(i, before, now)) array.copy(*to, *old, i);
}

Nothing resize(Context& context, const Ref& place, double dimension, double size) {
  const std::size_t dimensions = place.field >= 0 ? 1 : std::max<std::size_t>(1, place.array->sizes.size());
  if (!(dimension >= 1.0 && dimension <= static_cast<double>(dimensions)) ||
      dimension != std::floor(dimension) || !(size >= 0.0))
    throw RunFailure(kErrorParameter, "a dimension or a size");
  const auto elements = static_cast<std::size_t>(std::min(std::floor(size), 1e9));
  if (dimensions == 1) {
    change_size(context, place, elements);
  } else {
    change_dimension(context, *place.array, static_cast<std::size_t>(dimension) - 1, elements);
  }
  return {};
}

Nothing append(Context& context, const Ref& place) {
  change_size(context, place, place.array->size() + 1);
  return {};
}

Nothing insert_element(Context& context, const Ref& place) {
  ArrayBase& array = *place.array;
  change_size(context, place, array.size() + 1);
  context.tasks.charge(array.values());
  for (std::size_t i = array.size() - 1; i > place.index; --i) array.copy(i, array, i - 1);
  array.clear(std::min(place.index, array.size() - 1));
  return {};
}

Nothing delete_element(Context& context, const Ref& place) {
  demand_one_dimension(place);
  ArrayBase& array = *place.array;
  if (place.index >= array.size()) throw RunFailure(kErrorIndex, "no element to delete");
  context.tasks.charge(array.values());
  for (std::size_t i = place.index; i + 1 < array.size(); ++i) array.copy(i, array, i + 1);
  change_size(context, place, array.size() - 1);
  return {};
}

/// The keys of a collection in their order; "" behind the last one.
std::string first_key(Context&, const Ref& place) {
  const auto& keys = place.array->keys;
  return keys.empty() ? "" : keys.begin()->first;
}

std::string next_key(Context& context, const Ref& place) {
  const auto& keys = place.array->keys;
  context.tasks.charge(keys.size());
  auto at = std::ranges::find_if(keys, [&](const auto& key) { return key.second == place.index; });
  if (at == keys.end() || ++at == keys.end()) return "";
  return at->first;
}

/// What getData() gives instead of a number of elements (manual 6, page 32).
enum DataResult : int { kNoData = -1, kNoDataLibrary = -2, kNoDataIndex = -3, kOtherDataType = -4 };

/// "alias:name[i]" or "name[i]", split; the index is 0 where none is written.
struct DataName {
  std::string alias;
  std::string name;
  std::size_t index = 0;
  bool is_index = true;  // what stands in the brackets is one
};

DataName data_name(const std::string& text) {
  DataName result;
  std::string_view rest = text;
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    result.alias = rest.substr(0, colon);
    rest.remove_prefix(colon + 1);
  }
  const std::size_t open = rest.find('[');
  result.name = rest.substr(0, open);
  if (open == std::string_view::npos) return result;
  rest.remove_prefix(open + 1);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), result.index);
  result.is_index = error == std::errc{} && std::string_view(end, rest.data() + rest.size()) == "]";
  return result;
}

/// Copies as many elements of the variable with this name as both hold; how many.
double get_data(Context& context, const std::string& text, const Ref& into) {
  const DataName wanted = data_name(text);
  const Instance* owner = context.here->code->instance;
  if (!wanted.alias.empty()) {
    const int library = owner->application->library_named(wanted.alias);
    const LibrarySlot* slot = library < 0 ? nullptr : owner->slots[static_cast<std::size_t>(library)].get();
    if (slot == nullptr || slot->loaded == nullptr) return kNoDataLibrary;
    owner = slot->loaded->instance;
  }
  const int index = owner->application->global_named(wanted.name);
  const auto at = static_cast<std::size_t>(index);
  if (index < 0 || (!wanted.alias.empty() && !owner->application->globals[at].is_public)) return kNoData;
  const ArrayBase& from = *owner->globals[at];
  if (from.type().kind == Kind::kUser || from.type() != into.array->type() || into.field >= 0)
    return kOtherDataType;
  if (!wanted.is_index || wanted.index >= from.size()) return kNoDataIndex;
  const std::size_t count = std::min(from.size() - wanted.index, into.size());
  context.tasks.charge(count);
  for (std::size_t i = 0; i < count; ++i) into.array->copy(into.index + i, from, wanted.index + i);
  return static_cast<double>(count);
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
  list.define<double, std::string, Ref>("getData", get_data);
}

}  // namespace val3
