#include "sim_controller/val3/machine/machine.hpp"

#include <functional>
#include <map>
#include <stdexcept>
#include <utility>
#include <variant>

#include "sim_controller/val3/machine/compiler.hpp"
#include "sim_controller/val3/machine/libraries.hpp"
#include "sim_controller/val3/machine/tasks.hpp"
#include "sim_controller/val3/program/run_memory.hpp"

namespace val3 {
namespace {

enum class Stage { kLoaded, kRunning, kStopping, kEnded };

}  // namespace

struct Machine::State {
  State(const Application& application_, System& system_, const MachineLimits& limits)
      : application(application_), system(system_), tasks(system_, limits) {}

  /// An instance of the application and, below it, of each of its libraries.
  Instance* make_instance(const Application& from, const std::string& alias) {
    instances.push_back(std::make_unique<Instance>());
    Instance* made = instances.back().get();
    made->application = &from;
    made->alias = alias;
    constexpr double kMillimetresPerInch = 25.4;
    made->unit_mm = from.is_metric ? 1.0 : kMillimetresPerInch;
    for (const Global& global : from.globals) {
      std::shared_ptr<ArrayBase> array;
      if (is_simulated(global.declared.type.kind)) {
        array = make_variable(from, global.declared);
        array->is_global = true;
        const Kind kind = global.declared.type.kind;
        if (kind == Kind::kFrame || kind == Kind::kTool) tasks.fathers.add(*array);
      } else {
        array = std::make_shared<Array<double>>(Type{Kind::kNum}, 0);  // never referred to
      }
      made->globals.push_back(std::move(array));
    }
    made->programs.resize(from.programs.size());
    for (std::size_t i = 0; i < from.programs.size(); ++i)
      made->programs[i] =
          Code{.program = &from.programs[i], .instance = made};  // compiled when all are there
    for (const Library& library : from.libraries) add_library(*made, library);
    return made;
  }

  void add_library(Instance& made, const Library& library) {
    made.libraries.push_back(library.application ? make_instance(*library.application, library.alias)
                                                 : nullptr);
    auto slot = std::make_unique<LibrarySlot>();
    slot->library = &library;
    slot->declared = made.libraries.back();
    slot->is_fixed = library.autoload && library.loadable.empty();
    if (slot->declared != nullptr)
      slot->loadable.push_back({.path = library.path, .instance = slot->declared, .problem = {}});
    for (const Loadable& one : library.loadable) {
      if (slot->declared != nullptr && one.path == library.path) continue;
      const bool is_declared = one.application == library.application;
      Instance* instance = nullptr;
      if (one.application)
        instance = is_declared ? slot->declared : make_instance(*one.application, library.alias);
      slot->loadable.push_back({.path = one.path, .is = one.is, .instance = instance, .problem = {}});
    }
    made.slots.push_back(std::move(slot));
  }

  /// What is loaded with the application must be simulated; what a line loads only when it does.
  void compile_all(Findings& findings) {
    std::map<const Instance*, Findings> found;
    for (const auto& instance : instances)
      for (std::size_t i = 0; i < instance->programs.size(); ++i)
        instance->programs[i] =
            compile(*instance, tasks.fathers, instance->application->programs[i], found[instance.get()]);
    for (const auto& instance : instances)
      for (const auto& slot : instance->slots)
        for (LoadableInstance& one : slot->loadable) one.problem = problem_of(one.instance, found);
    append(*root, found, findings);
  }

  static std::string problem_of(const Instance* instance, std::map<const Instance*, Findings>& found) {
    Findings all;
    if (instance != nullptr) append(*instance, found, all);
    if (all.empty()) return {};
    return all[0].at.file + ":" + std::to_string(all[0].at.line) + ": " + all[0].what;
  }

  /// Of an instance and of the libraries that its project declares.
  static void append(const Instance& instance, std::map<const Instance*, Findings>& found, Findings& all) {
    all.insert(all.end(), found[&instance].begin(), found[&instance].end());
    for (const Instance* library : instance.libraries)
      if (library != nullptr) append(*library, found, all);
  }

  /// A controller loads no application whose run memory does not hold start() and stop() (s6.8's messages).
  void demand_run_memory(Findings& findings) const {
    const std::size_t memory = run_memory_of(application);
    for (const char* name : {"start", "stop"}) {
      const int index = application.program_named(name);
      const Code* code = index < 0 ? nullptr : &root->programs[static_cast<std::size_t>(index)];
      if (code == nullptr || code->call_bytes <= memory) continue;
      Finding found;
      found.rule = "run-memory";
      found.at = {code->program->file, code->program->line, 0};
      found.what = std::string(name) + "() takes " + std::to_string(code->call_bytes) +
                   " bytes of run memory (estimated), and stackSize is " + std::to_string(memory);
      found.remedy = "give the project a larger stackSize, or the program smaller locals";
      findings.push_back(std::move(found));
    }
  }

