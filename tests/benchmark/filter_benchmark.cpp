// How long the filter takes for a VAL3 data file of 10,000 points, two frames deep, with a corrector that
// costs nothing, and for the warnings about 200 programs that use them. Prints the medians of some rounds;
// ends with 1 when something is wrong in what it made, or with --judge when the median of the filter is not
// under the promised time.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "service/offline_programs/data_filter.hpp"
#include "service/offline_programs/program_warnings.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRounds = 5;
constexpr int kPoints = 10'000;
constexpr int kPrograms = 200;
constexpr int kUsesOfAProgram = 50;
constexpr double kPromised_s = 1.0;
constexpr double kStep_m = 1e-3;

std::string data_file() {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n"
      "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\r\n  <Datas>\r\n"
      "    <Data name=\"fTable\" access=\"private\" xsi:type=\"array\" type=\"frame\" size=\"1\">\r\n"
      "      <Value key=\"0\" x=\"400\" z=\"-200\" rz=\"90\" fatherId=\"world[0]\" />\r\n    </Data>\r\n"
      "    <Data name=\"fPiece\" access=\"private\" xsi:type=\"array\" type=\"frame\" size=\"1\">\r\n"
      "      <Value key=\"0\" x=\"40\" y=\"7.5\" rx=\"1.25\" fatherId=\"fTable[0]\" />\r\n    </Data>\r\n"
      "    <Data name=\"pPath\" access=\"private\" xsi:type=\"array\" type=\"pointRx\" size=\"" +
      std::to_string(kPoints) + "\">\r\n";
  for (int i = 0; i < kPoints; ++i)
    text += "      <Value key=\"" + std::to_string(i) + "\" x=\"" + std::to_string(0.25 * i) + "\" y=\"" +
            std::to_string(-0.125 * i) + "\" rx=\"180\" rz=\"" + std::to_string(i % 360) +
            ".5\" shoulder=\"righty\" elbow=\"epositive\" wrist=\"wpositive\" fatherId=\"fPiece[0]\" />\r\n";
  return text + "    </Data>\r\n  </Datas>\r\n</Database>\r\n";
}

std::vector<cell::ProgramFile> program_files() {
  std::vector<cell::ProgramFile> files;
  for (int program = 0; program < kPrograms; ++program) {
    std::string code;
    for (int use = 0; use < kUsesOfAProgram; ++use)
      code += "  movej(appro(pPath[" + std::to_string(use) +
              "],{0,0,-100,0,0,0}),tGrip,mFast)\n  if bFast\n  movel(pPath[i],tGrip,mSlow)\n  endIf\n";
    const std::string name = "path" + std::to_string(program);
    files.push_back({name + ".pgx",
                     "<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n<Program name=\"" +
                         name + "\">\n<Code><![CDATA[begin\n" + code +
                         "end]]></Code>\n</Program>\n</Programs>\n"});
  }
  return files;
}

/// Every point a millimetre along the world's z.
cell::Correction lifted(const cell::OfflineTarget& target) {
  cell::Correction correction{.status = cell::CorrectionStatus::kOk};
  correction.world_from_tool = std::get<cell::OfflinePose>(target.place).world_from_tool;
  correction.world_from_tool.pretranslate(Eigen::Vector3d(0.0, 0.0, kStep_m));
  return correction;
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Without the numbers in quotes.
std::string frame_of(const std::string& text) {
  std::string frame;
  for (std::size_t at = 0; at < text.size(); ++at) {
    frame += text[at];
    if (text[at] != '"') continue;
    const std::size_t end = text.find('"', at + 1);
    const std::string value = text.substr(at + 1, end - at - 1);
    if (value.find_first_not_of("+-.0123456789") != std::string::npos) frame += value;
    frame += '"';
    at = end;
  }
  return frame;
}

/// The attribute that was left out and is none any more, taken out again.
std::string without_inserted_z(std::string frame) {
  constexpr std::string_view kInserted = " z=\"\" rx=\"\"";
  constexpr std::string_view kLeftOut = " rx=\"\"";
  for (std::size_t at = frame.find(kInserted); at != std::string::npos; at = frame.find(kInserted, at))
    frame.replace(at, kInserted.size(), kLeftOut);
  return frame;
}

}  // namespace

int main(int argc, char** argv) {
  const bool judge = argc > 1 && std::strcmp(argv[1], "--judge") == 0;
  const std::string original = data_file();
  const std::vector<cell::ProgramFile> programs = program_files();
  const cell::FilterList list = cell::parse_filter_list("points.list", "pPath offline gripper\n");
  std::vector<double> filter_s, warnings_s;
  bool is_right = true;
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = Clock::now();
    const cell::FilteredData filtered = cell::filter_data("cell.dtx", original, list, lifted);
    filter_s.push_back(seconds_since(begin));
    const auto reading = Clock::now();
    const cell::ProgramWarnings found = cell::program_warnings(programs, filtered);
    warnings_s.push_back(seconds_since(reading));
    is_right &=
        filtered.count(cell::CorrectionStatus::kOk) == kPoints && filtered.text != original &&
        without_inserted_z(frame_of(filtered.text)) == frame_of(original) && found.unread.empty() &&
        found.is_cut == (2 * kPrograms * kUsesOfAProgram > static_cast<int>(cell::kProgramWarningsMax)) &&
        !found.warnings.empty();
  }
  const bool is_kept = median(filter_s) < kPromised_s;
  std::printf(
      "%d points, %.1f MB: filtered in %.3f s; warnings about %d programs %.3f s  (under %.1f s: %s); %s\n",
      kPoints, 1e-6 * static_cast<double>(original.size()), median(filter_s), kPrograms, median(warnings_s),
      kPromised_s, is_kept ? "met" : "MISSED", is_right ? "all but the numbers byte for byte" : "WRONG");
  return !is_right || (judge && !is_kept) ? 1 : 0;
}
