#include "sim_controller/val3/files/program_file.hpp"

#include <utility>

#include "sim_controller/val3/files/declared_names.hpp"
#include "sim_controller/val3/files/elements.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/language/parser.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

class ProgramReader {
 public:
  ProgramReader(Elements& in, const ProgramContext& context) : in_(in), context_(context) {}

  Program new_form(pugi::xml_node node) {
    in_.allow(node, {"name", "access"});
    in_.children(node, "Code", {"Description", "Parameters", "Locals"});
    Program program = named(node);
    const std::string access = Elements::optional(node, "access", "private");
    if (access != "public" && access != "private")
      in_.findings().error(file_rules::kBadValue, program.line, "access is " + shown_word(access),
                           "write public or private");
    program.is_public = access == "public";
    for (const pugi::xml_node one : in_.children(Elements::child(node, "Parameters"), "Parameter"))
      keep(program, new_parameter(one));
    for (const pugi::xml_node one : in_.children(Elements::child(node, "Locals"), "Local")) {
      in_.allow(one, {"name", "type", "size"});
      keep(program, local(one));
    }
    code(program, node, Elements::child(node, "Code"));
    return program;
  }

  Program old_form(pugi::xml_node node) {
    in_.allow(node, {"name", "public"});
    in_.children(node, "source", {"description", "paramSection", "localSection"});
    Program program = named(node);
    program.is_public = in_.truth(node, "public", false);
    for (const pugi::xml_node one : in_.children(Elements::child(node, "paramSection"), "param")) {
      in_.allow(one, {"name", "type", "byVal"});
      Parameter parameter{.name = in_.required(one, "name"), .line = in_.line_of(one)};
      parameter.type = type(one, parameter.line);
      // Every variable of s5 and s6 is an array, and a reference is to its rest (manual 6, page 22).
      parameter.by_reference = !in_.truth(one, "byVal", true);
      parameter.dimensions = parameter.by_reference ? 1 : 0;
      keep(program, std::move(parameter));
    }
    for (const pugi::xml_node one : in_.children(Elements::child(node, "localSection"), "local")) {
      in_.allow(one, {"name", "type", "size"});
      keep(program, local(one));
    }
    code(program, node, Elements::child(Elements::child(node, "source"), "code"));
    return program;
  }

 private:
  Program named(pugi::xml_node node) {
    names_ = DeclaredNames(context_.language);
    budget_ = ElementBudget(kLocalElementsMax);
    return {.name = in_.required(node, "name"), .file = in_.findings().file(), .line = in_.line_of(node)};
  }

  Type type(pugi::xml_node node, int line) {
    const std::string word = in_.required(node, "type");
    const Type found = context_.words.find(word);
    if (found.kind == Kind::kVoid && !word.empty())
      in_.findings().error(file_rules::kUnknownType, line, shown_word(word) + " is no type",
                           "list it under Types");
    return found;
  }

  // What has a name that is taken stays: calls would miss an argument for it.
  void keep(Program& program, Parameter parameter) {
    if (parameter.name.empty()) return;
    names_.add(parameter.name, "parameter", parameter.line, in_.findings());
    program.parameters.push_back(std::move(parameter));
  }
  void keep(Program& program, Declaration local) {
    if (local.name.empty() || !names_.add(local.name, "local variable", local.line, in_.findings())) return;
    program.locals.push_back(std::move(local));
  }

