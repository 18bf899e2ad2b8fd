#include "sim_controller/val3/files/project_file.hpp"

#include <algorithm>

#include "sim_controller/val3/files/elements.hpp"
#include "sim_controller/val3/files/file_rules.hpp"

namespace val3 {
namespace {

constexpr std::string_view kOldProjectSpace = "ProjectNameSpace";
constexpr std::string_view kNewProjectSpace = "http://www.staubli.com/robotics/VAL3/Project/";

void read_parameters(Elements& in, pugi::xml_node parent, std::string_view name, ProjectFile& project) {
  const pugi::xml_node node = Elements::child(parent, name);
  if (!node) {
    in.findings().error(file_rules::kMissingAttribute, in.line_of(parent),
                        "the project has no " + std::string(name), "write its version, stackSize and unit");
    return;
  }
  in.allow(node, {"version", "stackSize", "millimeterUnit"});
  project.version = in.required(node, "version");
  const auto version = version_in(project.version);
  if (version)
    project.language = *version;
  else if (!project.version.empty())
    in.findings().error(file_rules::kBadVersion, in.line_of(node),
                        shown_word(project.version) + " is no version", "write one like s7.7.2");
  const std::string stack = Elements::optional(node, "stackSize", "5000");
  if (const auto bytes = whole_number(stack, kStackBytesMax))
    project.stack_bytes = *bytes;
  else
    in.findings().error(
        file_rules::kBadValue, in.line_of(node), "stackSize is " + shown_word(stack),
        "write a number of bytes up to " + std::to_string(kStackBytesMax) + "; 5000 is usual");
  project.is_metric = in.truth(node, "millimeterUnit", true);
}

std::vector<ProjectFile::Listed> read_listed(Elements& in, pugi::xml_node parent, std::string_view section,
                                             std::string_view item) {
  std::vector<ProjectFile::Listed> result;
  for (const pugi::xml_node node : in.children(Elements::child(parent, section), item)) {
    in.allow(node, {"file"});
    std::string file = in.required(node, "file");
    if (!file.empty()) result.push_back({std::move(file), in.line_of(node)});
  }
  return result;
}

struct OtherForm {
  std::string_view section;
  std::string_view item;
  std::string_view name;
  std::string_view path;
};

std::vector<ProjectFile::Other> read_others(Elements& in, pugi::xml_node parent, const OtherForm& form) {
  std::vector<ProjectFile::Other> result;
  for (const pugi::xml_node node : in.children(Elements::child(parent, form.section), form.item)) {
    in.allow(node, {form.name, form.path, "autoload", "password"});
    ProjectFile::Other other{in.required(node, form.name), in.required(node, form.path),
                             in.truth(node, "autoload", true), in.line_of(node)};
    if (!other.name.empty()) result.push_back(std::move(other));
  }
  return result;
}

}  // namespace

std::optional<Version> version_in(std::string_view text) {
  constexpr std::string_view kComponent = "VAL3:";
  if (const std::size_t at = text.find(kComponent); at != std::string_view::npos)
    text.remove_prefix(at + kComponent.size());
  const auto starts_number = [&text](std::size_t at) {
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
  };
  if (!(text.starts_with('s') || text.starts_with('S')) || !starts_number(1)) return std::nullopt;
  std::size_t at = 1;
  int numbers[3] = {0, 0, 0};
  for (int& number : numbers) {
    for (; starts_number(at); ++at) number = std::min(number * 10 + (text[at] - '0'), 9999);
    if (at >= text.size() || text[at] != '.' || !starts_number(at + 1)) break;
    ++at;
  }
  return Version{numbers[0], numbers[1], numbers[2]};
}

std::optional<ProjectFile> read_project_file(const XmlFile& xml, FileFindings& findings) {
  ProjectFile project;
  Elements in(xml, findings);
  const pugi::xml_node root = xml.root();
  if (xml.root_name() == "project" && xml.root_space() == kOldProjectSpace) {
    project.form = 5;
    in.children(root, "parameters", {"programSection", "dataSection", "aliasSection"});
    read_parameters(in, root, "parameters", project);
    project.programs = read_listed(in, root, "programSection", "program");
    project.data = read_listed(in, root, "dataSection", "data");
    project.libraries = read_others(in, root, {"aliasSection", "alias", "name", "interface"});
  } else if (xml.root_name() == "Project" && xml.root_space().starts_with(kNewProjectSpace)) {
    in.children(root, "Parameters", {"Programs", "Database", "Libraries", "Types"});
    read_parameters(in, root, "Parameters", project);
    project.programs = read_listed(in, root, "Programs", "Program");
    project.data = read_listed(in, root, "Database", "Data");
    project.libraries = read_others(in, root, {"Libraries", "Library", "alias", "path"});
    project.types = read_others(in, root, {"Types", "Type", "name", "path"});
  } else {
    findings.error(file_rules::kUnknownForm, xml.line_of(root),
                   shown_word(xml.root_name()) + " of " + shown_word(xml.root_space()) +
                       " is no VAL3 project of s5 to s8");
    return std::nullopt;
  }
  return project;
}

}  // namespace val3
