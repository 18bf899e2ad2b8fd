#include "service/exports/robodk_list.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "config/targets_file.hpp"

namespace cell {
namespace {

constexpr std::string_view kRobodkFigures =
    "# X Y Z: mm; Rx Ry Rz: degrees, turned about x, then the new y, then the new z (RoboDK: "
    "Staubli_2_Pose), "
    "right-handed\n"
    "# they are the pose of the tool in the controller's world (origin on axis 1 at the height of the "
    "shoulder, z "
    "along axis 1)\n"
    "# as the controller's own model has it at J1 to J6: what is to be commanded, not where the calibrated "
    "arm "
    "brings the tool\n"
    "# J1 to J6: degrees, zero and sign as the controller counts them; they say the configuration\n";

/// Nothing of it may begin a line of its own.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

std::string robodk_list(const std::vector<ListedPose>& poses, const std::vector<std::string>& remarks) {
  std::string text;
  for (const std::string& remark : remarks) text += "# " + in_one_line(remark) + '\n';
  text += kRobodkFigures;
  text += kRobodkHeader;
  text += '\n';
  for (const ListedPose& pose : poses) {
    text += pose.name;
    for (const auto* numbers : {&pose.world_from_tool, &pose.joints_deg})
      for (const double number : *numbers) text += fmt::format(", {:.6f}", number);
    text += '\n';
  }
  return text;
}

}  // namespace cell
