#include "sim_controller/val3/machine/libraries.hpp"

#include <algorithm>
#include <optional>

#include "sim_controller/val3/language/scope.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// Numbers that a library operation ends with (manual 6, page 95).
enum LibraryResult : int {
  kLibraryDone = 0,
  kLibraryNotLoaded = 10,
  kInterfaceDiffers = 11,
  kInvalidContent = 12,
  kInUse = 13,
  kTasksRun = 14,
  kInvalidPath = 21,
  kNotEncrypted = 23,
  kNotFound = 39,
};

bool is_same_type(const Application& a, const Type& of_a, const Application& b, const Type& of_b) {
  if (of_a.kind != of_b.kind) return false;
  if (of_a.kind != Kind::kUser) return true;
  return have_same_fields(a, a.user_types.at(static_cast<std::size_t>(of_a.user)), b,
                          b.user_types.at(static_cast<std::size_t>(of_b.user)));
}

bool is_same_header(const Application& a, const Program& of_a, const Application& b, const Program& of_b) {
  return std::ranges::equal(of_a.parameters, of_b.parameters, [&](const Parameter& x, const Parameter& y) {
    return is_same_type(a, x.type, b, y.type) && x.by_reference == y.by_reference &&
           x.dimensions == y.dimensions;
  });
}

/// What `offered` has for a public global of `wanted`, or null.
ArrayBase* global_for(const Application& wanted, const Global& global, const Instance& offered) {
  const Application& there = *offered.application;
  const int index = there.global_named(global.declared.name);
  if (index < 0) return nullptr;
  const auto at = static_cast<std::size_t>(index);
  const Global& found = there.globals[at];
  const bool fits = found.is_public &&
                    is_same_type(wanted, global.declared.type, there, found.declared.type) &&
                    found.declared.sizes.size() == global.declared.sizes.size();
  return fits ? offered.globals[at].get() : nullptr;
}

const Code* program_for(const Application& wanted, const Program& program, const Instance& offered) {
  const Application& there = *offered.application;
  const int index = there.program_named(program.name);
  if (index < 0) return nullptr;
  const auto at = static_cast<std::size_t>(index);
  const bool fits =
      there.programs[at].is_public && is_same_header(wanted, program, there, there.programs[at]);
  return fits ? &offered.programs[at] : nullptr;
}

/// False where something of the interface is missing.
bool bind(LibrarySlot& slot, const LoadableInstance* what) {
  slot.loaded = what;
  slot.globals.clear();
  slot.programs.clear();
  if (slot.declared == nullptr) return true;
  const Application& wanted = *slot.declared->application;
  bool is_whole = true;
  for (const Global& global : wanted.globals) {
    slot.globals.push_back(what == nullptr ? nullptr : global_for(wanted, global, *what->instance));
    is_whole = is_whole && (!global.is_public || slot.globals.back() != nullptr);
  }
  for (const Program& program : wanted.programs) {
    slot.programs.push_back(what == nullptr ? nullptr : program_for(wanted, program, *what->instance));
    is_whole = is_whole && (!program.is_public || slot.programs.back() != nullptr);
  }
  return is_whole;
}

std::size_t values_of(const Instance& instance) {
  std::size_t all = 0;
  for (const auto& global : instance.globals) all += global->values();
  return all;
}

/// Its data are those of its files, or those that were saved since.
void initialise(Context& context, Instance& instance) {
  Findings none;
  load_data(instance, context.system, context.tasks.fathers, none);
  context.tasks.charge(values_of(instance));
  const auto saved = context.tasks.saved.find(instance.application);
  if (saved != context.tasks.saved.end())
    for (std::size_t i = 0; i < instance.globals.size(); ++i) instance.globals[i]->assign(*saved->second[i]);
  for (const auto& slot : instance.slots)
    if (slot->declared != nullptr && slot->library->autoload) initialise(context, *slot->declared);
  reset_libraries(instance);
}

double load(Context& context, LibrarySlot& slot, const LoadableInstance& what) {
  if (what.is == Loadable::Is::kMissing) return kNotFound;
  if (what.is == Loadable::Is::kOutside) return kInvalidPath;
  if (what.instance == nullptr) return kInvalidContent;
  if (!what.problem.empty())
    throw RunFailure(kErrorInterpreter, "the library at " + what.path + " is not simulated: " + what.problem);
  if (slot.loaded != nullptr) {
    if (context.tasks.has_task_of(*slot.loaded->instance)) return kTasksRun;
    if (context.tasks.runs_in(*slot.loaded->instance)) return kInUse;
  }
  initialise(context, *what.instance);
  return bind(slot, &what) ? kLibraryDone : kInterfaceDiffers;
}

