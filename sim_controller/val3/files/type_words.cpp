#include "sim_controller/val3/files/type_words.hpp"

#include <algorithm>

namespace val3 {

Type TypeWords::find(std::string_view word) const {
  // A project's own type comes first: the words of later versions may be names in earlier ones.
  if (const auto found = user.find(word); found != user.end()) return {Kind::kUser, found->second};
  return {kind_named(word), -1};
}

std::size_t ElementBudget::of(const Type& type, const std::vector<std::size_t>& of_user) {
  const auto user = static_cast<std::size_t>(type.user);
  return type.kind == Kind::kUser && type.user >= 0 && user < of_user.size() ? of_user[user] : 1;
}

std::size_t ElementBudget::of(const std::vector<std::size_t>& sizes, std::size_t each) {
  std::size_t result = std::max<std::size_t>(each, 1);
  for (const std::size_t size : sizes) {
    if (size != 0 && result > kElementsMax / size) return kElementsMax + 1;
    result *= size;
  }
  return result;
}

bool ElementBudget::take(std::size_t elements) {
  if (elements > left_) return false;
  left_ -= elements;
  return true;
}

}  // namespace val3
