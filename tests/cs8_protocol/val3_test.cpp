#include <gtest/gtest.h>

#include <algorithm>

#include "val3_project.hpp"

/// The VAL3 application is written by hand; these hold its files together. tests/val3 runs it.
namespace cs8 {
namespace {

TEST(Val3Application, IsWellFormedXml) {
  for (const auto& entry : std::filesystem::directory_iterator(kProject)) {
    SCOPED_TRACE(entry.path().filename());
    std::string xml = read(entry.path());
    EXPECT_TRUE(xml.starts_with("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<"));
    if (const auto code = xml.find("<![CDATA["); code != std::string::npos) {
      const auto end = xml.find("]]>");
      ASSERT_NE(end, std::string::npos);
      EXPECT_TRUE(xml.substr(code).starts_with("<![CDATA[begin\n"));
      EXPECT_TRUE(xml.substr(0, end).ends_with("\nend"));
      xml.erase(code, end + 3 - code);
    }
    std::vector<std::string> open;
    const std::regex tag(R"(<(/?)([A-Za-z]+)[^<>]*?(/?)>)");
    for (std::sregex_iterator match(xml.begin(), xml.end(), tag), none; match != none; ++match) {
      if ((*match)[1] == "/") {
        ASSERT_FALSE(open.empty());
        ASSERT_EQ(open.back(), (*match)[2]);
        open.pop_back();
      } else if ((*match)[3] != "/") {
        open.push_back((*match)[2]);
      }
    }
    EXPECT_TRUE(open.empty());
  }
}

TEST(Val3Application, ListsEveryProgramUnderTheNameOfItsFile) {
  const std::string project = read(kProject / "touchcal.pjx");
  EXPECT_EQ(names_in(project, R"re(<Program file="(\w+)\.pgx" />)re"), programs());
  EXPECT_EQ(names_in(project, R"re(<Data file="(\w+)\.dtx" />)re"), Names{"touchcal"});
  for (const std::string& name : programs()) {
    EXPECT_LT(name.size(), 16u) << name;
    EXPECT_EQ(names_in(read(kProject / (name + ".pgx")), R"re(<Program name="(\w+)")re"), Names{name});
  }
}

TEST(Val3Application, StartSetsEveryVariable) {
  std::string code;
  for (const char* program : {"start", "armAgrees", "readVersion", "setTasks", "setLink", "setCommand",
                              "setMotion", "setCapture", "setProbe"}) {
    code += code_of(program);
    EXPECT_TRUE(std::string(program) == "start" ||
                code.find("call " + std::string(program) + "(") != code.npos)
        << "nobody calls " << program;
  }
  for (const auto& [name, variable] : variables()) {
    if (name.starts_with('k') || variable.type == "dio" || variable.type == "sio") continue;
    EXPECT_TRUE(std::regex_search(code, std::regex("\n *" + name + R"((\[\w+\])?=)")) ||
                code.find(", " + name + ", task") != code.npos)
        << name << " keeps what was saved";
  }
}

TEST(Val3Application, StopKillsEveryTask) {
  Names created;
  for (const std::string& program : programs())
    created.merge(names_in(code_of(program), R"re(taskCreate\w* "(\w+)")re"));
  EXPECT_EQ(names_in(code_of("stop"), R"re(taskKill\("(\w+)"\))re"), created);
  EXPECT_GE(created.size(), 4u);
}

TEST(Val3Application, HasTheProductsVersionAndAsksForTheLanguageItIsWrittenIn) {
  const std::string project = read(kSource / "CMakeLists.txt");
  std::smatch version;
  ASSERT_TRUE(std::regex_search(project, version, std::regex(R"(VERSION (\d+)\.(\d+)\.(\d+))")));
  const auto number = [](const std::smatch& m) {
    return 10000 * std::stoi(m[1]) + 100 * std::stoi(m[2]) + std::stoi(m[3]);
  };
  EXPECT_EQ(constant("kVersion"), number(version));
  const std::string pjx = read(kProject / "touchcal.pjx");
  ASSERT_TRUE(std::regex_search(pjx, version, std::regex(R"re(version="s(\d+)\.(\d+)\.(\d+)")re")));
  EXPECT_EQ(constant("kLanguageMin"), number(version));
}

TEST(Val3Application, HasTheJointRangesOfTheArmFile) {
  const std::string arm = read(kSource / "config/arms/tx90.json");
  std::smatch limits;
  ASSERT_TRUE(std::regex_search(arm, limits, std::regex(R"re("joint_limits_deg": \[(.*)\])re")));
  const std::string pairs = limits[1];
  const auto lower = all_matches(pairs, R"(\[([-\d.]+),)");
  const auto upper = all_matches(pairs, R"(, ([-\d.]+)\])");
  ASSERT_EQ(lower.size(), 6u);
  for (const auto& [name, expected] : {std::pair{"kLower", lower}, {"kUpper", upper}})
    EXPECT_EQ(all_matches(variables().at(name).values.at(0), R"re(j\d="([^"]*)")re"), expected) << name;
}

TEST(Val3Application, InstallationNamesEveryLinkAndSetting) {
  const std::string page = read(kProject.parent_path() / "INSTALL.md");
  for (const auto& [name, variable] : variables()) {
    if (variable.type != "dio" && variable.type != "sio") continue;
    const std::string link = all_matches(variable.values.at(0), R"re(link="(.*)")re").at(0);
    EXPECT_NE(page.find("`" + name + "`"), page.npos) << name;
    EXPECT_NE(page.find("`" + link + "`"), page.npos) << link;
  }
  for (const char* setting : {"kProbe", "kHasLatch", "kOvertravel", "kSearchMax", "kSearchSpeed", "kLower",
                              "kUpper", "kArm", "kDryRun", "kDryShare", "kMove"}) {
    EXPECT_TRUE(variables().contains(setting)) << setting;
    EXPECT_NE(page.find("`" + std::string(setting) + "`"), page.npos) << setting;
  }
}

}  // namespace
}  // namespace cs8
