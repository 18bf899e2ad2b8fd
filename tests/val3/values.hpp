#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The values of VAL3: degrees and millimetres, as the language has them.
namespace val3 {

/// The types of the s7 data files that the application may use.
enum class Type {
  kNone,
  kNum,
  kBool,
  kString,
  kJoint,
  kPoint,
  kTrsf,
  kFrame,
  kTool,
  kMdesc,
  kDio,
  kSio,
  kBlend
};

/// As data files write it ("jointRx"); kNone for any other word.
Type type_named(std::string_view word);
std::string_view name_of(Type type);

using Joint = std::array<double, 6>;  // deg

/// Turned about x, then the new y, then the new z: R = Rx Ry Rz.
struct Trsf {
  double x = 0, y = 0, z = 0;     // mm
  double rx = 0, ry = 0, rz = 0;  // deg
};
struct Point {
  Trsf trsf;
  std::string father = "world";  // the frame it is given in
};
struct Frame {
  Trsf trsf;
  std::string name;  // of the variable; its father is world
};
struct Tool {
  Trsf trsf;
};
enum class Blend { kOff, kJoint, kCartesian };
struct Mdesc {
  double accel = 100, vel = 100, decel = 100;  // % of nominal
  double tvel = 99999, rvel = 99999;           // mm/s, deg/s
  Blend blend = Blend::kOff;
  double leave = 50, reach = 50;  // mm
};
struct Dio {
  std::string link;
};
struct Sio {
  std::string link;
};

/// The order is that of Type, without kNone.
using Value =
    std::variant<double, bool, std::string, Joint, Point, Trsf, Frame, Tool, Mdesc, Dio, Sio, Blend>;

Type type_of(const Value& value);
Value default_value(Type type);

/// A run-time error as taskStatus tells it.
struct RuntimeError : std::runtime_error {
  RuntimeError(int error_number, const std::string& text) : std::runtime_error(text), number(error_number) {}
  int number;
};
inline constexpr int kErrorArithmetic = 10;
inline constexpr int kErrorIndex = 20;
inline constexpr int kErrorNoTask = 30;
inline constexpr int kErrorTaskName = 31;
inline constexpr int kErrorSyncPeriods = 32;
inline constexpr int kErrorStack = 41;
inline constexpr int kErrorInterpreter = 61;
inline constexpr int kErrorParameter = 70;
inline constexpr int kErrorMdesc = 102;
inline constexpr int kErrorWriteToInput = 122;
inline constexpr int kErrorNotLinked = 123;
inline constexpr int kErrorImpossibleMove = 150;

/// A place that can be read and written: a variable (all have an array behind them), an element of one with
/// all that follow it, or a field of an element. What a name stands for and what a parameter by reference
/// gets.
struct Place {
  std::shared_ptr<std::vector<Value>> elements;
  std::size_t offset = 0;
  std::vector<std::string> fields;

  /// Elements from here to the end.
  [[nodiscard]] std::size_t size() const { return elements->size() - offset; }
  /// The element `index` behind this one. RuntimeError 20.
  [[nodiscard]] Place element(double index) const;
  [[nodiscard]] Value read() const;
  void write(const Value& value) const;
};

Place new_variable(Type type, std::size_t size);

/// The type of a field, kNone when there is none of that name.
Type field_type(Type type, std::string_view field);

}  // namespace val3
