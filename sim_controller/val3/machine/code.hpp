#pragma once

#include <memory>
#include <string>
#include <utility>
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

using OperationPtr = std::unique_ptr<const Operation>;

/// An operation of a function.
template <class F>
class LambdaOperation final : public Operation {
 public:
  explicit LambdaOperation(F f) : f_(std::move(f)) {}
  Flow run(Context& context) const override { return f_(context); }

 private:
  F f_;
};
template <class F>
OperationPtr operation(F f) {
  return std::make_unique<const LambdaOperation<F>>(std::move(f));
}

struct Instance;

/// A program ready to run. Its operations are those of Program::lines, one for each.
struct Code {
  const Program* program = nullptr;
  const Instance* instance = nullptr;  // whose variables it uses
  std::size_t call_bytes = 0;          // of run memory, that a call of it takes
  std::vector<std::unique_ptr<const Operation>> operations;
  mutable std::vector<std::unique_ptr<Activation>> idle;  // of calls that are over, to be used again
};

}  // namespace val3
