#include "sim_controller/val3/machine/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace val3 {

Record& Record::operator=(const Record& other) {
  if (this == &other) return *this;
  if (fields.size() != other.fields.size()) {
    // a new element: fields of its own
    fields.clear();
    for (const auto& field : other.fields) fields.push_back(field->clone());
    return *this;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) fields[i]->assign(*other.fields[i]);
  return *this;
}

std::size_t Record::values() const {
  std::size_t all = 1;
  for (const auto& field : fields) all += std::max<std::size_t>(1, field->values());
  return all;
}

bool is_simulated(Kind kind) {
  return kind != Kind::kVoid && kind != Kind::kPointRs && kind != Kind::kConfigRs;
}

std::size_t flat_index(const ArrayBase& array, std::size_t offset, const double* indices, std::size_t count) {
  std::size_t flat = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double whole = std::trunc(indices[i]);  // the integer part is taken (manual 6, page 21)
    if (std::isnan(whole)) throw RunFailure(kErrorArgument, "an index that is no number");
    if (whole < 0) throw RunFailure(kErrorIndexNegative, "a negative index");
    const bool is_one = count == 1 || array.sizes.size() != count;
    const std::size_t size = is_one ? array.size() - std::min(offset, array.size()) : array.sizes[i];
    if (whole >= static_cast<double>(size)) {
      char index[32];  // it may be larger than any whole number of the machine
      std::snprintf(index, sizeof index, "%.12g", whole);
      throw RunFailure(kErrorIndex,
                       "index " + std::string(index) + " of " + std::to_string(size) + " elements");
    }
    flat = flat * size + static_cast<std::size_t>(whole);
  }
  return offset + flat;
}

}  // namespace val3
