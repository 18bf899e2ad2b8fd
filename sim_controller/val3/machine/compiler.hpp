#pragma once

#include <string>
#include <utility>

#include "sim_controller/val3/machine/code.hpp"
#include "sim_controller/val3/machine/instance.hpp"

namespace val3 {

/// Why an expression or a line cannot be carried out by this machine.
struct NotSimulated {
  Position at;
  std::string what;
  std::string remedy = "run this application on a controller, or leave the line out";
};

/// Makes the nodes of one program's expressions. The application is resolved and without errors; what the
/// machine does not have is thrown as NotSimulated.
class Compiler {
 public:
  Compiler(const Instance& instance, const Fathers& fathers, const Program& program)
      : instance_(instance), fathers_(fathers), program_(program) {}

  /// A value of this C++ type: double, bool, std::string, Joint, Trsf ... A dio stands for its state where a
  /// bool is wanted, an aio for its value where a number is; a sio is read.
  template <class T>
  NodePtr<T> value(const Expression& e);
  /// A node of the expression's own type.
  AnyNode any(const Expression& e);
  RefNodePtr ref(const Expression& e);
  template <class T>
  PlaceNodePtr<T> place(const Expression& e);

  [[noreturn]] void refuse(const Expression& e, const std::string& what) const;
  [[noreturn]] void refuse(const Expression& e, const std::string& what, const std::string& remedy) const;
  /// An expression of another type than is wanted, or without one: names the instruction that has none here.
  [[noreturn]] void refuse_type(const Expression& e, const std::string& what) const;
  /// A name that stands for nothing here, though a controller may know it.
  [[noreturn]] void refuse_unknown(const Expression& name) const;
  [[nodiscard]] const Instance& instance() const { return instance_; }
  [[nodiscard]] const Fathers& fathers() const { return fathers_; }
  [[nodiscard]] const Program& program() const { return program_; }

 private:
  NodePtr<double> number(const Expression& e);
  NodePtr<bool> truth(const Expression& e);
  NodePtr<std::string> text(const Expression& e);
  template <class T>
  NodePtr<T> structure(const Expression& e);
  template <class T>
  NodePtr<T> braces(const Expression& e);
  template <class T>
  NodePtr<T> called(const Expression& e);
  NodePtr<bool> comparison(const Expression& e);
  template <class T>
  NodePtr<bool> compared(const Expression& e);
  RefNodePtr variable(const Expression& e);
  RefNodePtr element(const Expression& e);
  RefNodePtr field(const Expression& e);

  const Instance& instance_;
  const Fathers& fathers_;
  const Program& program_;
};

/// Every line of a program, ready to run. What cannot be carried out is found.
Code compile(const Instance& instance, const Fathers& fathers, const Program& program, Findings& findings);

}  // namespace val3
