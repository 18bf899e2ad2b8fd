#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What the words for types mean in one project: the language's, and those that its Types section lists.
struct TypeWords {
  std::map<std::string, int, std::less<>> user;  // index into Application::user_types
  /// kVoid for a word that means nothing.
  [[nodiscard]] Type find(std::string_view word) const;
};

/// Counts the elements of arrays while files are read: a file of few bytes can ask for any number of them.
class ElementBudget {
 public:
  explicit ElementBudget(std::size_t most) : left_(most) {}
  /// Elements of one value of a type. `of_user`: of each of the application's user types.
  static std::size_t of(const Type& type, const std::vector<std::size_t>& of_user);
  /// Of an array; never more than kElementsMax + 1.
  static std::size_t of(const std::vector<std::size_t>& sizes, std::size_t each);
  /// False when they are too many, for this array or together with those before it.
  bool take(std::size_t elements);

 private:
  std::size_t left_;
};

/// A controller's memory holds fewer (run-time error 40); this one's is not to be filled by a number in a
/// file.
inline constexpr std::size_t kElementsMax = 2'000'000;
/// Of the locals of one program.
inline constexpr std::size_t kLocalElementsMax = 100'000;

}  // namespace val3