  /// A task that runs a program of the application itself; nothing when there is no such program.
  bool begin(const std::string& name, std::string_view program) {
    const int index = application.program_named(program);
    if (index < 0) return false;
    auto task = std::make_unique<Task>();
    task->name = name;
    task->owner = root;
    tasks.enter(*task, Tasks::activate(root->programs[static_cast<std::size_t>(index)], tasks.fathers));
    tasks.create(std::move(task));
    return true;
  }

  template <class T>
  T& variable(std::string_view name, std::size_t index) const {
    const int global = application.global_named(name);
    if (global < 0) throw std::out_of_range("no variable " + std::string(name));
    ArrayBase& array = *root->globals[static_cast<std::size_t>(global)];
    if (array.type().kind != kind_of<T>()) throw std::bad_variant_access();
    if (index >= array.size()) throw std::out_of_range("no such element of " + std::string(name));
    return static_cast<Array<T>&>(array).elements[index];
  }

  const Application& application;
  System& system;
  Tasks tasks;
  std::vector<std::unique_ptr<Instance>> instances;
  Instance* root = nullptr;
  Stage stage = Stage::kLoaded;
  bool runs = false;  // nothing was found that this machine does not have
};

Machine::Machine(const Application& application, System& system, Findings& findings, MachineLimits limits)
    : state_(std::make_unique<State>(application, system, limits)) {
  const std::size_t before = findings.size();
  state_->root = state_->make_instance(application, "");
  state_->compile_all(findings);
  state_->demand_run_memory(findings);
  for (const auto& instance : state_->instances)
    load_data(*instance, system, state_->tasks.fathers, findings);
  state_->runs = findings.size() == before;
}

Machine::~Machine() = default;

void Machine::start() {
  if (!state_->runs) return;
  state_->tasks.kill_all();
  state_->tasks.tick();
  if (state_->application.stack_bytes == 0)
    state_->system.log("stackSize is 0: the usual " + std::to_string(kUsualStackBytes) +
                       " bytes are taken as each task's run memory");
  reset_libraries(*state_->root);
  state_->stage =
      state_->begin(state_->application.name.substr(0, 14) + "~", "start") ? Stage::kRunning : Stage::kEnded;
}

void Machine::stop() {
  if (state_->stage != Stage::kRunning) return;
  const std::string name = state_->application.name.substr(0, 14);
  if (Task* first = state_->tasks.find(*state_->root, name + "~")) state_->tasks.kill(*first);
  state_->stage = state_->begin("~" + name, "stop") ? Stage::kStopping : Stage::kEnded;
  if (state_->stage == Stage::kEnded) state_->tasks.kill_all();
}

void Machine::tick() {
  State& state = *state_;
  if (state.stage == Stage::kLoaded || state.stage == Stage::kEnded) return;
  state.tasks.tick();
  if (state.stage == Stage::kRunning && state.tasks.empty()) {
    state.stage =
        state.begin("~" + state.application.name.substr(0, 14), "stop") ? Stage::kStopping : Stage::kEnded;
  } else if (state.stage == Stage::kStopping &&
             state.tasks.find(*state.root, "~" + state.application.name.substr(0, 14)) == nullptr) {
    state.tasks.kill_all();
    state.stage = Stage::kEnded;
  }
}

bool Machine::ended() const { return state_->stage == Stage::kEnded; }

std::vector<TaskView> Machine::tasks() const { return state_->tasks.views(); }

int Machine::task_status(std::string_view name) const {
  const Task* task = state_->tasks.find(*state_->root, name);
  return task == nullptr ? -1 : task->status;
}

void Machine::fail_task(std::string_view name, int error) {
  Task* task = state_->tasks.find(*state_->root, name);
  if (task == nullptr) throw std::out_of_range("no task " + std::string(name));
  state_->tasks.fail(*task, error, "made to fail from outside");
}

void Machine::set_limits(const MachineLimits& limits) { state_->tasks.set_limits(limits); }
std::uint64_t Machine::lines() const { return state_->tasks.lines(); }
int Machine::most_lines(std::string_view task) const { return state_->tasks.most_lines(task); }

double Machine::number(std::string_view name, std::size_t index) const {
  return state_->variable<double>(name, index);
}
bool Machine::truth(std::string_view name, std::size_t index) const {
  return state_->variable<bool>(name, index);
}
const std::string& Machine::text(std::string_view name, std::size_t index) const {
  return state_->variable<std::string>(name, index);
}
const Joint& Machine::joint(std::string_view name, std::size_t index) const {
  return state_->variable<Joint>(name, index);
}
void Machine::set_number(std::string_view name, double value, std::size_t index) {
  state_->variable<double>(name, index) = value;
}
void Machine::set_text(std::string_view name, const std::string& value, std::size_t index) {
  state_->variable<std::string>(name, index) = value;
}
void Machine::set_joint(std::string_view name, const Joint& value, std::size_t index) {
  state_->variable<Joint>(name, index) = value;
}
void Machine::set_truth(std::string_view name, bool value, std::size_t index) {
  state_->variable<bool>(name, index) = value;
}

}  // namespace val3
