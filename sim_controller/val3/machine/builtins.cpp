#include "sim_controller/val3/machine/builtins.hpp"

#include <algorithm>
#include <string_view>

#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {

namespace {

/// What the instruction would act on, and is not here.
constexpr std::pair<std::string_view, std::string_view> kReasons[] = {
    {"getLicence", "there are no licences here"},
    {"libList", "there is no disk here whose folders it would list"},
    {"setLanguage", "the controller here has one language"},
    {"setPayload", "a payload has no effect here"},
};

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

std::string why_refused(const Expression& call) {
  const std::string name = call.text + "()";
  if (builtins().knows(call.text)) return "what " + name + " gives is not simulated";
  const Instruction* const instruction = find_instruction(call.text);
  if (call.text.starts_with('$')) return name + " is of an add-on, and add-ons are not simulated";
  if (instruction != nullptr && !instruction->addon.empty())
    return name + " is of the option " + std::string(instruction->addon) + ", and options are not simulated";
  const auto* const reason =
      std::ranges::find(kReasons, call.text, &std::pair<std::string_view, std::string_view>::first);
  return name + " is not simulated" +
         (reason == std::end(kReasons) ? "" : ": " + std::string(reason->second));
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
