#include "service/report/words/words.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace cell {
namespace {

using ::testing::IsEmpty;

struct Table {
  std::span<const Translation> french, german;
};

std::vector<Table> tables() { return {{kWordsFr, kWordsDe}, {kVerificationWordsFr, kVerificationWordsDe}}; }

std::vector<std::string> placeholders(std::string_view text) {
  static const std::regex kPlaceholder(R"(\{[^}]*\}?\}?)");
  const std::string copy(text);
  std::vector<std::string> found;
  for (std::sregex_iterator each(copy.begin(), copy.end(), kPlaceholder), end; each != end; ++each)
    found.push_back(each->str());
  return found;
}

/// The sources of the report as one text, neighbouring literals joined.
std::string report_sources() {
  std::string all;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "service/report")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    all += text.str();
  }
  return std::regex_replace(all, std::regex("\"\\s*\\n\\s*\""), "");
}

TEST(Words, EachTableHasTheSameTextsInBothLanguagesWithTheSamePlaceholders) {
  std::set<std::string_view> all;
  for (const Table& table : tables()) {
    ASSERT_EQ(table.french.size(), table.german.size());
    for (std::size_t i = 0; i < table.french.size(); ++i) {
      const Translation &french = table.french[i], &german = table.german[i];
      EXPECT_EQ(french.english, german.english);
      EXPECT_TRUE(all.insert(french.english).second) << french.english << " is there twice";
      for (const Translation& one : {french, german}) {
        EXPECT_NE(one.translated, "") << one.english;
        EXPECT_EQ(placeholders(one.translated), placeholders(one.english)) << one.english;
      }
    }
  }
}

TEST(Words, EachTextThatAPartNamesIsTranslated) {
  const std::string sources = report_sources();
  static const std::regex kNamed(R"re(\bwords\(\s*"((?:[^"\\]|\\.)*)")re"), kFormat(R"(\{[^}]*\})");
  static const std::set<std::string> kNoWords{"mm", "mm/", "K"};
  std::set<std::string> missing;
  int named = 0;
  for (std::sregex_iterator each(sources.begin(), sources.end(), kNamed), end; each != end; ++each) {
    ++named;
    const std::string text = (*each)[1];
    std::string bare = std::regex_replace(text, kFormat, "");
    std::erase_if(bare, [](char c) { return c == ' '; });
    if (!std::ranges::any_of(bare, [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }))
      continue;
    if (!kNoWords.contains(bare) && !words_in("fr")->has(text)) missing.insert(text);
  }
  EXPECT_GT(named, 200);
  EXPECT_THAT(missing, IsEmpty());
}

/// Names in documents are said by no part: budget sources, criteria, alternatives, words of enumerations.
TEST(Words, NoTextIsTranslatedInVain) {
  const std::string sources = report_sources();
  static const std::set<std::string_view> kOfDocuments{"touch noise",
                                                       "drift",
                                                       "gears",
                                                       "block size",
                                                       "squareness",
                                                       "stylus radius",
                                                       "pretravel",
                                                       "block temperature",
                                                       "block places",
                                                       "stylus tips",
                                                       "makers tolerances",
                                                       "compliance",
                                                       "gear harmonics",
                                                       "masses",
                                                       "complete",
                                                       "converged",
                                                       "held out touches",
                                                       "held out mean",
                                                       "held out rms",
                                                       "tip box rms",
                                                       "tip box max",
                                                       "tool box rms",
                                                       "unknown errors",
                                                       "nominal miss",
                                                       "scale",
                                                       "artefact",
                                                       "lack of fit",
                                                       "rejected touches",
                                                       "held parameters",
                                                       "shown parameters",
                                                       "pass (proven)",
                                                       "FAIL",
                                                       "FAIL (not proven)",
                                                       "simple",
                                                       "guarded",
                                                       "accepted",
                                                       "rejected",
                                                       "incomplete",
                                                       "running",
                                                       "stopped",
                                                       "aborted",
                                                       "interrupted",
                                                       "automatic",
                                                       "identified",
                                                       "excluded",
                                                       "droop",
                                                       "eccentric gears",
                                                       "oval gears",
                                                       "guided",
                                                       "backlash",
                                                       "held",
                                                       "unseen"};
  for (const Table& table : tables()) {
    for (const Translation& each : table.french) {
      const bool is_rule = each.english.find("conformance is") != std::string_view::npos;
      if (is_rule || kOfDocuments.contains(each.english)) continue;
      EXPECT_NE(sources.find("\"" + std::string(each.english) + "\""), std::string::npos) << each.english;
    }
  }
}

TEST(Words, AFigureHasTheMarkOfTheLanguageAndKeepsItsWidth) {
  const Words& french = *words_in("fr");
  EXPECT_EQ(french("{:+.{}f}", 1.25, 1), "+1,2");
  EXPECT_EQ(french("{:.3f} mm rms", 0.5), "0,500 mm eqm");
  EXPECT_EQ(english()("{:.3f} mm rms", 0.5), "0.500 mm rms");
  EXPECT_EQ(french.figure(std::nullopt, "{:.1f}"), "inconnu");
  EXPECT_EQ(french.or_dash(std::nullopt, "{:.1f}"), "–");
  EXPECT_EQ(french.if_known(std::nullopt, "{:.1f}"), "");
  EXPECT_EQ(french.known(""), "inconnu");
  EXPECT_EQ(french("run {} of {}: {}", "1.2", "2026-01-31", 3), "cycle 1.2 du 2026-01-31 : 3");
  const std::vector<std::string> joints{"1.5", "-2.25"};
  EXPECT_EQ(french.numbers(joints), "1,5; -2,25");
  EXPECT_EQ(english().numbers(joints), "1.5, -2.25");
}

TEST(Words, ALanguageThatIsNotThereIsNone) {
  EXPECT_EQ(words_in("it"), nullptr);
  EXPECT_EQ(words_in("fr")->tag(), "fr");
  EXPECT_EQ(words_in("en"), &english());
  EXPECT_EQ(english()("no such text"), "no such text");
}

}  // namespace
}  // namespace cell
