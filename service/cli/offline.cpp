#include "service/cli/offline.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "config/stiffness_choice.hpp"
#include "service/cli/commands.hpp"

namespace cell {

namespace {

const Recipe& recipe_named(const Cell& cell, const std::string& name) {
  const auto found = cell.recipes.find(name.empty() ? cell.default_recipe : name);
  if (found != cell.recipes.end()) return found->second;
  std::string known;
  for (const auto& [recipe, unused] : cell.recipes) known += (known.empty() ? "" : ", ") + recipe;
  throw ConfigError(cell.file.string(), "/recipes", "has no recipe " + in_quotes(name) + "; it has " + known);
}

}  // namespace

Cell given_cell(const CellArguments& given) {
  Cell cell = read_cell(given.file, stiffness_choice_named(given.stiffness));
  const auto& [celsius, std_k] = given.block_temperature;
  if (!celsius || !std_k) return cell;
  if (!cell.block.thermal_expansion_per_k) {
    throw ConfigError(cell.block.file.string(), "/thermal_expansion_per_k",
                      "is missing, without which a temperature says nothing of the block's size; add it, in "
                      "a file of schema touchcal/block/2");
  }
  // When the touches were made nobody says, so the temperature has no time and no age either.
  return with_block_temperature(cell, BlockTemperature{*celsius, *std_k, std::nullopt});
}

Recipe given_recipe(const Cell& cell, const CellArguments& given) {
  const Recipe& recipe = recipe_named(cell, given.recipe);
  if (given.stiffness.empty()) return recipe;
  return with_stiffness(recipe, stiffness_choice_named(given.stiffness).value(), cell);
}

ExitCode print_refusal(const std::filesystem::path& touches_file, const calib::IdentificationResult& result) {
  fmt::print(stderr, "{}: {}\n", touches_file.string(), result.message);
  switch (result.status) {
    case calib::IdentificationStatus::kBadInput:
    case calib::IdentificationStatus::kCoincidingPlanes:
    case calib::IdentificationStatus::kSingularPrior:
      return kExitBadInput;
    case calib::IdentificationStatus::kConverged:
    case calib::IdentificationStatus::kNotConverged:
    case calib::IdentificationStatus::kTooFewTouches:
    case calib::IdentificationStatus::kOneFace:
    case calib::IdentificationStatus::kOnePosture:
    case calib::IdentificationStatus::kUnobservable:
    case calib::IdentificationStatus::kFarTouch:
    case calib::IdentificationStatus::kContradictory:
      return kExitRefused;
  }
  return kExitRefused;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

void demand_writable(const std::vector<std::string>& files, bool overwrite) {
  if (std::ranges::count(files, "-") > 1)
    throw std::invalid_argument("standard output takes one file only; give the others names");
  for (const std::string& file : files) {
    if (file != "-" && !overwrite && std::filesystem::exists(file))
      throw std::invalid_argument(file + " exists; choose another name or give --force");
  }
}

void print_whole(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw std::system_error(errno, std::generic_category(), "standard output");
}

void write_whole_file(const std::string& file, const std::string& text, bool overwrite) {
  demand_writable({file}, overwrite);
  if (file == "-") return print_whole(text);
  const std::string unfinished = fmt::format("{}.{}.unfinished", file, getpid());
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw std::runtime_error(file + " cannot be written; check the folder and its permissions");
  }
}

std::vector<std::string> export_warnings(const std::vector<int>& cell_frames, bool accepted,
                                         const std::vector<std::string>& reasons) {
  std::vector<std::string> warnings;
  for (const int frame : cell_frames) {
    warnings.push_back(
        fmt::format("the cell's file gives frame {} itself: there it hides what was identified of it; take "
                    "\"frames\" out of the cell or correct it",
                    frame));
  }
  if (!accepted) {
    std::string why;
    for (const std::string& reason : reasons) why += (why.empty() ? ": " : "; ") + reason;
    warnings.push_back("this calibration was not accepted" + why);
  }
  return warnings;
}

}  // namespace cell
