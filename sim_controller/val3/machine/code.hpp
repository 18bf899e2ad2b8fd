#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim_controller/val3/machine/nodes.hpp"

namespace val3 {

/// How a line ended.
enum class Flow {
  kGo,     // the task goes on with Activation::next
  kWait,   // it is carried out again at the task's next turn
  kEnded,  // the task is over
};

/// A line ready to run. Activation::next already says the line behind it; a line may set it.
class Operation {
 public:
  Operation() = default;
  virtual ~Operation() = default;
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;
  virtual Flow run(Context& context) const = 0;
};

struct Instance;

/// A program ready to run. Its operations are those of Program::lines, one for each.
struct Code {
  const Program* program = nullptr;
  const Instance* instance = nullptr;  // whose variables it uses
  std::vector<std::unique_ptr<const Operation>> operations;
  mutable std::vector<std::unique_ptr<Activation>> idle;  // of calls that are over, to be used again
};

}  // namespace val3
