#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/setup/cell_files.hpp"
#include "service/setup/partial_answers.hpp"
#include "service/setup/setup_language.hpp"

namespace cell {

/// What a cell would be that is made of answers, before anything is written.
struct SetupCheck {
  PartialAnswers partial;
  std::vector<RefusedAnswer> refused;  // those of `partial`, and what all of them together are refused for
  /// Whether the daemon takes the files; nothing where that is not known here, as of an arm whose file is at
  /// the cell.
  std::optional<bool> passes;
  CellFiles files;        // none where something is refused
  std::string scene_svg;  // empty where the arm is not known here
  std::vector<std::string> remarks;
};

/// Where the parts of a cell are, and where its files may stand while they are read.
struct SetupPlaces {
  std::filesystem::path shipped_config;  // shipped_config_of()
  std::filesystem::path temporary;
};

/// Checks answers as touchcal setup does, but plans nothing. Of arms it takes the shipped ones only: whoever
/// asks names no file that is read. Bounded by the bounds of the answers: half a second where a park posture
/// has to be searched. ConfigError as read_partial_answers().
SetupCheck check_setup(const std::string& source, std::string_view text, const SetupPlaces& places,
                       const SetupLanguage& language);

}  // namespace cell
