#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/cli/api_client.hpp"
#include "service/documents/check_warmth.hpp"
#include "service/documents/touched_tool.hpp"

namespace cell {

/// The calibrated arm that is applied to targets, and where it is from.
struct AppliedArm {
  std::string source;  // for messages: the file, or the model and its daemon
  Arm arm;
  std::string hash;                             // of the model, or of the file: arm_digest()
  std::optional<CheckWarmth> warmth = {};       // with which the arm was grown()
  std::string of_run = {};                      // the calibration; empty of a file, which names none
  std::optional<std::string> serial = {};       // of the very robot; nothing where none was known
  std::optional<std::string> valid_until = {};  // RFC 3339; nothing: no end was set, or a file
  std::string remark = {};                      // what its user should know of the model; empty: nothing
  std::vector<TouchedTool> touched = {};        // in place of their drawings

  /// The tool of this name as it was touched; null: as drawn.
  [[nodiscard]] const TouchedTool* touched_as(const std::string& tool) const;
};

/// Why no approved model is applied: what the daemon answers, or what is wrong with the model.
struct ModelRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
  explicit ModelRefused(const ApiReply& reply);
};

/// Throws ConfigError where the file is no arm.
AppliedArm arm_of_file(const std::filesystem::path& file);

/// The arm of a model that was approved, as the daemon has stored it. `model`: "current", the id of the
/// approval, or the model's hash or its beginning, 12 digits at least, as touchcal models shows them. Throws
/// ModelRefused where there is no such model or it is not valid any more at `now`, DaemonUnreachable.
/// `check`: the run of a check of that calibration, whose growth of the arm is applied too; none where it is
/// empty. ModelRefused where that does not count, std::invalid_argument where there is no such run.
AppliedArm arm_of_model(const ApiClient& daemon, const std::string& model, const std::string& check,
                        std::chrono::system_clock::time_point now);

/// What the user should know of the arm, a sentence each: of a file that does not say which robot it is of.
std::vector<std::string> remarks_on(const Cell& cell, const AppliedArm& applied);

/// Throws ModelRefused where the arm is known to be of another robot than that of the cell's file.
void demand_serial_of(const Cell& cell, const AppliedArm& applied);

/// Adds the tool that the daemon's run found. Throws ModelRefused where that does not count,
/// std::invalid_argument where there is no such run or the tool is there already, DaemonUnreachable.
void add_touched_run(const ApiClient& daemon, const std::string& run, AppliedArm& applied);
/// The same of a file with the result, as touchcal show RUN --json prints it. ConfigError where it cannot be
/// read.
void add_touched_file(const std::filesystem::path& file, AppliedArm& applied);

}  // namespace cell
