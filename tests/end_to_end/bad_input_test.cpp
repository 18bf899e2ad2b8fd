// Files that are not what they must be: one line that names file and place, and the exit code that says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// One of the files that an identification reads, with a number in it and the vector of joints it may hold.
struct File {
  std::string path;    // in the folder of the test
  std::string number;  // key of a number, for a NaN in its place
  std::string six;     // pointer to six joints, if there are any
  std::string plane;   // pointer to the number of a plane, if there is one
};

const std::vector<File> kFiles{{"config/cells/edf/cell.json", "nominal_miss_mm", "/park_joints_deg", ""},
                               {"config/arms/tx90.json", "r_mm", "/joint_limits_deg", ""},
                               {"config/cells/edf/block.json", "offset_mm", "", "/faces/1/plane"},
                               {"config/cells/edf/probe.json", "overtravel_mm", "", ""},
                               {"config/recipes/edf-25.json", "fit_per_plane", "", "/touches/planes/2"},
                               {"touches.json", "plane", "/touches/3/joints_deg", "/touches/5/plane"}};

class BadInput : public ::testing::Test {
 protected:
  BadInput() {
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder_ / "config",
                          std::filesystem::copy_options::recursive);
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json",
                          folder_ / "touches.json");
  }

  Finished identify(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"touchcal",  "identify",
                                       "--cell",    (folder_ / kFiles.front().path).string(),
                                       "--touches", (folder_ / "touches.json").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(arguments, folder_ / "call.err").wait();
  }

  std::string read(const std::string& path) {
    std::ifstream stream(folder_ / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& path, const std::string& bytes) {
    std::ofstream(folder_ / path, std::ios::binary) << bytes;
  }

  /// Writes the bytes in place of the file's own, identifies, and puts the file back.
  void expect_refused(const std::string& path, const std::string& bytes, const std::string& pointer) {
    SCOPED_TRACE(path + " with " + bytes.substr(0, 200));
    const std::string sound = read(path);
    write(path, bytes);
    const Finished finished = identify();
    write(path, sound);
    expect_one_line(finished, path, pointer);
  }

  static void expect_one_line(const Finished& finished, const std::string& path, const std::string& pointer) {
    EXPECT_EQ(finished.exit_code, cell::kExitBadInput);
    EXPECT_EQ(finished.out, "");
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
    EXPECT_TRUE(finished.err.ends_with('\n')) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr(std::filesystem::path(path).filename().string()));
    EXPECT_THAT(finished.err, HasSubstr(pointer));
  }

  void expect_refused_with(const File& file, const std::function<void(json&)>& change,
                           const std::string& pointer) {
    json document = json::parse(read(file.path));
    change(document);
    expect_refused(file.path, document.dump(), pointer);
  }

  Folder folder_;
};

TEST_F(BadInput, TheFilesOfThisTestAreSoundBeforeTheyAreSpoilt) {
  EXPECT_EQ(identify().exit_code, cell::kExitLimitsMissed) << "Table III is flagged";
}

TEST_F(BadInput, AFileThatIsNotThereIsNamed) {
  for (const File& file : kFiles) {
    SCOPED_TRACE(file.path);
    std::filesystem::rename(folder_ / file.path, folder_ / "aside");
    expect_one_line(identify(), file.path, "");
    std::filesystem::rename(folder_ / "aside", folder_ / file.path);
  }
}

TEST_F(BadInput, AFileThatIsNoJsonIsNamed) {
  for (const File& file : kFiles) {
    for (const char* bytes : {"", "{", "no json", "{\"schema\":1}}"}) expect_refused(file.path, bytes, "");
  }
}

TEST_F(BadInput, AnotherSchemaIsNamed) {
  for (const File& file : kFiles) {
    expect_refused_with(
        file, [](json& document) { document["schema"] = "touchcal/else/1"; }, "/schema");
  }
}

TEST_F(BadInput, AnUnknownKeyIsNamed) {
  for (const File& file : kFiles) {
    expect_refused_with(
        file, [](json& document) { document["surprise"] = 1; }, "/surprise");
  }
}

TEST_F(BadInput, ANumberThatIsNoneIsRefused) {
  for (const File& file : kFiles) {
    const std::string sound = read(file.path);
    const std::size_t key = sound.find("\"" + file.number + "\"");
    ASSERT_NE(key, std::string::npos) << file.path;
    const std::size_t value = sound.find_first_of("-0123456789", sound.find(':', key));
    const std::size_t end = sound.find_first_of(",}] \n", value);
    for (const char* number : {"NaN", "Infinity", "1e999", "null", "\"12\""}) {
      expect_refused(file.path, sound.substr(0, value) + number + sound.substr(end), "");
    }
  }
}

TEST_F(BadInput, FiveJointsAreNamed) {
  int seen = 0;
  for (const File& file : kFiles) {
    if (file.six.empty()) continue;
    expect_refused_with(
        file, [&file](json& document) { document[json::json_pointer(file.six)].erase(5); }, file.six);
    ++seen;
  }
  EXPECT_EQ(seen, 3);
}

TEST_F(BadInput, APlaneThatDoesNotExistIsNamed) {
  int seen = 0;
  for (const File& file : kFiles) {
    if (file.plane.empty()) continue;
    for (const int plane : {0, -1, 5}) {
      expect_refused_with(
          file, [&](json& document) { document[json::json_pointer(file.plane)] = plane; }, file.plane);
    }
    ++seen;
  }
  EXPECT_EQ(seen, 3);
}

TEST_F(BadInput, TouchesOfAnotherArmAreRefused) {
  expect_refused_with(
      kFiles.back(), [](json& document) { document["arm"] = "tx60"; }, "/arm");
}

TEST_F(BadInput, TooFewTouchesSayHowManyAreMissingAndOnWhichPlanes) {
  json document = json::parse(read("touches.json"));
  json few = json::array();
  for (const json& touch : document["touches"]) {
    if (touch["plane"] == 1 && few.size() < 10) few.push_back(touch);
  }
  ASSERT_EQ(few.size(), 10U);
  document["touches"] = few;
  write("touches.json", document.dump());
  const Finished finished = identify();
  EXPECT_EQ(finished.exit_code, cell::kExitRefused);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(std::to_string(kRank - 10)));
  for (const char* plane : {"2", "3", "4"}) EXPECT_THAT(finished.err, HasSubstr(plane));
}

TEST_F(BadInput, LimitsThatAreMissedEndWithOneAndAResult) {
  json cell = json::parse(read(kFiles.front().path));
  cell["acceptance"]["condition_number_max"] = 10;
  write(kFiles.front().path, cell.dump());
  const Finished finished = identify({"--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitLimitsMissed);
  const json result = json::parse(finished.out);
  EXPECT_EQ(result.at("verdict").at("accepted"), false);
  EXPECT_THAT(result.at("verdict").at("reasons").dump(), HasSubstr("condition number"));
}

TEST_F(BadInput, ServersRefuseABadCellToo) {
  write(kFiles[3].path, "{");
  for (const char* program : {"touchcald", "cs8sim"}) {
    SCOPED_TRACE(program);
    expect_one_line(
        Process({program, "--cell", (folder_ / kFiles.front().path).string()}, folder_ / "call.err").wait(),
        kFiles[3].path, "");
  }
}

}  // namespace
}  // namespace touchcal::testing
