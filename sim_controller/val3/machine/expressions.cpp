// Expressions as nodes: literals, operators, calls.
#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/channels.hpp"
#include "sim_controller/val3/machine/finite.hpp"
#include "sim_controller/val3/machine/geometry.hpp"
#include "sim_controller/val3/machine/libraries.hpp"
#include "sim_controller/val3/machine/signals.hpp"

namespace val3 {
namespace {

using EKind = Expression::Kind;

/// Strings end here, silently (manual 6, page 48).
constexpr std::size_t kTextBytesMax = 128;

double divided(double left, double right) {
  if (right == 0.0) throw RunFailure(kErrorDivision, "division by zero");
  return demand_finite(left / right);
}

double remainder_of(double left, double right) {
  if (right == 0.0) throw RunFailure(kErrorDivision, "remainder of a division by zero");
  return std::fmod(left, right);
}

std::string joined(const std::string& left, const std::string& right) {
  std::string all = left + right;
  if (all.size() <= kTextBytesMax) return all;
  std::size_t end = kTextBytesMax;
  while (end > 0 && (static_cast<unsigned char>(all[end]) & 0xC0U) == 0x80U) --end;  // no half of a character
  all.resize(end);
  return all;
}

template <class F>
Joint by_axis(const Joint& left, const Joint& right, F f) {
  Joint result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = f(left[i], right[i]);
  return demand_finite(result);
}

/// > and < of joints: true when every axis satisfies it (manual 6, page 109).
bool every_axis_less(const Joint& left, const Joint& right) {
  for (std::size_t i = 0; i < left.size(); ++i)
    if (!(left[i] < right[i])) return false;
  return true;
}

/// A node of two parts of type T.
template <class R, class T, class F>
NodePtr<R> of_two(NodePtr<T> left, NodePtr<T> right, F f) {
  return lambda_node<R>([left = std::move(left), right = std::move(right), f](Context& c) -> R {
    const T first = left->get(c);
    return f(first, right->get(c));
  });
}

template <class T>
NodePtr<bool> ordered(const std::string& sign, NodePtr<T> a, NodePtr<T> b) {
  if (sign == "<")
    return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return x < y; });
  if (sign == "<=")
    return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return x <= y; });
  if (sign == ">")
    return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return x > y; });
  return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return x >= y; });
}

template <class T>
T word_of(int index) {
  return static_cast<T>(index);
}

}  // namespace

void Compiler::refuse(const Expression& e, const std::string& what) const {
  throw NotSimulated{.at = {program_.file, e.line, e.column}, .what = what};
}

void Compiler::refuse(const Expression& e, const std::string& what, const std::string& remedy) const {
  throw NotSimulated{.at = {program_.file, e.line, e.column}, .what = what, .remedy = remedy};
}

void Compiler::refuse_type(const Expression& e, const std::string& what) const {
  if (e.kind == EKind::kCall && e.type.kind == Kind::kVoid) refuse(e, why_refused(e));
  if (e.kind == EKind::kName && e.is_unknown) refuse_unknown(e);
  for (const Expression& part : e.parts)
    if (part.type.kind == Kind::kVoid) refuse_type(part, what);
  refuse(e, what);
}

template <class T>
NodePtr<T> Compiler::called(const Expression& e) {
  const bool is_of_library = is_library_instruction(e);
  const Builtins::Make* make = is_of_library ? nullptr : builtins().find(e);
  if (make == nullptr && !is_of_library) {
    if (!builtins().knows(e.text)) refuse(e, why_refused(e));
    for (const Expression& part : e.parts)
      if (part.is_unknown && part.type.kind == Kind::kVoid) refuse_type(part, "the value of an argument");
    refuse(e, e.text + " with these arguments is not simulated");
  }
  AnyNode made = is_of_library ? library_instruction(*this, e) : (*make)(*this, e);
  const auto* typed = dynamic_cast<const Node<T>*>(made.get());
  if (typed == nullptr) refuse(e, e.text + " does not give this type");
  made.release();  // NOLINT(bugprone-unused-return-value): the typed pointer owns it
  return NodePtr<T>(typed);
}

