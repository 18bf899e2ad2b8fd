#include "service/base/log_format.hpp"

#include <gmock/gmock.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/ostream_sink.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace cell {
namespace {

using nlohmann::json;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class LogFormat : public ::testing::Test {
 protected:
  ~LogFormat() override {
    set_logged_run({});
    set_logged_touch({});
  }

  std::string line_of(std::unique_ptr<spdlog::formatter> format, const std::string& message) {
    std::ostringstream lines;
    spdlog::logger logger("touchcald", std::make_shared<spdlog::sinks::ostream_sink_st>(lines));
    logger.set_formatter(std::move(format));
    logger.warn(message);
    return lines.str();
  }
};

TEST_F(LogFormat, EachLineTellsRunAndTouchAsLongAsThereAreSome) {
  EXPECT_THAT(line_of(text_log_format(), "probe free"), EndsWith("[warning] probe free\n"));
  set_logged_run(7);
  EXPECT_THAT(line_of(text_log_format(), "probe free"), EndsWith("[run 7] probe free\n"));
  set_logged_touch(12);
  EXPECT_THAT(line_of(text_log_format(), "probe free"), EndsWith("[run 7] [touch 12] probe free\n"));
  set_logged_touch({});
  EXPECT_THAT(line_of(text_log_format(), "probe free"), Not(HasSubstr("[touch ")));
}

TEST_F(LogFormat, AJsonLineIsOneObjectWhateverTheMessageHolds) {
  const std::string message = "\"quoted\"\nnext line, \xff no UTF-8, {braces}";
  set_logged_run(7);
  const std::string line = line_of(json_log_format(), message);
  EXPECT_EQ(std::ranges::count(line, '\n'), 1);
  EXPECT_THAT(line, EndsWith("}\n"));
  const json object = json::parse(line);
  EXPECT_EQ(object.at("level"), "warning");
  EXPECT_THAT(object.at("message").get<std::string>(), HasSubstr("\"quoted\"\nnext line"));
  EXPECT_EQ(object.at("run"), "7");
  EXPECT_TRUE(object.at("touch").is_null());
  EXPECT_THAT(object.at("time").get<std::string>(), ::testing::MatchesRegex(".*T.*\\.[0-9][0-9][0-9]Z"));
  set_logged_touch(3);
  EXPECT_EQ(json::parse(line_of(json_log_format(), "x")).at("touch"), 3);
}

}  // namespace
}  // namespace cell
