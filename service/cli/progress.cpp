#include "service/cli/progress.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "service/run/readiness.hpp"

namespace cell {
namespace {

using nlohmann::json;

constexpr int kBarWidth = 30;

std::string figures(const json& status) {
  if (status.at("waiting_for").is_string())
    return fmt::format("waiting: {}", awaited_instruction(status.at("waiting_for").get<std::string>()));
  std::string text = status.at("touches_total").is_number()
                         ? fmt::format("touch {} of {}", status.at("touches_done").get<int>(),
                                       status.at("touches_total").get<int>())
                         : "planning";
  const auto add = [&](const char* key, const char* format) {
    if (const auto value = status.find(key); value != status.end() && value->is_number())
      text += fmt::format(fmt::runtime(format), value->get<double>());
  };
  add("plane", "  plane {:.0f}");
  add("identifiable_count", "  rank {:.0f}");
  add("attainable_count", " of {:.0f}");
  add("condition_number", "  cond {:.0f}");
  add("predicted_tip_rms_mm", "  tip +- {:.3f} mm");
  add("eta_s", "  {:.0f} s left");
  return text;
}

}  // namespace

std::string guidance(const json& status) {
  if (!status.at("by_hand_words").is_string()) return {};
  std::string text;
  if (status.at("by_hand_problem").is_string())
    text = fmt::format("not taken: {}\n", status.at("by_hand_problem").get<std::string>());
  if (status.at("by_hand_step") == "touch")
    text += fmt::format("{} of {}: ", status.at("by_hand_index").get<int>(),
                        status.at("by_hand_total").get<int>());
  text += status.at("by_hand_words").get<std::string>();
  if (status.at("waiting_for").is_string())
    text += fmt::format("\nwaiting: {}", awaited_instruction(status.at("waiting_for").get<std::string>()));
  return text;
}

void Progress::show_guidance(const json& status) {
  const std::string text = guidance(status);
  if (text == last_guidance_) return;
  last_guidance_ = text;
  if (text.empty()) return;
  finish();
  fmt::print("{}\n", text);
}

void Progress::show_fault(const json& status) {
  const std::string fault =
      status.at("fault_code").is_string() ? status.at("fault_code").get<std::string>() : "";
  if (fault == last_fault_) return;
  last_fault_ = fault;
  if (fault.empty()) return;
  finish();
  fmt::print("fault {}: {}\n  robot: {}\n  next:  {}\n", fault, status.at("fault_message").get<std::string>(),
             status.at("fault_robot_action").get<std::string>(),
             status.at("fault_next_step").get<std::string>());
  std::fflush(stdout);
}

void Progress::show(const json& status) {
  show_fault(status);
  show_guidance(status);
  const std::string state = status.at("state");
  const int total = status.at("touches_total").is_number() ? status.at("touches_total").get<int>() : 0;
  const int done = status.at("touches_done");
  if (on_terminal_) {
    const int filled = total > 0 ? done * kBarWidth / total : 0;
    fmt::print("\r\033[K{:<11}[{}{}] {}", state, std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kBarWidth - filled), '.'), figures(status));
    line_open_ = true;
  } else {
    const int tenth = total > 0 ? done * 10 / total : 0;
    const std::string awaited = status.at("waiting_for").is_string() ? status.at("waiting_for") : "";
    if (state == last_state_ && tenth == last_tenth_ && awaited == last_awaited_) return;
    last_tenth_ = tenth;
    last_awaited_ = awaited;
    fmt::print("{:<11} {}\n", state, figures(status));
  }
  last_state_ = state;
  std::fflush(stdout);
}

void Progress::finish() {
  if (line_open_) fmt::print("\n");
  line_open_ = false;
  std::fflush(stdout);
}

}  // namespace cell
