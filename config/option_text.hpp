#pragma once

#include <string>

namespace cell {

/// An option that is given with an empty text, as from a variable that is not set, is not taken for one that
/// was left out. Returns what is wrong and the remedy, or nothing: what a validator of CLI11 returns.
inline std::string refuse_empty(const std::string& text) {
  return text.empty() ? "is empty; give it a value, or leave it out for the default" : "";
}

}  // namespace cell
