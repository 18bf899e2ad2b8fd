#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace val3 {

/// The types of VAL3 s5 to s8 that a variable or an expression can have. `joint` of a data file means
/// kJoint on a six-axis arm, as jointRx does; likewise point and config.
enum class Kind : std::uint8_t {
  kVoid,  // a call without a result
  kNum,
  kBool,
  kString,
  kDio,
  kAio,
  kSio,
  kTrsf,
  kFrame,
  kTool,
  kMdesc,
  kJoint,    // six axes
  kJointRs,  // a SCARA's four
  kPoint,
  kPointRs,
  kConfig,
  kConfigRs,
  kScreen,    // s7: a user page
  kBlend,     // off, joint, Cartesian
  kShoulder,  // righty, lefty, ssame, sfree
  kElbow,     // epositive, enegative, esame, efree
  kWrist,     // wpositive, wnegative, wsame, wfree
  kUser,      // a type of the application
};

struct Type {
  Kind kind = Kind::kVoid;
  int user = -1;  // of kUser: index into Application::user_types
  bool operator==(const Type&) const = default;
};

/// As data and program files write it: "num", "jointRx", "joint". kVoid for any other word; a user's type is
/// found in the application.
Kind kind_named(std::string_view word);
/// As messages write it: "num", "jointRx", "nothing".
std::string_view name_of(Kind kind);
/// The type of a built-in type's field ("x" of a trsf); kVoid when there is none of that name.
Kind field_of(Kind kind, std::string_view field);
/// A built-in type's fields in the order of a literal in braces (manual 6, page 20); none of a num.
struct Field {
  std::string_view name;
  Kind kind;
};
std::span<const Field> fields_of(Kind kind);

}  // namespace val3
