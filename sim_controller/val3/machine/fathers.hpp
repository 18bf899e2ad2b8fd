#pragma once

#include <map>
#include <memory>
#include <vector>

#include "sim_controller/val3/machine/arrays.hpp"

namespace val3 {

/// Which frames and tools there are: a number for each array of them, so that a point can name its father.
/// A number is never given twice.
class Fathers {
 public:
  Fathers();
  /// Of a global. The array must outlive it.
  int add(ArrayBase& array);
  /// The frame world and the tool flange as variables of one element, which are there always. Who writes to
  /// them gets RunFailure 161 or 160 at the next calculation with a frame or a tool.
  [[nodiscard]] ArrayBase& world() const { return *world_; }
  [[nodiscard]] ArrayBase& flange() const { return *flange_; }
  /// The frame in the world: RunFailure 161, 162 for a point's missing father, 163 for a frame's, 165 where
  /// the father was local to a call that is over.
  [[nodiscard]] Trsf frame_in_world(const Father& father) const;
  /// The tool from the flange: RunFailure 160, 164, 165.
  [[nodiscard]] Trsf flange_from(const Tool& tool) const;
  /// The father that an element of an array is, or none for an array that is not numbered.
  [[nodiscard]] Father father_of(const Ref& place) const;
  /// `place` may have this father. RunFailure 165 for a global whose father is local to a call: the manual
  /// has the number (manual 6, page 133) and not the moment; here it is that of the link.
  void demand_link(const Ref& place, const Father& father) const;

 private:
  friend class CallFathers;
  struct Known {
    ArrayBase* array = nullptr;
    bool is_local = false;
  };
  int add(ArrayBase& array, bool is_local);
  [[nodiscard]] const ArrayBase* find(const Father& father) const;
  /// Of an array that is there no more: 165.
  void demand_alive(const Father& father) const;

  std::unique_ptr<Array<Frame>> world_;
  std::unique_ptr<Array<Tool>> flange_;
  std::map<int, Known> arrays_;
  int next_ = kFlangeArray + 1;
};

/// The numbers of the frames and tools of one call: no point reaches them behind its end.
class CallFathers {
 public:
  CallFathers() = default;
  CallFathers(const CallFathers&) = delete;
  CallFathers& operator=(const CallFathers&) = delete;
  ~CallFathers() { give_back(); }

  /// `fathers` must outlive it, and the array until give_back().
  void add(Fathers& fathers, ArrayBase& array);
  void give_back();

 private:
  Fathers* fathers_ = nullptr;
  std::vector<int> numbers_;
};

}  // namespace val3
