#include "sim_controller/val3/checks/rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

namespace val3 {
namespace {

TEST(Rules, EachSaysWhatAndWhyAndHowToMendIt) {
  std::set<std::string_view> ids;
  for (const Rule& rule : all_rules()) {
    EXPECT_TRUE(ids.insert(rule.id).second) << rule.id;
    EXPECT_EQ(find_rule(rule.id), &rule);
    for (const std::string_view text : {rule.what, rule.why, rule.remedy})
      EXPECT_TRUE(text.ends_with('.')) << rule.id << ": " << text;
  }
  EXPECT_EQ(find_rule("no-such-rule"), nullptr);
}

/// The ids that the headers of the parts declare.
std::set<std::string> declared_ids() {
  const std::filesystem::path parts = std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "sim_controller/val3";
  const std::regex id(R"re(std::string_view k\w+\s*=\s*"([a-z0-9-]+)")re");
  std::set<std::string> ids;
  for (const char* const header : {"files/file_rules.hpp", "language/syntax_rules.hpp",
                                   "language/resolver_rules.hpp", "checks/check_rules.hpp"}) {
    std::ifstream file(parts / header);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::sregex_iterator at(text.begin(), text.end(), id); at != std::sregex_iterator(); ++at)
      ids.insert((*at)[1]);
  }
  return ids;
}

TEST(Rules, OfEveryPartAreInTheTable) {
  const auto ids = declared_ids();
  EXPECT_GT(ids.size(), 100U);
  for (const std::string& id : ids) EXPECT_NE(find_rule(id), nullptr) << id;
  for (const Rule& rule : all_rules()) EXPECT_TRUE(ids.contains(std::string(rule.id))) << rule.id;
}

}  // namespace
}  // namespace val3
