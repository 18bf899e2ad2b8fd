#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// The files of the VAL3 application as texts, and what they declare.
namespace cs8 {

using Names = std::set<std::string>;

inline const std::filesystem::path kSource = TOUCHCAL_SOURCE_DIR;
inline const std::filesystem::path kProject = kSource / "cs8_protocol/val3/touchcal";

inline std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Each match's first group.
inline std::vector<std::string> all_matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), none; match != none; ++match)
    found.push_back((*match)[1]);
  return found;
}
inline Names names_in(const std::string& text, const std::string& pattern) {
  const auto found = all_matches(text, pattern);
  return {found.begin(), found.end()};
}

/// Code of a program without comments.
inline std::string code_of(const std::string& program) {
  return std::regex_replace(read(kProject / (program + ".pgx")), std::regex("//[^\n]*"), "");
}
inline Names programs() {
  Names found;
  for (const auto& entry : std::filesystem::directory_iterator(kProject))
    if (entry.path().extension() == ".pgx") found.insert(entry.path().stem());
  return found;
}

/// The variables of the data file: type and the text of each element that is not the default.
struct Variable {
  std::string type;
  std::map<int, std::string> values;
};
inline const std::map<std::string, Variable>& variables() {
  static const auto all = [] {
    std::map<std::string, Variable> found;
    std::istringstream lines(read(kProject / "touchcal.dtx"));
    std::string name;
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      if (std::regex_search(line, match, std::regex(R"re(<Data name="(\w+)".* type="(\w+)")re"))) {
        name = match[1];
        found[name].type = match[2];
      } else if (std::regex_search(line, match, std::regex(R"re(<Value key="(\d+)" (.*) />)re"))) {
        found[name].values[std::stoi(match[1])] = match[2];
      }
    }
    return found;
  }();
  return all;
}

/// An element of a constant; 0 is the default and not written.
inline double constant(const std::string& name, int key = 0) {
  const auto found = variables().find(name);
  EXPECT_TRUE(found != variables().end()) << "no constant " << name;
  if (found == variables().end() || !found->second.values.contains(key)) return 0;
  return std::stod(found->second.values.at(key).substr(std::string("value=\"").size()));
}

}  // namespace cs8
