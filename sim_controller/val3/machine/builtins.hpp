#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "sim_controller/val3/machine/compiler.hpp"
#include "sim_controller/val3/machine/finite.hpp"

/// The instructions that the machine carries out.
namespace val3 {

/// A variable that an instruction writes to.
template <class T>
struct Out {
  Ref ref;
  [[nodiscard]] T& value() const { return ref.template at<T>(); }
};

/// An array, with its elements from the one named to its end.
template <class T>
struct Slice {
  Ref ref;
  [[nodiscard]] std::size_t size() const { return ref.size(); }
  [[nodiscard]] T& operator[](std::size_t i) const {
    if (ref.field >= 0) return ref.template at<T>();
    return static_cast<Array<T>*>(ref.array)->elements[ref.index + i];
  }
};

/// A frame as a variable, which points can be given in.
struct FrameRef {
  Father father;
};

/// A tool as a variable, which tools can be given on.
struct ToolRef {
  Father father;
};

/// How an argument of an instruction is compiled and handed over.
template <class T>
struct Argument {
  using Made = NodePtr<T>;
  static bool fits(const Expression& e) {
    const Kind kind = e.type.kind;
    return kind == kind_of<T>() || (std::is_same_v<T, bool> && kind == Kind::kDio) ||
           (std::is_same_v<T, double> && kind == Kind::kAio) ||
           (e.kind == Expression::Kind::kBraces && kind_of<T>() != Kind::kNum &&
            kind_of<T>() != Kind::kBool && kind_of<T>() != Kind::kString);
  }
  static Made make(Compiler& compiler, const Expression& e) { return compiler.value<T>(e); }
  static T get(const Made& made, Context& context) { return made->get(context); }
};
template <class T>
struct Argument<Out<T>> {
  using Made = RefNodePtr;
  static bool fits(const Expression& e) { return e.type.kind == kind_of<T>(); }
  static Made make(Compiler& compiler, const Expression& e) { return compiler.ref(e); }
  static Out<T> get(const Made& made, Context& context) { return {made->get(context)}; }
};
template <class T>
struct Argument<Slice<T>> {
  using Made = RefNodePtr;
  static bool fits(const Expression& e) { return e.type.kind == kind_of<T>(); }
  static Made make(Compiler& compiler, const Expression& e) { return compiler.ref(e); }
  static Slice<T> get(const Made& made, Context& context) { return {made->get(context)}; }
};
template <>
struct Argument<FrameRef> {
  using Made = NodePtr<Father>;
  static bool fits(const Expression& e) { return e.type.kind == Kind::kFrame; }
  static Made make(Compiler& compiler, const Expression& e);
  static FrameRef get(const Made& made, Context& context) { return {made->get(context)}; }
};
template <>
struct Argument<ToolRef> {
  using Made = NodePtr<Father>;
  static bool fits(const Expression& e) { return e.type.kind == Kind::kTool && e.is_place; }
  static Made make(Compiler& compiler, const Expression& e);
  static ToolRef get(const Made& made, Context& context) { return {made->get(context)}; }
};
/// An array of any type.
template <>
struct Argument<Ref> {
  using Made = RefNodePtr;
  static bool fits(const Expression& e) { return e.is_place; }
  static Made make(Compiler& compiler, const Expression& e) { return compiler.ref(e); }
  static Ref get(const Made& made, Context& context) { return made->get(context); }
};

/// A call of a function of these arguments; they are evaluated from left to right.
template <class R, class F, class... A>
class CallNode final : public Node<R> {
 public:
  CallNode(F f, std::tuple<typename Argument<A>::Made...> made) : f_(std::move(f)), made_(std::move(made)) {}
  R get(Context& context) const override { return get_in_order(context, std::index_sequence_for<A...>{}); }

 private:
  template <std::size_t... I>
  R get_in_order(Context& context, std::index_sequence<I...>) const {
    std::tuple<A...> values{Argument<A>::get(std::get<I>(made_), context)...};
    return demand_finite<R>(f_(context, std::get<I>(values)...));
  }
  F f_;
  std::tuple<typename Argument<A>::Made...> made_;
};

class Builtins {
 public:
  using Make = std::function<AnyNode(Compiler&, const Expression& call)>;
  struct Overload {
    std::function<bool(const std::vector<Expression>&)> fits;
    Make make;
  };

  /// The first overload of that name whose arguments fit, or null.
  [[nodiscard]] const Make* find(const Expression& call) const;
  [[nodiscard]] bool knows(std::string_view name) const { return overloads_.contains(name); }

  /// `f` takes Context& and the arguments and returns R (Nothing for an instruction without a value).
  template <class R, class... A, class F>
  void define(const char* name, F f) {
    overloads_[name].push_back({[](const std::vector<Expression>& arguments) {
                                  return fit<A...>(arguments, std::index_sequence_for<A...>{});
                                },
                                [f](Compiler& compiler, const Expression& call) {
                                  return make_call<R, A...>(compiler, call, f,
                                                            std::index_sequence_for<A...>{});
                                }});
  }

 private:
  template <class... A, std::size_t... I>
  static bool fit(const std::vector<Expression>& arguments, std::index_sequence<I...>) {
    return arguments.size() == sizeof...(A) && (Argument<A>::fits(arguments[I]) && ...);
  }
  template <class R, class... A, class F, std::size_t... I>
  static AnyNode make_call([[maybe_unused]] Compiler& compiler, [[maybe_unused]] const Expression& call,
                           const F& f, std::index_sequence<I...>) {
    return std::make_unique<const CallNode<R, F, A...>>(
        f, std::tuple<typename Argument<A>::Made...>{Argument<A>::make(compiler, call.parts[I])...});
  }

  std::map<std::string, std::vector<Overload>, std::less<>> overloads_;
};

/// All of them; made once.
const Builtins& builtins();
/// Why a call of an instruction is refused whose value, or which itself, the machine does not have.
std::string why_refused(const Expression& call);

void define_numbers(Builtins& list);
void define_texts(Builtins& list);
void define_arrays(Builtins& list);
void define_signals(Builtins& list);
void define_channels(Builtins& list);
void define_tasks(Builtins& list);
void define_geometry(Builtins& list);
void define_motion(Builtins& list);
void define_panel(Builtins& list);
void define_page(Builtins& list);

}  // namespace val3
