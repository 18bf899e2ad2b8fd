#include "sim_controller/val3/program/signal_link.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace val3 {
namespace {

/// With a number behind them. Names of a fieldbus are the cell's, whatever they end with.
constexpr std::array<std::string_view, 3> kInputWords{"bIn", "fIn", "usrIn"};

}  // namespace

bool names_input(std::string_view link) {
  const std::size_t slash = link.rfind('\\');
  std::string_view name = slash == std::string_view::npos ? link : link.substr(slash + 1);
  if (name.starts_with("%I") || name == "SECTEUR_OK") return true;
  while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name.remove_suffix(1);
  return std::ranges::find(kInputWords, name) != kInputWords.end();
}

}  // namespace val3