template <class T>
NodePtr<T> Compiler::value(const Expression& e) {
  if constexpr (std::is_same_v<T, double>) return number(e);
  if constexpr (std::is_same_v<T, bool>) return truth(e);
  if constexpr (std::is_same_v<T, std::string>) return text(e);
  if constexpr (!std::is_same_v<T, double> && !std::is_same_v<T, bool> && !std::is_same_v<T, std::string>)
    return structure<T>(e);
}

NodePtr<double> Compiler::number(const Expression& e) {
  if (e.type.kind == Kind::kAio)
    return lambda_node<double>(
        [signal = structure<Aio>(e)](Context& c) { return read_analogue(c, signal->get(c)); });
  if (e.type.kind == Kind::kSio)
    return lambda_node<double>(
        [channel = structure<Sio>(e)](Context& c) { return read_byte(c, channel->get(c)); });
  if (e.type.kind != Kind::kNum) refuse_type(e, "a number is wanted");
  if (e.kind == EKind::kNumber) return lambda_node<double>([number = e.number](Context&) { return number; });
  if (e.kind == EKind::kCall) return called<double>(e);
  if (e.is_place) return place<double>(e);
  if (e.kind == EKind::kUnary)
    return lambda_node<double>([part = number(e.parts[0])](Context& c) { return -part->get(c); });
  if (e.kind != EKind::kBinary) refuse(e, "no number");
  NodePtr<double> a = number(e.parts[0]);
  NodePtr<double> b = number(e.parts[1]);
  if (e.text == "+")
    return of_two<double>(std::move(a), std::move(b),
                          [](double x, double y) { return demand_finite(x + y); });
  if (e.text == "-")
    return of_two<double>(std::move(a), std::move(b),
                          [](double x, double y) { return demand_finite(x - y); });
  if (e.text == "*")
    return of_two<double>(std::move(a), std::move(b),
                          [](double x, double y) { return demand_finite(x * y); });
  if (e.text == "/") return of_two<double>(std::move(a), std::move(b), divided);
  if (e.text == "%") return of_two<double>(std::move(a), std::move(b), remainder_of);
  refuse(e, "no operator " + e.text + " for numbers");
}

NodePtr<bool> Compiler::truth(const Expression& e) {
  if (e.type.kind == Kind::kDio)
    return lambda_node<bool>(
        [signal = structure<Dio>(e)](Context& c) { return read_signal(c, signal->get(c)); });
  if (e.type.kind != Kind::kBool) refuse_type(e, "a bool is wanted");
  if (e.kind == EKind::kTruth) return lambda_node<bool>([is = e.number != 0.0](Context&) { return is; });
  if (e.kind == EKind::kCall) return called<bool>(e);
  if (e.is_place) return place<bool>(e);
  if (e.kind == EKind::kUnary)
    return lambda_node<bool>([part = truth(e.parts[0])](Context& c) { return !part->get(c); });
  if (e.kind != EKind::kBinary) refuse(e, "no bool");
  if (e.text == "and")
    return lambda_node<bool>(
        [a = truth(e.parts[0]), b = truth(e.parts[1])](Context& c) { return a->get(c) && b->get(c); });
  if (e.text == "or")
    return lambda_node<bool>(
        [a = truth(e.parts[0]), b = truth(e.parts[1])](Context& c) { return a->get(c) || b->get(c); });
  if (e.text == "xor")
    return of_two<bool>(truth(e.parts[0]), truth(e.parts[1]), [](bool x, bool y) { return x != y; });
  return comparison(e);
}

template <class T>
NodePtr<bool> Compiler::compared(const Expression& e) {
  NodePtr<T> a = value<T>(e.parts[0]);
  NodePtr<T> b = value<T>(e.parts[1]);
  if constexpr (requires(const T& x) { x == x; }) {
    if (e.text == "==")
      return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return x == y; });
    if (e.text == "!=")
      return of_two<bool>(std::move(a), std::move(b), [](const T& x, const T& y) { return !(x == y); });
  }
  if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::string>)
    return ordered<T>(e.text, std::move(a), std::move(b));
  if constexpr (std::is_same_v<T, Joint>) {
    if (e.text == "<") return of_two<bool>(std::move(a), std::move(b), every_axis_less);
    if (e.text == ">")
      return of_two<bool>(std::move(a), std::move(b),
                          [](const Joint& x, const Joint& y) { return every_axis_less(y, x); });
  }
  refuse(e, "no operator " + e.text + " for this type");
}

