// Files drawn by chance: everything but the numbers of the marked variables stays byte for byte.
#include <gmock/gmock.h>

#include <functional>
#include <random>
#include <string_view>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

constexpr int kFiles = 300;
constexpr double kStepMm = 0.125;       // of x, y and z of a point, in the world
constexpr double kJointStepDeg = 0.25;  // of the first joint, twice that of the second, ...

/// Draws a file of s5/s6 or of s7, and the file that the filter has to make of it, at once.
class DrawnFile {
 public:
  explicit DrawnFile(std::uint64_t seed) : chance_(seed) {
    end_ = one_of({"\n", "\r\n"});
    is_new_ = chance(2) == 0;
    if (chance(2) == 0) both(kBom);
    is_new_ ? new_form() : old_form();
  }

  std::string before, after, list;

 private:
  using Names = std::array<const char*, 6>;
  static constexpr Names kTrsf{"x", "y", "z", "rx", "ry", "rz"};
  static constexpr Names kJoint{"j1", "j2", "j3", "j4", "j5", "j6"};

  int chance(int sides) { return std::uniform_int_distribution<int>(0, sides - 1)(chance_); }
  std::string one_of(std::initializer_list<const char*> words) {
    return words.begin()[chance(static_cast<int>(words.size()))];
  }
  void both(const std::string& text) {
    before += text;
    after += text;
  }
  /// What may stand between elements.
  void between() {
    both(end_ + std::string(static_cast<std::size_t>(chance(5)), chance(2) == 0 ? ' ' : '\t'));
    switch (chance(6)) {
      case 0:
        return both("<!-- <Value key=\"0\" x=\"1\" j1='2'/> <valuePoint> -->" + end_);
      case 1:
        return both("<?tool <Value x=\"1\"/> ?>" + end_);
      default:
        return;
    }
  }

