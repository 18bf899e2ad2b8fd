// service/doc/surfaces.md names every field and every path that the API promises: the schemas and the routes
// say which.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/architecture/source_files.hpp"

namespace architecture {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::set<std::string> names_in(const std::string& text, const std::regex& pattern) {
  std::set<std::string> found;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), pattern); match != std::sregex_iterator();
       ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

const std::string& surfaces() {
  static const std::string text = text_of(kRoot / "service/doc/surfaces.md");
  return text;
}

TEST(Surfaces, NameEveryFieldThatASchemaRequires) {
  // A list of required fields of the outermost object stands at the beginning of a line.
  const std::regex required(R"re(\n"required":\[([^\]]*)\])re");
  const std::regex name(R"re("(\w+)")re");
  int seen = 0;
  for (const auto& file : source_files("service")) {
    if (!file.filename().string().ends_with("schemas.cpp")) continue;
    const std::string source = text_of(file);
    for (const char* wanted :
         {"kStatus = R", "kRun = R", "kRuns = R", "kCell = R", "kJoints = R", "kProblem = R", "kResult = R",
          "kTipUncertainty = R", "kPlan = R", "kReport = R", "kModels = R", "kModel = R", "kChecks = R",
          "kProof = R", "kCheck = R", "kVerificationReport = R", "kComparison = R"}) {
      const std::size_t schema = source.find(wanted);
      if (schema == std::string::npos) continue;
      std::smatch fields;
      const std::string behind = source.substr(schema, source.find(")\";", schema) - schema);
      ASSERT_TRUE(std::regex_search(behind, fields, required)) << wanted;
      for (const std::string& field : names_in(fields[1], name)) {
        ++seen;
        EXPECT_NE(surfaces().find('`' + field), std::string::npos) << wanted << ": " << field;
      }
    }
  }
  EXPECT_GT(seen, 100) << "the test reads too little to mean anything";
}

TEST(Surfaces, NameEveryPath) {
  const std::regex path(R"re("(/api/v1/(?:[^"{]|\{id\})*|/healthz|/readyz|/metrics|/openapi\.json)")re");
  int seen = 0;
  for (const auto& file : source_files("service")) {
    if (!file.filename().string().ends_with("_routes.cpp")) continue;
    for (const std::string& route : names_in(text_of(file), path)) {
      ++seen;
      EXPECT_NE(surfaces().find(route), std::string::npos) << file << ": " << route;
    }
  }
  EXPECT_GT(seen, 25) << "the test reads too little to mean anything";
}

}  // namespace
}  // namespace architecture
