#include "service/cli/progress.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

#include "service/cli/result_text.hpp"
#include "service/run/readiness.hpp"

namespace cell {
namespace {

constexpr int kBarWidth = 30;

std::string figures(const StatusDocument& status) {
  if (status.waiting_for) return fmt::format("waiting: {}", awaited_instruction(*status.waiting_for));
  std::string text = status.touches_total
                         ? fmt::format("touch {} of {}", status.touches_done, *status.touches_total)
                         : "planning";
  const auto add = [&text](std::optional<double> value, const char* format) {
    if (value) text += fmt::format(fmt::runtime(format), *value);
  };
  add(status.plane, "  plane {:.0f}");
  if (status.block_place && !is_block_to_move(status)) text += "  block at " + *status.block_place;
  add(status.identifiable_count, "  rank {:.0f}");
  add(status.condition_number, "  cond {:.0f}");
  add(status.predicted_tip_rms_mm, "  tip +- {:.3f} mm");
  add(status.eta_s, "  {:.0f} s left");
  return text;
}

}  // namespace

std::string guidance(const StatusDocument& status) {
  if (!status.by_hand_words) return {};
  std::string text;
  if (status.by_hand_problem) text = fmt::format("not taken: {}\n", *status.by_hand_problem);
  if (status.by_hand_step == HandStep::kTouch)
    text += fmt::format("{} of {}: ", status.by_hand_index.value(), status.by_hand_total.value());
  text += *status.by_hand_words;
  if (status.waiting_for) text += fmt::format("\nwaiting: {}", awaited_instruction(*status.waiting_for));
  return text;
}

void Progress::show_guidance(const StatusDocument& status) {
  const std::string text = guidance(status);
  if (text == last_guidance_) return;
  last_guidance_ = text;
  if (text.empty()) return;
  finish();
  fmt::print("{}\n", text);
}

void Progress::show_fault(const StatusDocument& status) {
  const std::string fault = status.fault_code.value_or("");
  if (fault == last_fault_) return;
  last_fault_ = fault;
  if (fault.empty()) return;
  finish();
  fmt::print("{}: {}\n  robot: {}\n  next:  {}\n", is_block_to_move(status) ? "to do" : "fault " + fault,
             status.fault_message.value(), status.fault_robot_action.value(), status.fault_next_step.value());
  std::fflush(stdout);
}

void Progress::show(const StatusDocument& status) {
  show_fault(status);
  show_guidance(status);
  const int total = status.touches_total.value_or(0);
  const int done = status.touches_done;
  if (on_terminal_) {
    const int filled = total > 0 ? done * kBarWidth / total : 0;
    fmt::print("\r\033[K{:<11}[{}{}] {}", word_of(status.state),
               std::string(static_cast<std::size_t>(filled), '#'),
               std::string(static_cast<std::size_t>(kBarWidth - filled), '.'), figures(status));
    line_open_ = true;
  } else {
    const int tenth = total > 0 ? done * 10 / total : 0;
    const std::string awaited = status.waiting_for.value_or("");
    if (status.state == last_state_ && tenth == last_tenth_ && awaited == last_awaited_) return;
    last_tenth_ = tenth;
    last_awaited_ = awaited;
    fmt::print("{:<11} {}\n", word_of(status.state), figures(status));
  }
  last_state_ = status.state;
  std::fflush(stdout);
}

void Progress::finish() {
  if (line_open_) fmt::print("\n");
  line_open_ = false;
  std::fflush(stdout);
}

}  // namespace cell
