#include "sim_controller/val3/program/signal_link.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace val3 {
namespace {

/// With a number behind them. Names of a fieldbus are the cell's, whatever they end with.
constexpr std::array<std::string_view, 3> kInputWords{"bIn", "fIn", "usrIn"};

/// Cards whose inputs have these names; without a card it is the controller's own.
bool has_controller_names(std::string_view card) {
  constexpr std::string_view kBasicCard = "BasicIO-";
  if (card.empty() || card == "FastIO" || card == "UserIO") return true;
  if (!card.starts_with(kBasicCard) || card.size() == kBasicCard.size()) return false;
  card.remove_prefix(kBasicCard.size());
  return std::ranges::all_of(card, [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

bool names_input(std::string_view link) {
  const std::size_t slash = link.rfind('\\');
  std::string_view name = slash == std::string_view::npos ? link : link.substr(slash + 1);
  if (name.starts_with("%I")) return true;
  if (slash == 0 || (slash != std::string_view::npos && !has_controller_names(link.substr(0, slash))))
    return false;
  if (name == "SECTEUR_OK") return true;
  while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name.remove_suffix(1);
  return std::ranges::find(kInputWords, name) != kInputWords.end();
}

}  // namespace val3