  /// A number as a programmer writes it; multiples of 1/8, which binary and decimal numbers both hold.
  std::string drawn_number(double& value) {
    value = 0.125 * (chance(16'000) - 8'000);
    std::string text = stored_number(value);
    switch (chance(4)) {
      case 0:
        return text + (text.find('.') == std::string::npos ? ".000" : "00");
      case 1:
        return value > 0 ? '+' + text : text;
      default:
        return text;
    }
  }

  /// The six numbers of an element, moved by `step` in `after`.
  void numbers(const Names& names, const std::array<double, 6>& step) {
    for (std::size_t i = 0; i < 6; ++i) {
      const bool is_left_out = is_new_ && chance(3) == 0;
      double value = 0.0;
      const std::string text = is_left_out ? "" : drawn_number(value);
      const bool is_same = step[i] == 0.0;
      const std::string moved = is_same ? text : stored_number(value + step[i]);
      if (is_left_out) {
        if (!is_same) after += std::string(" ") + names[i] + "=" + quote_ + moved + quote_;
        continue;
      }
      both(one_of({" ", "  ", " "}) + names[i] + "=");
      before += quote_ + text + quote_;
      after += quote_ + moved + quote_;
    }
  }

  std::array<double, 6> step_of(const std::string& type, bool is_offline) const {
    if (!is_offline) return {};
    if (type.starts_with("point")) return {kStepMm, kStepMm, kStepMm, 0, 0, 0};
    std::array<double, 6> step{};
    for (std::size_t i = 0; i < 6; ++i) step[i] = kJointStepDeg * static_cast<double>(i + 1);
    return step;
  }

  /// Adds the name to the list; true for offline. What is no place mostly needs no line.
  bool listed(const std::string& name, const std::string& type) {
    const bool is_place = type.starts_with("point") || type.starts_with("joint");
    const std::string mark = is_place ? one_of({"offline", "taught", "leave"}) : "leave";
    if (is_place || chance(2) == 0) list += name + ' ' + mark + end_;
    return is_place && mark == "offline";
  }

  void new_form() {
    both(one_of({"<?xml version=\"1.0\" encoding=\"utf-8\"?>", "<?xml version='1.0'?>", ""}));
    between();
    both(
        "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">");
    between();
    both("<Datas>");
    const int count = chance(12);
    for (int i = 0; i < count; ++i) new_variable("v" + std::to_string(i));
    between();
    both("</Datas></Database>" + end_);
  }

  void new_variable(const std::string& name) {
    const std::string type = one_of({"pointRx", "jointRx", "pointRx", "jointRx", "trsf", "frame", "tool"});
    const bool is_offline = listed(name, type);
    const int values = chance(6);
    between();
    both("<Data name=\"" + name + "\" access=\"public\" xsi:type=\"array\" type=\"" + type + "\" size=\"" +
         std::to_string(values + chance(2) + 1) + "\">");
    for (int i = 0; i < values; ++i) {
      between();
      quote_ = one_of({"\"", "'"});
      both("<Value key=" + quote_ + std::to_string(i) + quote_);
      numbers(type == "jointRx" ? kJoint : kTrsf, step_of(type, is_offline));
      if (type != "jointRx" && type != "trsf")
        both(" fatherId=" + quote_ + (type == "tool" ? "flange[0]" : "world[0]") + quote_);
      both(one_of({"/>", " />", "></Value>"}));
    }
    both(end_ + "</Data>");
  }

  void old_form() {
    both("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + end_ + "<dataList xmlns=\"DataNameSpace\">");
    for (const std::string type : {"frame", "joint", "point", "trsf"}) {
      between();
      both("<" + type + "Section>");
      const int count = chance(4);
      for (int i = 0; i < count; ++i) old_variable(type, type + std::to_string(i));
      both("</" + type + "Section>");
    }
    both(
        "<stringSection><string name=\"s\"><valueString index=\"0\" value=\"caf\xE9\"/></string>"
        "</stringSection>" +
        end_ + "</dataList>");
  }

  void old_variable(const std::string& type, const std::string& name) {
    const bool is_offline = listed(name, type);
    between();
    both("<" + type + " name=\"" + name + "\" public=\"false\">");
    if (type == "point") both("<pFather alias=\"\" name=\"world\" fatherIndex=\"0\"/>");
    if (type == "frame") both("<fFather alias=\"\" name=\"\" fatherIndex=\"0\"/>");
    const std::string upper = static_cast<char>(type[0] - 'a' + 'A') + type.substr(1);
    const std::string inner = type == "point" ? "tpValue" : type == "frame" ? "tfValue" : type + "Value";
    for (int i = chance(4); i >= 0; --i) {
      between();
      quote_ = one_of({"\"", "'"});
      both("<value" + upper + " index=\"" + std::to_string(i) + "\"><" + inner);
      numbers(type == "joint" ? kJoint : kTrsf, step_of(type, is_offline));
      both("/>");
      if (type == "point") both("<cpValue shoulder=\"same\" elbow=\"same\" wrist=\"same\"/>");
      both("</value" + upper + ">");
    }
    both("</" + type + ">");
  }

  std::mt19937_64 chance_;
  std::string end_, quote_;
  bool is_new_ = false;
};

TEST(RandomDataFiles, ChangeByTheNumbersOfTheMarkedVariablesAndNothingElse) {
  int changed = 0;
  for (std::uint64_t seed = 0; seed < kFiles; ++seed) {
    const DrawnFile file(seed);
    const FilteredData found =
        filtered(file.before, file.list, shifted_by(Eigen::Vector3d::Constant(kStepMm), kJointStepDeg));
    ASSERT_EQ(found.text, file.after) << "seed " << seed << "\n" << file.list << file.before;
    changed += found.text != file.before ? 1 : 0;
  }
  EXPECT_GT(changed, kFiles / 2) << "the test draws too little to mean anything";
}

TEST(RandomDataFiles, StayAsTheyAreWhereNothingIsCorrected) {
  for (std::uint64_t seed = 0; seed < kFiles; ++seed) {
    const DrawnFile file(seed);
    ASSERT_EQ(filtered(file.before, file.list, unchanged()).text, file.before) << "seed " << seed;
  }
}

// Bytes that are turned, taken out and put in, by chance: refused by name, or read; never anything else.
TEST(RandomDataFiles, AreRefusedOrReadWhenTheyAreDamaged) {
  int refused = 0, read = 0;
  std::mt19937_64 chance(11);
  constexpr std::string_view kSigns = "<>\"'&;=/!-[]? \t\r\n0.xz\xC3";
  for (std::uint64_t seed = 0; seed < kFiles; ++seed) {
    const DrawnFile file(seed);
    for (int round = 0; round < 10; ++round) {
      std::string damaged = file.before;
      for (int i = 0; i <= round / 2; ++i) {
        const std::size_t at = chance() % damaged.size();
        const char sign = kSigns[chance() % kSigns.size()];
        switch (chance() % 4) {
          case 0:
            damaged[at] = sign;
            break;
          case 1:
            damaged.insert(at, 1, sign);
            break;
          case 2:
            damaged.erase(at, 1);
            break;
          default:
            damaged.erase(at, chance() % 40);
        }
        if (damaged.empty()) damaged = "<";
      }
      try {
        const std::string changed = filtered(damaged, file.list, shifted_by({1, 1, 1})).text;
        EXPECT_NO_THROW(XmlText("changed.dtx", changed)) << "what was read stays XML; seed " << seed;
        ++read;
      } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("; ")) << "with what to do";
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, kFiles) << "the test damages too little to mean anything";
  EXPECT_GT(read, kFiles);
}

// Angles of every writing, in frames that turn: back in their own frame the numbers are the ones that were
// there.
TEST(RandomDataFiles, KeepAllDecimalsOfPointsInTurnedFrames) {
  std::mt19937_64 chance(3);
  std::uniform_real_distribution<double> length(-1500, 1500), angle(-360, 360);
  const auto trsf = [&] {
    std::string text;
    for (const char* name : {"x", "y", "z"})
      text += std::string(" ") + name + "=\"" + std::to_string(length(chance)) + '"';
    for (const char* name : {"rx", "ry", "rz"})
      text += std::string(" ") + name + "=\"" + std::to_string(angle(chance)) + '"';
    return text;
  };
  std::string points;
  for (int i = 0; i < 2000; ++i)
    points += value("key=\"" + std::to_string(i) + "\"" + trsf() + " fatherId=\"fB[0]\"");
  const std::string data =
      new_data(variable("fA", "frame", value("key=\"0\"" + trsf() + " fatherId=\"world[0]\"")) +
               variable("fB", "frame", value("key=\"0\"" + trsf() + " fatherId=\"fA[0]\"")) +
               variable("pA", "pointRx", points, "2000"));
  EXPECT_EQ(filtered(data, "pA offline", unchanged()).text, data);
}

}  // namespace
}  // namespace cell
