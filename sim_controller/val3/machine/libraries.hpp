#pragma once

#include <string>
#include <vector>

#include "sim_controller/val3/machine/compiler.hpp"

/// Libraries behind their aliases: which project is loaded, and what its names stand for (manual 6, pages 93
/// to 98). Every project that a line can load was read with the application; nothing is read while it runs.
namespace val3 {

/// A project that can stand behind an alias.
struct LoadableInstance {
  std::string path;
  Loadable::Is is = Loadable::Is::kFound;
  Instance* instance = nullptr;  // of kFound
  std::string problem;           // what of it is not simulated, with its place; empty: nothing
};

/// An alias of an application.
struct LibrarySlot {
  const Library* library = nullptr;
  Instance* declared = nullptr;            // whose interface the application was resolved against, or null
  std::vector<LoadableInstance> loadable;  // the declared path first
  bool is_fixed = true;                    // loaded with the application, and no line loads another
  // What is loaded.
  const LoadableInstance* loaded = nullptr;
  std::vector<ArrayBase*> globals;    // by the declared interface's globals; null: missing or not loaded
  std::vector<const Code*> programs;  // by its programs
};

/// As libraries stand when an application is loaded: those with autoload, with what they need in their turn.
void reset_libraries(const Instance& instance);

/// The array behind a global of a library. RunFailure 80.
ArrayBase& loaded_global(const LibrarySlot& slot, int index);
/// The program behind one of a library. RunFailure 80.
const Code& loaded_program(const LibrarySlot& slot, int index);

/// libLoad, libSave, libPath, libExist and libDelete: they are of an alias, not of their arguments alone.
bool is_library_instruction(const Expression& call);
AnyNode library_instruction(Compiler& compiler, const Expression& call);

}  // namespace val3
