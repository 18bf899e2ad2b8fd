#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim_controller/val3/machine/arrays.hpp"
#include "sim_controller/val3/machine/fathers.hpp"

/// Expressions ready to run: each is of one type and finds its variables without a name.
namespace val3 {

struct Task;
class Tasks;
struct Code;

/// A program that runs, with its variables.
struct Activation {
  const Code* code = nullptr;
  std::size_t next = 0;                           // the line that is carried out next
  bool branch_open = false;                       // a condition was false: an elseIf or else may be taken
  std::vector<Ref> slots;                         // parameters, then locals
  std::vector<std::shared_ptr<ArrayBase>> owned;  // what is behind the slots that are not by reference
  CallFathers fathers;                            // those of `owned`, while it runs
};

/// What an expression needs while it is evaluated.
struct Context {
  System& system;
  Tasks& tasks;
  Task& task;
  Activation* here;  // of the task's innermost program
};

class NodeBase {
 public:
  NodeBase() = default;
  virtual ~NodeBase() = default;
  NodeBase(const NodeBase&) = delete;
  NodeBase& operator=(const NodeBase&) = delete;
};
/// Of the type that its expression has.
using AnyNode = std::unique_ptr<const NodeBase>;

template <class T>
class Node : public NodeBase {
 public:
  /// RunFailure; Wait where the line has to be carried out again.
  virtual T get(Context& context) const = 0;
};
template <class T>
using NodePtr = std::unique_ptr<const Node<T>>;

/// An expression without a value.
struct Nothing {};

/// A place that can be passed by reference.
using RefNode = Node<Ref>;
using RefNodePtr = NodePtr<Ref>;

/// A node of a function: `lambda_node<double>([=](Context& c) { return ...; })`.
template <class T, class F>
class LambdaNode final : public Node<T> {
 public:
  explicit LambdaNode(F f) : f_(std::move(f)) {}
  T get(Context& context) const override { return f_(context); }

 private:
  F f_;
};
template <class T, class F>
NodePtr<T> lambda_node(F f) {
  return std::make_unique<LambdaNode<T, F>>(std::move(f));
}

/// A variable. What at() returns holds until the next line.
template <class T>
class PlaceNode : public Node<T> {
 public:
  virtual T& at(Context& context) const = 0;
  T get(Context& context) const final { return at(context); }
};
template <class T>
using PlaceNodePtr = std::unique_ptr<const PlaceNode<T>>;

}  // namespace val3
