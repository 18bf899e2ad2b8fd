#include "tests/val3/application.hpp"

#include <fstream>
#include <iterator>
#include <set>

#include "tests/val3/data_file.hpp"
#include "tests/val3/parser.hpp"
#include "tests/val3/xml.hpp"

namespace val3 {
namespace {

constexpr std::string_view kSpace = "http://www.staubli.com/robotics/VAL3/";

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Problem{file.filename().string(), 0, "cannot be read"};
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Loader {
 public:
  explicit Loader(const std::filesystem::path& project)
      : folder_(project.parent_path()), file_(project.filename().string()) {}

  Loaded load() {
    loaded_.application.name = folder_.filename().string();
    for (const auto& [name, type] : {std::pair{"world", Type::kFrame}, {"flange", Type::kTool}})
      loaded_.application.globals[name] = {.type = type, .place = new_variable(type, 1)};
    std::get<Frame>((*loaded_.application.globals["world"].place.elements)[0]).name = "world";
    try {
      project(read_xml(bytes_of(folder_ / file_), file_));
    } catch (const Problem& problem) {
      loaded_.problems.push_back(problem);
    }
    return std::move(loaded_);
  }

 private:
  void complain(const std::string& file, int line, const std::string& text) {
    loaded_.problems.push_back({file, line, text});
  }

  void project(const Element& root) {
    if (root.name != "Project" || root.space != std::string(kSpace) + "Project/3")
      complain(file_, root.line, "not a Project of namespace VAL3/Project/3");
    if (loaded_.application.name + ".pjx" != file_)
      complain(file_, root.line, "the folder and the project do not have the same name");
    const Element* parameters = root.child("Parameters");
    if (parameters == nullptr || parameters->attribute("version").empty() ||
        parameters->attribute("stackSize").empty() || parameters->attribute("millimeterUnit") != "true")
      complain(file_, root.line, "Parameters needs version, stackSize and millimeterUnit=\"true\"");
    for (const Element& section : root.children)
      if (!std::set<std::string>{"Parameters", "Programs", "Database", "Libraries", "Types"}.contains(
              section.name))
        complain(file_, section.line, "<" + section.name + "> in a Project");

    // data first: nothing in a program needs it, but its mistakes are read first
    for_each_file(root, "Database", "Data", [this](const Element& e, const std::string& f) { data(e, f); });
    for_each_file(root, "Programs", "Program",
                  [this](const Element& e, const std::string& f) { program(e, f); });
    for (const char* needed : {"start", "stop"})
      if (!loaded_.application.programs.contains(needed))
        complain(file_, root.line, std::string("no program ") + needed);
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name != file_ && !listed_.contains(name))
        complain(file_, 0, name + " lies in the folder but is not listed");
    }
  }

  template <class Read>
  void for_each_file(const Element& root, const char* section, const char* item, Read read) {
    const Element* list = root.child(section);
    if (list == nullptr) return complain(file_, root.line, std::string("no <") + section + ">");
    for (const Element& entry : list->children) {
      const std::string name = entry.attribute("file");
      if (entry.name != item || name.empty()) {
        complain(file_, entry.line, "<" + entry.name + "> without file, or out of place");
        continue;
      }
      if (!listed_.insert(name).second) complain(file_, entry.line, name + " is listed twice");
      try {
        read(read_xml(bytes_of(folder_ / name), name), name);
      } catch (const Problem& problem) {
        loaded_.problems.push_back(problem);
      }
    }
  }

  void data(const Element& root, const std::string& file) {
    read_data(root, file, loaded_.application, loaded_.problems);
  }

  void program(const Element& root, const std::string& file) {
    const Element* element = root.child("Program");
    if (root.name != "Programs" || root.space != std::string(kSpace) + "Program/2" || element == nullptr ||
        root.children.size() != 1)
      throw Problem{file, root.line, "not Programs of namespace VAL3/Program/2 with one Program"};
    Program program{.name = element->attribute("name"), .file = file};
    if (program.name + ".pgx" != file)
      throw Problem{file, element->line, "the program is not named as its file"};
    const std::string access = element->attribute("access");
    if (access != "public" && access != "private" && !access.empty())
      throw Problem{file, element->line, "access is neither public nor private"};
    if (const Element* list = element->child("Parameters")) parameters(*list, program);
    if (const Element* list = element->child("Locals")) locals(*list, program);
    const Element* code = element->child("Code");
    if (code == nullptr) throw Problem{file, element->line, "no Code"};
    long_lines(code->text, file, code->text_line);
    program.statements = parse(code->text, file, code->text_line);
    loaded_.application.programs[program.name] = std::move(program);
  }

  static void parameters(const Element& list, Program& program) {
    if (list.space != std::string(kSpace) + "Param/1")
      throw Problem{program.file, list.line, "Parameters not of namespace VAL3/Param/1"};
    for (const Element& element : list.children) {
      const std::string shape = element.attribute("xsi:type");
      const std::string use = element.attribute("use");
      Parameter parameter{.name = element.attribute("name"),
                          .type = type_named(element.attribute("type")),
                          .is_array = shape == "array",
                          .by_reference = use == "reference"};
      if (element.name != "Parameter" || parameter.type == Type::kNone ||
          (shape != "element" && shape != "array") || (use != "reference" && !use.empty()))
        throw Problem{program.file, element.line,
                      "a parameter needs name, type and xsi:type element or array"};
      if (parameter.is_array && use != "reference")
        throw Problem{program.file, element.line,
                      parameter.name + ": an array is never passed by value: use=\"reference\""};
      program.parameters.push_back(std::move(parameter));
    }
  }

  static void locals(const Element& list, Program& program) {
    for (const Element& element : list.children) {
      const std::string size = element.attribute("size");
      Local local{.name = element.attribute("name"), .type = type_named(element.attribute("type"))};
      if (element.name != "Local" || local.type == Type::kNone || element.attribute("xsi:type") != "array" ||
          size.empty() || size.size() > 4 || size.find_first_not_of("0123456789") != std::string::npos ||
          size == "0")
        throw Problem{program.file, element.line, "a local needs name, type, xsi:type array and size"};
      local.size = std::stoul(size);
      program.locals.push_back(std::move(local));
    }
  }

  void long_lines(std::string_view code, const std::string& file, int line) {
    constexpr std::size_t kLongest = 120;
    while (!code.empty()) {
      const std::size_t end = std::min(code.find('\n'), code.size());
      const std::string_view text = code.substr(0, end);
      if (text.size() - (text.ends_with('\r') ? 1 : 0) > kLongest)
        complain(file, line, "a line of more than 120 characters");
      if (text.find_first_not_of(kPrintable) != std::string_view::npos)
        complain(file, line, "a character that is not ASCII");
      code.remove_prefix(std::min(end + 1, code.size()));
      ++line;
    }
  }

  static inline const std::string kPrintable = [] {
    std::string all = "\t\r";
    for (char c = ' '; c <= '~'; ++c) all += c;
    return all;
  }();

  std::filesystem::path folder_;
  std::string file_;
  std::set<std::string> listed_;
  Loaded loaded_;
};

}  // namespace

Loaded load(const std::filesystem::path& project_file) { return Loader(project_file).load(); }

}  // namespace val3
