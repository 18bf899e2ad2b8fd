#include "service/cli/nearest_word.hpp"

#include <algorithm>
#include <vector>

namespace cell {
namespace {

/// Optimal string alignment: the restricted distance of Damerau and Levenshtein.
std::size_t letters_apart(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> apart(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) apart[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) apart[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t wrong = a[i - 1] == b[j - 1] ? 0 : 1;
      apart[i][j] = std::min({apart[i - 1][j] + 1, apart[i][j - 1] + 1, apart[i - 1][j - 1] + wrong});
      const bool is_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swapped) apart[i][j] = std::min(apart[i][j], apart[i - 2][j - 2] + 1);
    }
  }
  return apart[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view typed, std::span<const std::string> words) {
  constexpr std::size_t kLettersMax = 40;  // of what is meant for a word
  if (words.empty() || typed.size() > kLettersMax) return std::nullopt;
  const auto nearest = std::ranges::min_element(
      words, {}, [&](const std::string& word) { return letters_apart(typed, word); });
  const bool is_meant = 3 * letters_apart(typed, *nearest) <= nearest->size();
  return is_meant ? std::optional(*nearest) : std::nullopt;
}

}  // namespace cell