NodePtr<bool> Compiler::comparison(const Expression& e) {
  Kind kind = e.parts[0].kind == EKind::kBraces ? e.parts[1].type.kind : e.parts[0].type.kind;
  if (kind == Kind::kDio) kind = Kind::kBool;  // the states
  if (kind == Kind::kAio) kind = Kind::kNum;
  if (!is_simulated(kind)) refuse_type(e, "values of this type are not simulated");
  return with_type_of(kind, [&]<class T>() { return compared<T>(e); });
}

NodePtr<std::string> Compiler::text(const Expression& e) {
  if (e.type.kind == Kind::kSio)
    return lambda_node<std::string>(
        [channel = structure<Sio>(e)](Context& c) { return read_text(c, channel->get(c)); });
  if (e.type.kind != Kind::kString) refuse_type(e, "a string is wanted");
  if (e.kind == EKind::kText) return lambda_node<std::string>([text = e.text](Context&) { return text; });
  if (e.kind == EKind::kCall) return called<std::string>(e);
  if (e.is_place) return place<std::string>(e);
  if (e.kind != EKind::kBinary || e.text != "+") refuse(e, "no string");
  return of_two<std::string>(text(e.parts[0]), text(e.parts[1]), joined);
}

template <class T>
NodePtr<T> Compiler::braces(const Expression& e) {
  [[maybe_unused]] const auto numbers = [&](std::size_t count) {
    std::vector<NodePtr<double>> parts;
    if (e.parts.size() != count) refuse(e, "a literal of " + std::to_string(count) + " numbers is wanted");
    for (const Expression& part : e.parts) parts.push_back(number(part));
    return parts;
  };
  if constexpr (std::is_same_v<T, Joint> || std::is_same_v<T, JointRs>) {
    return lambda_node<T>([parts = numbers(T{}.size())](Context& c) {
      T result{};
      for (std::size_t i = 0; i < result.size(); ++i) result[i] = parts[i]->get(c);
      return result;
    });
  } else if constexpr (std::is_same_v<T, Trsf>) {
    return lambda_node<T>([p = numbers(6)](Context& c) {
      return Trsf{p[0]->get(c), p[1]->get(c), p[2]->get(c), p[3]->get(c), p[4]->get(c), p[5]->get(c)};
    });
  } else if constexpr (std::is_same_v<T, Config>) {
    if (e.parts.size() != 3) refuse(e, "a literal of shoulder, elbow and wrist is wanted");
    return lambda_node<T>([s = value<Shoulder>(e.parts[0]), b = value<Elbow>(e.parts[1]),
                           w = value<Wrist>(e.parts[2])](Context& c) {
      return Config{s->get(c), b->get(c), w->get(c)};
    });
  } else if constexpr (std::is_same_v<T, Point>) {
    if (e.parts.size() != 2) refuse(e, "a literal of trsf and config is wanted");
    return lambda_node<T>([t = value<Trsf>(e.parts[0]), k = value<Config>(e.parts[1])](Context& c) {
      return Point{.trsf = t->get(c), .config = k->get(c)};
    });
  } else if constexpr (std::is_same_v<T, Frame>) {
    if (e.parts.size() != 1) refuse(e, "a literal of a trsf is wanted");
    return lambda_node<T>([t = value<Trsf>(e.parts[0])](Context& c) { return Frame{.trsf = t->get(c)}; });
  } else if constexpr (std::is_same_v<T, Tool>) {
    if (e.parts.size() != 4) refuse(e, "a literal of trsf, gripper, otime and ctime is wanted");
    return lambda_node<T>([t = value<Trsf>(e.parts[0]), gripper = value<Dio>(e.parts[1]),
                           open_s = number(e.parts[2]), close_s = number(e.parts[3])](Context& c) {
      return Tool{.trsf = t->get(c),
                  .gripper = gripper->get(c),
                  .open_s = open_s->get(c),
                  .close_s = close_s->get(c)};
    });
  } else if constexpr (std::is_same_v<T, Mdesc>) {
    if (e.parts.size() != 8) refuse(e, "a literal of eight fields is wanted");
    std::vector<NodePtr<double>> p;
    for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 6U, 7U}) p.push_back(number(e.parts[i]));
    return lambda_node<T>([p = std::move(p), blend = value<Blend>(e.parts[5])](Context& c) {
      return Mdesc{p[0]->get(c), p[1]->get(c),  p[2]->get(c), p[3]->get(c),
                   p[4]->get(c), blend->get(c), p[5]->get(c), p[6]->get(c)};
    });
  } else {
    refuse(e, "a literal in braces of this type is not simulated");
  }
}

