// Files that something changed: a byte, a value, a key, the end. Whatever it was, a program ends by itself
// with a result or with an exit code and one line that says why.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;

const std::string kCell = "config/cells/edf/cell.json";
const std::string kTruth = "config/cells/edf/truth.json";
const std::string kTouches = "touches.json";
const std::string kRecipe = "config/recipes/edf-25.json";

/// A program and the files that it reads.
struct Reader {
  std::vector<std::string> arguments;  // `{}` is the folder of the test
  std::vector<std::string> files;
  int times = 0;  // changes of each file
};

const std::vector<std::string> kCellFiles{kCell, "config/arms/tx90.json", "config/cells/edf/block.json",
                                          "config/cells/edf/probe.json", kRecipe};

class BadFiles : public ::testing::Test {
 protected:
  BadFiles() {
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder_ / "config",
                          std::filesystem::copy_options::recursive);
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json",
                          folder_ / kTouches);
    const json touches = json::parse(read(kTouches));
    std::string csv = "plane,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\n";
    for (const json& touch : touches.at("touches")) {
      csv += touch.at("plane").dump();
      for (const json& joint : touch.at("joints_deg")) csv += ',' + joint.dump();
      csv += '\n';
    }
    write("touches.csv", csv);
    write("faults.json", R"({"schema":"touchcal/faults/1","operator":{"confirms":false},)"
                         R"("faults":[{"fault":"close","on":"touch_result","count":3},)"
                         R"({"fault":"probe_stuck","touch":5,"phase":"retract"},)"
                         R"({"fault":"references_lost","after_ms":60000}]})");
  }

  std::string read(const std::string& path) const {
    std::ifstream stream(folder_ / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& path, const std::string& bytes) const {
    std::ofstream(folder_ / path, std::ios::binary) << bytes;
  }

  Finished run(std::vector<std::string> arguments) const {
    for (std::string& argument : arguments) {
      if (argument.starts_with("{}")) argument = folder_ / argument.substr(3);
    }
    return Process(arguments, folder_ / "call.err").wait();
  }

  /// A number below `bound`.
  std::size_t lot(std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(chance_);
  }

  /// One byte or a stretch of them is another, missing, or there twice.
  std::string with_changed_bytes(std::string bytes) {
    const std::size_t at = lot(bytes.size());
    const std::size_t length = std::min(1 + lot(20), bytes.size() - at);
    switch (lot(5)) {
      case 0:
        bytes[at] = static_cast<char>(lot(256));
        return bytes;
      case 1:
        return bytes.substr(0, at);
      case 2:
        return bytes.erase(at, length);
      case 3:
        return bytes.insert(at, bytes.substr(lot(bytes.size()), length));
      default:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << lot(8)));
        return bytes;
    }
  }

  /// One value of the document, wherever it stands, is another one, missing or there under another key.
  std::string with_changed_value(const std::string& bytes) {
    static const std::vector<json> values{nullptr,
                                          true,
                                          0,
                                          -1,
                                          1e308,
                                          -1e308,
                                          1e-320,
                                          4294967296,
                                          9223372036854775807,
                                          "",
                                          "x",
                                          std::string(5000, 'x'),
                                          json::array(),
                                          json::object(),
                                          json::array({1, 2, 3}),
                                          json{{"a", 1}},
                                          -0.0,
                                          1000001};
    json document = json::parse(bytes);
    std::vector<std::string> pointers;
    const json leaves = document.flatten();
    for (const auto& [pointer, unused] : leaves.items()) pointers.push_back(pointer);
    json::json_pointer place(pointers[lot(pointers.size())]);
    for (std::size_t up = lot(3); up > 0 && !place.parent_pointer().empty(); --up)
      place = place.parent_pointer();
    json& parent = document[place.parent_pointer()];
    if (parent.is_object() && lot(5) == 0) {
      const json old = parent[place.back()];
      parent.erase(place.back());
      if (lot(2) == 0) parent[place.back() + "_x"] = old;
    } else {
      document[place] = values[lot(values.size())];
    }
    return document.dump();
  }

  void expect_an_end(const Finished& finished, const std::string& what) {
    EXPECT_LE(finished.exit_code, cell::kExitRefused)
        << "ended by " << finished.exit_code << ": " << what << '\n'
        << finished.err;
    if (finished.exit_code < cell::kExitUsage) return;
    ++refused_;
    const std::string line = finished.err.substr(0, finished.err.find('\n'));
    EXPECT_FALSE(line.empty()) << what;
    if (finished.exit_code == cell::kExitBadInput) {
      EXPECT_TRUE(line.find(".json") != line.npos || line.find(".csv") != line.npos) << line << '\n' << what;
    }
  }

  void change_and_run(const Reader& reader) {
    ASSERT_LE(run(reader.arguments).exit_code, cell::kExitLimitsMissed) << "before a file is changed";
    for (const std::string& file : reader.files) {
      const std::string sound = read(file);
      for (int time = 0; time < reader.times; ++time) {
        const bool is_json = file.ends_with(".json");
        const std::string changed =
            is_json && time % 2 == 0 ? with_changed_value(sound) : with_changed_bytes(sound);
        if (changed == sound) continue;
        write(file, changed);
        expect_an_end(run(reader.arguments), file + ", change " + std::to_string(time) + " of seed " +
                                                 std::to_string(kSeed) + ":\n" + changed.substr(0, 2'000));
        if (HasFailure()) return;
      }
      write(file, sound);
    }
  }

  static constexpr std::uint64_t kSeed = 15;
  Folder folder_;
  std::mt19937_64 chance_{kSeed};
  int refused_ = 0;
};

TEST_F(BadFiles, TheCheckOfACellEndsWhateverItsFilesHold) {
  change_and_run({{"touchcald", "--check", "--cell", "{}/" + kCell, "--state", "{}/state"}, kCellFiles, 60});
  EXPECT_GT(refused_, 150);
}

TEST_F(BadFiles, AnIdentificationEndsWhateverItsFilesHold) {
  std::vector<std::string> files = kCellFiles;
  files.push_back(kTouches);
  change_and_run(
      {{"touchcal", "identify", "--cell", "{}/" + kCell, "--touches", "{}/" + kTouches}, files, 12});
  EXPECT_GT(refused_, 30);
}

TEST_F(BadFiles, AListOfTouchesAsTextEndsWhateverItHolds) {
  change_and_run(
      {{"touchcal", "identify", "--cell", "{}/" + kCell, "--touches", "{}/touches.csv", "--recipe", "edf-23"},
       {"touches.csv"},
       40});
  EXPECT_GT(refused_, 5);
}

TEST_F(BadFiles, AValidationEndsWhateverItsFilesHold) {
  change_and_run({{"touchcal", "validate", "--cell", "{}/" + kCell, "--touches", "{}/" + kTouches, "--other",
                   "{}/" + kTouches},
                  {kTouches, kRecipe},
                  10});
}

TEST_F(BadFiles, ACompensationEndsWhateverItsFilesHold) {
  write("arm.json", read("config/arms/tx90.json"));
  write("targets.json", R"({"schema":"touchcal/targets/2","tool":"stylus","line_max_mm":0.02,"targets":[
    {"name":"a","joints_deg":[20,30,60,10,50,-20]},
    {"name":"line","joints_deg":[0,30,60,10,50,-20],"move":"line"},
    {"name":"b","position_mm":[450,120,300],"rotation_deg":[180,0,90],"near_joints_deg":[15,40,80,0,60,0]}]})");
  write("targets.csv",
        "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\nb,1,2,30,4,50,6\n");
  for (const std::string targets : {"targets.json", "targets.csv"}) {
    change_and_run({{"touchcal", "compensate", "--cell", "{}/" + kCell, "--arm", "{}/arm.json", "--targets",
                     "{}/" + targets},
                    {"arm.json", targets},
                    60});
  }
  EXPECT_GT(refused_, 90);
}

