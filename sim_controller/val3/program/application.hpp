#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/program/finding.hpp"
#include "sim_controller/val3/program/syntax.hpp"

/// A VAL3 application as it stands in its files, whatever version wrote them.
namespace val3 {

/// A language version: s6.8, s7.7.2.
struct Version {
  int major = 7;
  int minor = 0;
  int patch = 0;
  auto operator<=>(const Version&) const = default;
};

struct StoredField;

/// An element's value as a data file stores it, with the attribute names of s7: "value", "x", "j1", "accel",
/// "tmax", "fatherId", "link", "shoulder" ... What is not stored has the default of its type.
struct StoredValue {
  std::vector<std::size_t> index;  // of an array: as many as it has dimensions
  std::string key;                 // of a collection
  std::map<std::string, std::string> attributes;
  std::vector<StoredField> fields;  // of a user type
  int line = 0;
};

/// What a variable, a local, or a field of a user type is.
struct Declaration {
  std::string name;
  Type type;
  std::vector<std::size_t> sizes{1};  // one to three dimensions; empty: a collection
  std::string file;
  int line = 0;

  [[nodiscard]] bool is_collection() const { return sizes.empty(); }
  /// Elements of one that nobody has sized yet: none of a collection.
  [[nodiscard]] std::size_t count() const {
    std::size_t all = is_collection() ? 0 : 1;
    for (const std::size_t size : sizes) all *= size;
    return all;
  }
  /// More than one element, or more than one dimension.
  [[nodiscard]] bool is_array() const { return sizes.size() != 1 || sizes[0] != 1; }
};

struct StoredField {
  Declaration declared;
  std::vector<StoredValue> values;
};

struct Global {
  Declaration declared;
  bool is_public = false;
  std::vector<StoredValue> values;
};

struct Parameter {
  std::string name;
  Type type;
  bool by_reference = false;
  int dimensions = 0;  // 0: one element; 1 to 3: an array
  int line = 0;
};

struct Program {
  std::string name;
  std::string file;
  bool is_public = false;
  int line = 0;
  std::vector<Parameter> parameters;
  std::vector<Declaration> locals;
  std::vector<Line> lines;  // the last one is kEnd
};

struct Application;

/// A project that some line loads behind an alias: alias:libLoad("path").
struct Loadable {
  enum class Is { kFound, kMissing, kOutside, kEncrypted, kUnreadable };
  std::string path;  // as the line writes it
  Is is = Is::kMissing;
  std::shared_ptr<Application> application;  // of kFound
};

/// Another application whose public data and programs are used as alias:name.
struct Library {
  std::string alias;
  std::string path;  // as the project writes it
  bool autoload = true;
  Position at;
  std::shared_ptr<Application> application;  // null: not found, or loaded by a path that is computed
  std::vector<Loadable> loadable{};          // what lines load by a path that is written out, each path once
};

/// A structure that the application declares: the public data of another project.
struct UserType {
  std::string name;
  std::vector<Global> fields;  // with their stored values as defaults
  Position at;
  std::string project;  // its .pjx, which tells types of one name apart; empty: it was not found
};

struct Application {
  std::string name;
  std::string folder;   // where its files are
  std::string project;  // its .pjx, from the folder
  std::string version;  // as the project writes it: "s7.7.2"
  Version language;     // of that
  int form = 7;         // 5 (s5 and s6 files) or 7 (s7 and s8)
  std::size_t stack_bytes = 5000;
  bool is_metric = true;     // lengths in mm, else inch
  bool is_built_in = false;  // the controller's own library io: the cell may have more names in it
  bool has_pages = false;    // a folder `interface`: its user pages may call programs
  // What its project lists and could not be read, which is found: names of it are not known.
  bool has_unread_data = false;
  std::vector<std::string> unread_programs;  // file names without their ending, in lower case
  std::vector<Program> programs;
  std::vector<Global> globals;
  std::vector<Library> libraries;
  std::vector<UserType> user_types;

  /// Index, or -1. Names are compared with their case.
  [[nodiscard]] int program_named(std::string_view name) const;
  [[nodiscard]] int global_named(std::string_view name) const;
  [[nodiscard]] int library_named(std::string_view alias) const;
  [[nodiscard]] int user_type_named(std::string_view name) const;
  /// The program may be in a file that could not be read.
  [[nodiscard]] bool is_unread(std::string_view program) const;
};

/// As messages write it: "num", or the user type's name.
std::string name_of(const Application& application, const Type& type);

}  // namespace val3
