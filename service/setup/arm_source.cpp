#include "service/setup/arm_source.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/estimation/block_registration.hpp"
#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "service/setup/dh_arm.hpp"
#include "service/setup/urdf_arm.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

bool is_config(const fs::path& folder) {
  std::error_code unknown;
  return fs::is_directory(folder / "arms", unknown) &&
         fs::is_regular_file(folder / "recipes" / "quick.json", unknown);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

fs::path arm_file_named(const std::string& name, const fs::path& shipped_config) {
  std::error_code unknown;
  if (name.find('/') == std::string::npos) {
    fs::path shipped = shipped_config / "arms" / (name + ".json");
    if (fs::is_regular_file(shipped, unknown)) return shipped;
  }
  if (fs::is_regular_file(name, unknown)) return name;
  throw ConfigError("arm", "/arm/file",
                    "there is neither a shipped arm nor a file " + in_quotes(name) + "; shipped are " +
                        listed(shipped_arms(shipped_config)));
}

/// The arm stands where the block's frame of its own description is. One that has its place and its probe
/// already is as one of a file.
SetupArm in_own_frame(MadeArm made, const ArmChoice& choice) {
  if (choice.body_radii_mm) set_body_radii(made, *choice.body_radii_mm);
  if (made.is_placed) return {.arm = made.arm, .remarks = std::move(made.remarks)};
  return {.arm = made.arm,
          .base_from_frame1 = made.base_from_frame1,
          .is_made = true,
          .remarks = std::move(made.remarks)};
}

/// One that setup-arm has made stands in its own base, whose z points up, and ends at its flange; the others
/// stand before a block, whose y points down, and end at the ball.
SetupArm placed_or_in_own_base(Arm arm) {
  const Eigen::Isometry3d base_from_frame1 = calib::block_pose_of(arm.model);
  const Eigen::Vector3d down = base_from_frame1.linear() * arm.model.down_in_frame_1;
  const bool is_placed = std::abs(down.y()) > 0.5;
  if (is_placed) return {.arm = std::move(arm)};
  return {.arm = std::move(arm), .base_from_frame1 = base_from_frame1, .is_made = true};
}

}  // namespace

SetupArm read_setup_arm(const ArmChoice& choice, const fs::path& shipped_config) {
  if (!choice.urdf.empty())
    return in_own_frame(arm_of_urdf_file(choice.urdf, choice.base_link, choice.tip_link), choice);
  if (!choice.dh.empty()) return in_own_frame(arm_of_dh_file(choice.dh, choice.dh_convention), choice);
  return placed_or_in_own_base(read_arm(arm_file_named(choice.file, shipped_config)));
}

std::vector<std::string> shipped_arms(const fs::path& shipped_config) {
  std::vector<std::string> names;
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(shipped_config / "arms", unknown))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

std::map<std::string, std::string> shipped_recipes(const fs::path& shipped_config) {
  std::map<std::string, std::string> recipes;
  for (const std::string_view name : kSetupRecipes)
    recipes[std::string(name)] =
        read_file_bytes(shipped_config / "recipes" / (std::string(name) + ".json"), kConfigFileSizeMax);
  return recipes;
}

fs::path shipped_config_of(const fs::path& program, const char* environment) {
  if (environment != nullptr && *environment != '\0') {
    if (is_config(environment)) return environment;
    throw ConfigError("TOUCHCAL_CONFIG", "",
                      in_quotes(environment) +
                          " has no arms and recipes; name the folder that config of the source "
                          "tree was installed to");
  }
  const fs::path prefix = program.parent_path().parent_path();
  for (const fs::path& folder :
       {prefix.parent_path() / "config", prefix / "share/touchcal/config", fs::path("/etc/touchcal")})
    if (is_config(folder)) return folder.lexically_normal();
  throw ConfigError("TOUCHCAL_CONFIG", "",
                    "the shipped arms and recipes are not found beside the program; set it to their folder");
}

}  // namespace cell