double save(Context& context, const Instance& instance) {
  auto& kept = context.tasks.saved[instance.application];
  kept.clear();
  context.tasks.charge(values_of(instance));
  for (const auto& global : instance.globals) kept.push_back(global->clone());
  return kLibraryDone;
}

/// "name" of a variable, "name()" of a program.
bool exists(const LibrarySlot& slot, std::string_view symbol) {
  if (slot.loaded == nullptr) return false;
  const Application& there = *slot.loaded->instance->application;
  if (symbol.ends_with("()")) {
    const int program = there.program_named(symbol.substr(0, symbol.size() - 2));
    return program >= 0 && there.programs[static_cast<std::size_t>(program)].is_public;
  }
  const int global = there.global_named(symbol);
  return global >= 0 && there.globals[static_cast<std::size_t>(global)].is_public;
}

LibrarySlot& slot_of(Compiler& compiler, const Expression& call) {
  const int index = compiler.instance().application->library_named(call.alias);
  if (index < 0) compiler.refuse(call, call.text + " without the alias of a library is not simulated");
  return *compiler.instance().slots.at(static_cast<std::size_t>(index));
}

AnyNode loading(Compiler& compiler, const Expression& call) {
  LibrarySlot& slot = slot_of(compiler, call);
  const Expression& path = call.parts.at(0);
  if (path.kind != Expression::Kind::kText)
    compiler.refuse(path, "libLoad of a path that is computed is not simulated: write it out");
  const auto found = std::ranges::find(slot.loadable, path.text, &LoadableInstance::path);
  if (found == slot.loadable.end() || found->is == Loadable::Is::kEncrypted)
    compiler.refuse(path, "an encrypted library is not simulated");
  const bool has_password = call.parts.size() > 1;
  return lambda_node<double>([&slot, &what = *found, has_password](Context& c) {
    if (has_password && what.instance != nullptr) return static_cast<double>(kNotEncrypted);
    return load(c, slot, what);
  });
}

AnyNode saving(Compiler& compiler, const Expression& call) {
  if (!call.parts.empty()) compiler.refuse(call, "libSave to another path is not simulated");
  if (call.alias.empty())
    return lambda_node<double>([own = &compiler.instance()](Context& c) { return save(c, *own); });
  return lambda_node<double>([&slot = slot_of(compiler, call)](Context& c) {
    return slot.loaded == nullptr ? static_cast<double>(kLibraryNotLoaded) : save(c, *slot.loaded->instance);
  });
}

AnyNode path_of(Compiler& compiler, const Expression& call) {
  if (call.alias.empty())
    return lambda_node<std::string>(
        [path = "Disk://" + compiler.instance().application->name](Context&) { return path; });
  return lambda_node<std::string>([&slot = slot_of(compiler, call)](Context&) {
    return slot.loaded == nullptr ? std::string() : slot.loaded->path;
  });
}

}  // namespace

void reset_libraries(const Instance& instance) {
  for (const auto& slot : instance.slots) {
    const bool loads = slot->declared != nullptr && slot->library->autoload;
    bind(*slot, loads ? &slot->loadable.front() : nullptr);
    if (loads) reset_libraries(*slot->declared);
  }
}

ArrayBase& loaded_global(const LibrarySlot& slot, int index) {
  ArrayBase* array = slot.globals.at(static_cast<std::size_t>(index));
  if (array == nullptr)
    throw RunFailure(kErrorNoLibrary,
                     slot.loaded == nullptr
                         ? "the library " + slot.library->alias + " is not loaded"
                         : "the library that is loaded as " + slot.library->alias + " has no such variable");
  return *array;
}

const Code& loaded_program(const LibrarySlot& slot, int index) {
  const Code* code = slot.programs.at(static_cast<std::size_t>(index));
  if (code == nullptr)
    throw RunFailure(kErrorNoLibrary,
                     slot.loaded == nullptr
                         ? "the library " + slot.library->alias + " is not loaded"
                         : "the library that is loaded as " + slot.library->alias + " has no such program");
  return *code;
}

bool is_library_instruction(const Expression& call) {
  return call.text == "libLoad" || call.text == "libSave" || call.text == "libPath" ||
         call.text == "libExist" || call.text == "libDelete";
}

AnyNode library_instruction(Compiler& compiler, const Expression& call) {
  if (call.text == "libLoad") return loading(compiler, call);
  if (call.text == "libSave") return saving(compiler, call);
  if (call.text == "libPath") return path_of(compiler, call);
  if (call.text == "libExist")
    return lambda_node<bool>([&slot = slot_of(compiler, call),
                              symbol = compiler.value<std::string>(call.parts.at(0))](Context& c) {
      return exists(slot, symbol->get(c));
    });
  compiler.refuse(call, "libDelete is not simulated: no file is ever removed");
}

}  // namespace val3