  Parameter new_parameter(pugi::xml_node node) {
    in_.allow(node, {"name", "type", "use", "dimensions"});
    Parameter parameter{.name = in_.required(node, "name"), .line = in_.line_of(node)};
    parameter.type = type(node, parameter.line);
    const std::string use = Elements::optional(node, "use", "value");
    if (use != "value" && use != "reference")
      in_.findings().error(file_rules::kBadValue, parameter.line, "use is " + shown_word(use),
                           "write value or reference");
    parameter.by_reference = use == "reference";
    const std::string_view form = schema_type_of(node);
    const bool is_array = form == "array" || form == "collection";
    if (!is_array && !form.empty() && form != "element")
      in_.findings().error(file_rules::kBadValue, parameter.line, "xsi:type is " + shown_word(form),
                           "write element or array");
    const std::string dimensions = Elements::optional(node, "dimensions", "1");
    const auto count = whole_number(dimensions, 3);
    if (!count || *count == 0)
      in_.findings().error(file_rules::kBadSize, parameter.line, "dimensions is " + shown_word(dimensions),
                           "write 1, 2 or 3");
    parameter.dimensions = is_array && count ? static_cast<int>(*count) : 0;
    if (is_array && !parameter.by_reference)
      in_.findings().error(file_rules::kArrayByValue, parameter.line,
                           parameter.name + " is an array and is passed by value", "write use=\"reference\"");
    return parameter;
  }

  Declaration local(pugi::xml_node node) {
    Declaration result{
        .name = in_.required(node, "name"), .file = in_.findings().file(), .line = in_.line_of(node)};
    result.type = type(node, result.line);
    if (schema_type_of(node) == "collection") {
      result.sizes.clear();
      return result;
    }
    const std::string text = Elements::optional(node, "size", "1");
    std::vector<std::size_t> sizes = sizes_in(text);
    const std::size_t each = ElementBudget::of(result.type, context_.elements_of_user);
    if (sizes.empty())
      in_.findings().error(file_rules::kBadSize, result.line, "the size is " + shown_word(text),
                           "write one to three numbers of elements");
    else if (!budget_.take(ElementBudget::of(sizes, each)))
      in_.findings().error(file_rules::kBadSize, result.line,
                           "the locals of a program have more than " + std::to_string(kLocalElementsMax) +
                               " elements together",
                           "make it a variable of the application");
    else
      result.sizes = std::move(sizes);
    return result;
  }

  void code(Program& program, pugi::xml_node owner, pugi::xml_node node) {
    const XmlFile::Text text = in_.text_of(node);
    if (!node || text.text.find_first_not_of(" \t\r\n") == std::string::npos) {
      in_.findings().error(file_rules::kNoCode, in_.line_of(owner), "the program has no code",
                           "write at least begin and end");
      program.lines.push_back({.kind = Line::Kind::kEnd, .line = in_.line_of(owner)});
      return;
    }
    Findings& all = in_.findings().all();
    const std::size_t before = all.size();
    program.lines = parse(text.text, in_.findings().file(), text.line, all);
    if (context_.language.major >= 7) return;
    for (std::size_t i = before; i < all.size(); ++i)  // a fact of s5 and s6; of s7 nothing is known
      if (all[i].rule == syntax_rules::kStringTooLong) all[i].severity = Severity::kError;
  }

  Elements& in_;
  const ProgramContext& context_;
  DeclaredNames names_{Version{}};
  ElementBudget budget_{kLocalElementsMax};
};

}  // namespace

void read_program_file(const XmlFile& xml, const ProgramContext& context, FileFindings& findings,
                       std::vector<Program>& programs) {
  Elements in(xml, findings);
  ProgramReader reader(in, context);
  const std::size_t before = programs.size();
  const pugi::xml_node root = xml.root();
  if (xml.root_name() == "Programs" &&
      xml.root_space().starts_with("http://www.staubli.com/robotics/VAL3/Program/")) {
    for (const pugi::xml_node node : in.children(root, "Program")) programs.push_back(reader.new_form(node));
  } else if (xml.root_name() == "programList" && xml.root_space() == "ProgramNameSpace") {
    for (const pugi::xml_node node : in.children(root, "program")) programs.push_back(reader.old_form(node));
  } else {
    return findings.error(file_rules::kUnknownForm, xml.line_of(root),
                          shown_word(xml.root_name()) + " of " + shown_word(xml.root_space()) +
                              " is no VAL3 program of s5 to s8");
  }
  if (programs.size() == before)
    findings.error(file_rules::kNoCode, xml.line_of(root), "the file holds no program");
  std::erase_if(programs, [](const Program& program) { return program.name.empty(); });
}

}  // namespace val3
