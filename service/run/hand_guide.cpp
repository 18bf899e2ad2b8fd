#include "service/run/hand_guide.hpp"

namespace cell {

std::string_view hand_activity_name(HandActivity activity) {
  switch (activity) {
    case HandActivity::kLocate:
      return "locate";
    case HandActivity::kTool:
      return "tool";
    case HandActivity::kGuided:
      return "guided";
  }
  return "";
}

std::string_view hand_step_name(HandStep step) {
  switch (step) {
    case HandStep::kTouch:
      return "touch";
    case HandStep::kUndo:
      return "undo";
    case HandStep::kPass:
      return "pass";
    case HandStep::kPassing:
      return "passing";
  }
  return "";
}

}  // namespace cell
