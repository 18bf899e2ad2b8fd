#include "config/target_frames.hpp"

#include "config/config_error.hpp"
#include "config/json_value.hpp"
#include "config/shapes.hpp"

namespace cell {
namespace {

/// Whoever writes a pose into a file knows where he has it from, and nobody can tell by the figures.
bool is_touched_nominally(const JsonValue& value) {
  const std::string word = value.text();
  if (word == "nominal") return true;
  if (word != "no" && word != "calibrated")
    value.fail(
        "is " + in_quotes(word) +
        R"(; give "no" (by a drawing, or measured without the arm), "calibrated" or "nominal" (by the )"
        R"(arm, corrected or as its controller has it))");
  return false;
}

}  // namespace

TargetFrames target_frames_from_json(const JsonValue& value) {
  const auto members = value.members();
  if (members.size() > kTargetFrameCountMax)
    value.fail("has " + std::to_string(members.size()) + " frames; give at most " +
               std::to_string(kTargetFrameCountMax));
  TargetFrames frames;
  for (const auto& [name, entry] : members) {
    if (name.empty() || name.size() > kTargetFrameNameSizeMax)
      entry.fail("has a name of " + std::to_string(name.size()) + " bytes; give 1 to " +
                 std::to_string(kTargetFrameNameSizeMax));
    if (name == kWorldFrame) entry.fail("is the controller's own frame; give this one another name");
    const JsonObject object = entry.object({"position_mm", "rotation_deg", "touched"});
    frames.emplace(name, TargetFrame{.world_from_frame = pose_from_json(object),
                                     .is_touched_nominally = is_touched_nominally(object.at("touched"))});
  }
  return frames;
}

std::string why_no_target_frame(const TargetFrames& frames, const std::string& name) {
  if (name == kWorldFrame) return {};
  const auto found = frames.find(name);
  if (found == frames.end()) {
    std::string known(kWorldFrame);
    for (const auto& [frame, unused] : frames) known += ", " + frame;
    return "is " + in_quotes(name) + ", which the cell does not have; give one of " + known +
           ", or add it to the \"target_frames\" of the cell's file";
  }
  if (found->second.is_touched_nominally)
    return "is " + in_quotes(name) +
           ", which was touched with the nominal arm, says the cell's file: it holds that arm's errors, and "
           "a "
           "corrected target in it would be off by them; touch it again with the calibrated arm";
  return {};
}

Eigen::Isometry3d world_from_target_frame(const TargetFrames& frames, const std::string& name) {
  return name == kWorldFrame ? Eigen::Isometry3d::Identity() : frames.at(name).world_from_frame;
}

}  // namespace cell
