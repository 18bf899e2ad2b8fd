#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/machine/arrays.hpp"
#include "sim_controller/val3/machine/code.hpp"
#include "sim_controller/val3/machine/fathers.hpp"

namespace val3 {

struct LibrarySlot;

/// An application, or a library of it, with variables of its own.
struct Instance {
  Instance();
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  const Application* application = nullptr;
  std::string alias;  // of a library
  std::vector<std::shared_ptr<ArrayBase>> globals;
  std::vector<Instance*> libraries;                 // by Application::libraries; null where it was not found
  std::vector<std::unique_ptr<LibrarySlot>> slots;  // by Application::libraries: what is loaded behind each
  std::vector<Code> programs;                       // by Application::programs
  double unit_mm = 1.0;

  /// The array behind a reference to a global.
  [[nodiscard]] ArrayBase& global(const Reference& reference) const;
};

/// A variable with its type's defaults.
std::shared_ptr<ArrayBase> make_variable(const Application& application, const Declaration& declared);
/// As it was made: its elements get their defaults, and are as many as at first.
void restore(ArrayBase& array, const Declaration& declared);
/// Every global of the instance gets what its data file stores. A link that the system does not have is
/// unlinked (error 123 on use).
void load_data(Instance& instance, System& system, Fathers& fathers, Findings& findings);

}  // namespace val3
