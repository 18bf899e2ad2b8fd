#include "sim_controller/val3/machine/builtins.hpp"

namespace val3 {

namespace {

NodePtr<Father> father_node(Compiler& compiler, const Expression& e) {
  return lambda_node<Father>([place = compiler.ref(e), fathers = &compiler.fathers()](Context& c) {
    return fathers->father_of(place->get(c));
  });
}

}  // namespace

NodePtr<Father> Argument<FrameRef>::make(Compiler& compiler, const Expression& e) {
  return father_node(compiler, e);
}

NodePtr<Father> Argument<ToolRef>::make(Compiler& compiler, const Expression& e) {
  return father_node(compiler, e);
}

const Builtins::Make* Builtins::find(const Expression& call) const {
  const auto found = overloads_.find(call.text);
  if (found == overloads_.end()) return nullptr;
  for (const Overload& overload : found->second)
    if (overload.fits(call.parts)) return &overload.make;
  return nullptr;
}

const Builtins& builtins() {
  static const Builtins all = [] {
    Builtins list;
    define_numbers(list);
    define_texts(list);
    define_arrays(list);
    define_signals(list);
    define_channels(list);
    define_tasks(list);
    define_geometry(list);
    define_motion(list);
    define_panel(list);
    define_page(list);
    return list;
  }();
  return all;
}

}  // namespace val3
