#include "service/offline_programs/program_text.hpp"

#include <algorithm>

#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr std::string_view kNewProgramSpace = "http://www.staubli.com/robotics/VAL3/Program/";

class ProgramTextReader {
 public:
  explicit ProgramTextReader(const XmlText& xml) : xml_(xml) {}

  ProgramText new_form(pugi::xml_node node) {
    ProgramText program{.name = node.attribute("name").value(), .file = xml_.source()};
    declared(program, element_named(node, "Parameters"), "Parameter", true);
    declared(program, element_named(node, "Locals"), "Local", false);
    code(program, element_named(node, "Code"));
    return program;
  }

  ProgramText old_form(pugi::xml_node node) {
    ProgramText program{.name = node.attribute("name").value(), .file = xml_.source()};
    declared(program, element_named(node, "paramSection"), "param", true);
    declared(program, element_named(node, "localSection"), "local", false);
    code(program, element_named(element_named(node, "source"), "code"));
    return program;
  }

 private:
  static void declared(ProgramText& program, pugi::xml_node section, std::string_view word,
                       bool is_parameter) {
    for (const pugi::xml_node one : section.children()) {
      if (one.type() != pugi::node_element || unprefixed(one.name()) != word) continue;
      const std::string name = one.attribute("name").value();
      std::string type;
      for (const pugi::xml_attribute attribute : one.attributes())
        if (std::string_view(attribute.name()) == "type") type = attribute.value();  // not xsi:type
      if (is_parameter) program.parameters.push_back(name);
      program.own_types.emplace(name, type);
    }
  }

  void code(ProgramText& program, pugi::xml_node node) {
    for (const pugi::xml_node part : node.children()) {
      if (part.type() != pugi::node_pcdata && part.type() != pugi::node_cdata) continue;
      int number = xml_.line_at(xml_.place_of(part.value()));
      std::string_view text = part.value();
      while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (end > kProgramLineBytesMax)
          xml_.fail_at_line(number, "the line has " + std::to_string(end) + " bytes, more than the " +
                                        std::to_string(kProgramLineBytesMax) + " that are read; divide it");
        program.lines.push_back({number++, std::string(text.substr(0, end))});
        text.remove_prefix(std::min(end + 1, text.size()));
      }
    }
  }

  const XmlText& xml_;
};

}  // namespace

std::vector<ProgramText> read_program_text(const XmlText& xml) {
  const std::string_view name = unprefixed(xml.root().name());
  const bool is_new = name == "Programs" && xml.root_space().starts_with(kNewProgramSpace);
  if (!is_new && !(name == "programList" && xml.root_space() == "ProgramNameSpace"))
    xml.fail(xml.root(), in_quotes(std::string(name)) + " of " + in_quotes(std::string(xml.root_space())) +
                             " is no VAL3 program of s5 to s8; give a .pgx file");
  ProgramTextReader reader(xml);
  std::vector<ProgramText> programs;
  for (const pugi::xml_node node : xml.root().children())
    if (node.type() == pugi::node_element && unprefixed(node.name()) == (is_new ? "Program" : "program"))
      programs.push_back(is_new ? reader.new_form(node) : reader.old_form(node));
  return programs;
}

}  // namespace cell
