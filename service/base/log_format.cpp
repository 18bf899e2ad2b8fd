#include "service/base/log_format.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/formatter.h>
#include <spdlog/pattern_formatter.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"
#include "service/base/utc_time.hpp"

namespace cell {
namespace {

constexpr std::int64_t kNone = 0;

// Set by the daemon's thread while the planner's thread may log.
std::atomic<std::int64_t> logged_run{kNone};
std::atomic<int> logged_touch{kNone};

class AboutWhat : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg&, const std::tm&, spdlog::memory_buf_t& line) override {
    const std::int64_t run = logged_run;
    const int touch = logged_touch;
    std::string about;
    if (run != kNone) about += fmt::format("[run {}] ", run);
    if (touch != kNone) about += fmt::format("[touch {}] ", touch);
    line.append(about.data(), about.data() + about.size());
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<AboutWhat>();
  }
};

class JsonLines : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    const std::int64_t run = logged_run;
    const int touch = logged_touch;
    const auto level = spdlog::level::to_string_view(message.level);
    const auto time = std::chrono::time_point_cast<std::chrono::system_clock::duration>(message.time);
    const Json object{{"time", format_utc(time)},
                      {"level", std::string(level.data(), level.size())},
                      {"message", std::string(message.payload.data(), message.payload.size())},
                      {"run", run != kNone ? Json(std::to_string(run)) : Json(nullptr)},
                      {"touch", touch != kNone ? Json(touch) : Json(nullptr)}};
    const std::string text = text_of(object) + "\n";
    line.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<formatter> clone() const override { return std::make_unique<JsonLines>(); }
};

}  // namespace

void set_logged_run(std::optional<std::int64_t> run_id) { logged_run = run_id.value_or(kNone); }

void set_logged_touch(std::optional<int> number) { logged_touch = number.value_or(kNone); }

std::unique_ptr<spdlog::formatter> text_log_format() {
  auto format = std::make_unique<spdlog::pattern_formatter>();
  format->add_flag<AboutWhat>('*').set_pattern("[%Y-%m-%d %H:%M:%S.%e] [%n] [%^%l%$] %*%v");
  return format;
}

std::unique_ptr<spdlog::formatter> json_log_format() { return std::make_unique<JsonLines>(); }

}  // namespace cell
