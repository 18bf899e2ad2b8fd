// How long `cs8sim --check` takes for an application of 1,000 programs: reading its files, names and types,
// and the checks, each by itself. Prints the medians of some rounds; ends with 1 when something is found in
// the application, or with --judge when the median of the whole is not under the promised time.
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sim_controller/val3/checks/checks.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRounds = 5;
constexpr int kPrograms = 1000;
constexpr int kGlobals = 500;
constexpr int kPartsOfAProgram = 4;  // of twelve lines each
constexpr double kPromised_s = 1.0;

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string numbered(const char* word, int number) { return word + std::to_string(number); }

/// Lines as applications have them: blocks, calls by value and by reference, texts, points, a loop that ends.
std::string part_of_a_program(int program, int part) {
  const std::string number = numbered("nValue", (7 * program + part) % kGlobals);
  const std::string next = numbered("part", std::min(program + 1 + part, kPrograms - 1));
  return "  l_nSum=0\n"
         "  for l_nI=0 to size(nTable)-1\n"
         "    l_nSum=l_nSum+nTable[l_nI]*" +
         number +
         "%7\n"
         "  endFor\n"
         "  if l_nSum>100 and !bStop\n"
         "    pHere=appro(pHere,{0,0,-10,0,0,0})\n"
         "    sText=\"sum \"+toString(\".2\",l_nSum)+mid(sText,len(sText)-1,1)\n"
         "  elseIf isInRange(herej())\n"
         "    " +
         number +
         "=limit(abs(l_nSum),x_nLow,100)\n"
         "  endIf\n" +
         (program + 1 < kPrograms ? "  call " + next + "(l_nSum," + number + ")\n"
                                  : std::string("  delay(0)\n")) +
         "  x_nOut=l_nSum\n";
}

std::string program_file(const std::string& name, const std::string& declared, const std::string& code) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
         "<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n<Program name=\"" +
         name + "\">\n" + declared + "<Code><![CDATA[begin\n" + code +
         "end]]></Code>\n</Program>\n</Programs>\n";
}

std::string variable(const std::string& name, const char* type, int size, const char* value) {
  std::string text = "<Data name=\"" + name + "\" access=\"private\" xsi:type=\"array\" type=\"" + type +
                     "\" size=\"" + std::to_string(size) + "\">";
  for (int i = 0; i < size; ++i) text += "<Value key=\"" + std::to_string(i) + "\" " + value + "/>";
  return text + "</Data>\n";
}

void write_application(const std::filesystem::path& folder) {
  std::string listed = "<Program file=\"start.pgx\"/><Program file=\"stop.pgx\"/>";
  const std::string declared =
      "<Parameters xmlns=\"http://www.staubli.com/robotics/VAL3/Param/1\">"
      "<Parameter name=\"x_nLow\" type=\"num\" xsi:type=\"element\"/>"
      "<Parameter name=\"x_nOut\" type=\"num\" xsi:type=\"element\" use=\"reference\"/></Parameters>\n"
      "<Locals><Local name=\"l_nSum\" type=\"num\" xsi:type=\"array\" size=\"1\"/>"
      "<Local name=\"l_nI\" type=\"num\" xsi:type=\"array\" size=\"1\"/></Locals>\n";
  for (int program = 0; program < kPrograms; ++program) {
    std::string code;
    for (int part = 0; part < kPartsOfAProgram; ++part) code += part_of_a_program(program, part);
    const std::string name = numbered("part", program);
    write(folder / (name + ".pgx"), program_file(name, declared, code));
    listed += "<Program file=\"" + name + ".pgx\"/>\n";
  }
  write(folder / "start.pgx", program_file("start", "", "  taskCreate \"work\",10,part0(1,nValue0)\n"));
  write(folder / "stop.pgx", program_file("stop", "", "  taskKill(\"work\")\n"));
  std::string data = variable("bStop", "bool", 1, "value=\"false\"") +
                     variable("sText", "string", 1, "value=\"x\"") +
                     variable("nTable", "num", 20, "value=\"3\"") +
                     variable("pHere", "pointRx", 1, "x=\"1\" fatherId=\"world[0]\"");
  for (int global = 0; global < kGlobals; ++global)
    data += variable(numbered("nValue", global), "num", 1, "value=\"1\"");
  write(folder / "large.dtx",
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n<Datas>\n" +
            data + "</Datas>\n</Database>\n");
  write(folder / "large.pjx",
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">\n"
        "<Parameters version=\"s7.7.2\" stackSize=\"5000\" millimeterUnit=\"true\"/>\n<Programs>" +
            listed + "</Programs>\n<Database><Data file=\"large.dtx\"/></Database>\n</Project>\n");
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const bool judge = argc > 1 && std::strcmp(argv[1], "--judge") == 0;
  std::string folder = (std::filesystem::temp_directory_path() / "check_benchmark_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) {
    std::perror("no temporary folder");
    return 1;
  }
  write_application(folder);
  std::vector<double> read_s, resolved_s, checked_s, whole_s;
  std::size_t above_a_note = 0, lines = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = Clock::now();
    val3::ReadApplication read = val3::read_application(folder);
    read_s.push_back(seconds_since(begin));
    const auto resolving = Clock::now();
    val3::resolve(read.application, read.findings);
    resolved_s.push_back(seconds_since(resolving));
    const auto checking = Clock::now();
    val3::check(read.application, {}, read.findings);
    checked_s.push_back(seconds_since(checking));
    whole_s.push_back(seconds_since(begin));
    lines = 0;
    for (const val3::Program& program : read.application.programs) lines += program.lines.size();
    for (const val3::Finding& finding : read.findings) {
      if (finding.severity == val3::Severity::kNote) continue;
      ++above_a_note;
      std::printf("%s:%d: %s\n", finding.at.file.c_str(), finding.at.line, finding.what.c_str());
    }
  }
  std::filesystem::remove_all(folder);
  const bool is_kept = median(whole_s) < kPromised_s;
  std::printf(
      "%d programs, %zu lines: read %.3f s, names and types %.3f s, checks %.3f s, whole %.3f s  (under %.1f "
      "s: %s)\n",
      kPrograms, lines, median(read_s), median(resolved_s), median(checked_s), median(whole_s), kPromised_s,
      is_kept ? "met" : "MISSED");
  return above_a_note > 0 || (judge && !is_kept) ? 1 : 0;
}