template <class T>
NodePtr<T> Compiler::structure(const Expression& e) {
  if (e.kind == EKind::kBraces) return braces<T>(e);
  if (e.kind == EKind::kCall) return called<T>(e);
  if constexpr (std::is_same_v<T, Blend> || std::is_same_v<T, Shoulder> || std::is_same_v<T, Elbow> ||
                std::is_same_v<T, Wrist>) {
    if (e.reference.to == Reference::To::kWord)
      return lambda_node<T>([word = word_of<T>(e.reference.index)](Context&) { return word; });
  }
  if (e.is_place || e.kind == EKind::kName) return place<T>(e);
  if constexpr (std::is_same_v<T, Joint>) {
    if (e.kind == EKind::kUnary)
      return lambda_node<T>([part = structure<T>(e.parts[0])](Context& c) {
        return by_axis(Joint{}, part->get(c), [](double x, double y) { return x - y; });
      });
    if (e.kind == EKind::kBinary && (e.text == "+" || e.text == "-")) {
      const double sign = e.text == "+" ? 1.0 : -1.0;
      return of_two<T>(structure<T>(e.parts[0]), structure<T>(e.parts[1]),
                       [sign](const Joint& x, const Joint& y) {
                         return by_axis(x, y, [sign](double a, double b) { return a + sign * b; });
                       });
    }
  }
  if constexpr (std::is_same_v<T, Trsf>) {
    if (e.kind == EKind::kUnary)
      return lambda_node<T>(
          [part = structure<T>(e.parts[0])](Context& c) { return demand_finite(inverse(part->get(c))); });
    if (e.kind == EKind::kBinary && e.text == "*")
      return of_two<T>(structure<T>(e.parts[0]), structure<T>(e.parts[1]),
                       [](const Trsf& x, const Trsf& y) { return demand_finite(composed(x, y)); });
  }
  refuse(e, "an expression of this type is not simulated");
}

AnyNode Compiler::any(const Expression& e) {
  if (e.type.kind == Kind::kVoid) return called<Nothing>(e);
  if (!is_simulated(e.type.kind)) refuse_type(e, "values of this type are not simulated");
  return with_type_of(e.type.kind, [&]<class T>() -> AnyNode { return value<T>(e); });
}

template NodePtr<double> Compiler::value(const Expression&);
template NodePtr<bool> Compiler::value(const Expression&);
template NodePtr<std::string> Compiler::value(const Expression&);
template NodePtr<Dio> Compiler::value(const Expression&);
template NodePtr<Aio> Compiler::value(const Expression&);
template NodePtr<Sio> Compiler::value(const Expression&);
template NodePtr<Trsf> Compiler::value(const Expression&);
template NodePtr<Frame> Compiler::value(const Expression&);
template NodePtr<Tool> Compiler::value(const Expression&);
template NodePtr<Mdesc> Compiler::value(const Expression&);
template NodePtr<Joint> Compiler::value(const Expression&);
template NodePtr<JointRs> Compiler::value(const Expression&);
template NodePtr<Point> Compiler::value(const Expression&);
template NodePtr<Config> Compiler::value(const Expression&);
template NodePtr<Screen> Compiler::value(const Expression&);
template NodePtr<Blend> Compiler::value(const Expression&);
template NodePtr<Shoulder> Compiler::value(const Expression&);
template NodePtr<Elbow> Compiler::value(const Expression&);
template NodePtr<Wrist> Compiler::value(const Expression&);
template NodePtr<Record> Compiler::value(const Expression&);

}  // namespace val3
