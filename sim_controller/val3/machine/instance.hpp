#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/machine/arrays.hpp"
#include "sim_controller/val3/machine/code.hpp"

namespace val3 {

/// Which frames and tools there are: a number for each array of them, so that a point can name its father.
class Fathers {
 public:
  Fathers();
  int add(ArrayBase& array);
  void remove(int id) { arrays_.erase(id); }
  /// The frame world and the tool flange as variables of one element, which are there always. Who writes to
  /// them gets RunFailure 161 or 160 at the next calculation with a frame or a tool.
  [[nodiscard]] ArrayBase& world() const { return *world_; }
  [[nodiscard]] ArrayBase& flange() const { return *flange_; }
  /// The frame in the world: RunFailure 161, 162 for a point's missing father, 163 for a frame's, 165.
  [[nodiscard]] Trsf frame_in_world(const Father& father) const;
  /// The tool from the flange: RunFailure 160, 164.
  [[nodiscard]] Trsf flange_from(const Tool& tool) const;
  /// The father that an element of an array is, or none for an array that is not numbered.
  [[nodiscard]] Father father_of(const Ref& place) const;

 private:
  [[nodiscard]] const ArrayBase* find(const Father& father) const;
  std::unique_ptr<Array<Frame>> world_;
  std::unique_ptr<Array<Tool>> flange_;
  std::map<int, ArrayBase*> arrays_;
  int next_ = kFlangeArray + 1;
};

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
/// Every global of the instance gets what its data file stores. A link that the system does not have is
/// unlinked (error 123 on use).
void load_data(Instance& instance, System& system, Fathers& fathers, Findings& findings);

}  // namespace val3