TEST_F(BadFiles, APlanEndsWhateverItsFilesHold) {
  // Only what can be told before planning: a plan takes seconds.
  for (const std::string& file : kCellFiles) {
    const std::string sound = read(file);
    for (int time = 0; time < 6; ++time) {
      std::string changed = sound.substr(0, lot(sound.size()));
      if (time % 2 == 0) changed = sound.substr(0, changed.size()) + "\x01" + sound.substr(changed.size());
      write(file, changed);
      const Finished finished = run({"touchcal", "plan", "--cell", "{}/" + kCell, "--recipe", "edf-25"});
      EXPECT_EQ(finished.exit_code, cell::kExitBadInput) << file << '\n' << finished.err;
      expect_an_end(finished, file);
    }
    write(file, sound);
  }
}

TEST_F(BadFiles, TheSimulatedControllerRefusesTruthAndFaultsThatAreNone) {
  for (const std::string& file : {kTruth, std::string("faults.json")}) {
    const std::string sound = read(file);
    for (const std::string& changed :
         {std::string(), std::string("{"), std::string("[]"), std::string("null"),
          sound.substr(0, sound.size() / 2), sound + "x", std::string(10'000, '['), sound + sound,
          R"({"schema":"touchcal/else/1"})" + std::string(1, '\n')}) {
      write(file, changed);
      const Finished finished = run({"cs8sim", "--cell", "{}/" + kCell, "--truth", "{}/" + kTruth, "--faults",
                                     "{}/faults.json", "--listen", "127.0.0.1:0"});
      EXPECT_EQ(finished.exit_code, cell::kExitBadInput) << changed.substr(0, 100);
      expect_an_end(finished, file + ": " + changed.substr(0, 100));
    }
    write(file, sound);
  }
}

}  // namespace
}  // namespace touchcal::testing
