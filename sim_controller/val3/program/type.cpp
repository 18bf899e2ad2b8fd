#include "sim_controller/val3/program/type.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace val3 {
namespace {

constexpr std::array<Field, 6> kJointFields{{{"j1", Kind::kNum},
                                             {"j2", Kind::kNum},
                                             {"j3", Kind::kNum},
                                             {"j4", Kind::kNum},
                                             {"j5", Kind::kNum},
                                             {"j6", Kind::kNum}}};
constexpr std::array<Field, 6> kTrsfFields{{{"x", Kind::kNum},
                                            {"y", Kind::kNum},
                                            {"z", Kind::kNum},
                                            {"rx", Kind::kNum},
                                            {"ry", Kind::kNum},
                                            {"rz", Kind::kNum}}};
constexpr std::array<Field, 1> kFrameFields{{{"trsf", Kind::kTrsf}}};
constexpr std::array<Field, 4> kToolFields{
    {{"trsf", Kind::kTrsf}, {"gripper", Kind::kDio}, {"otime", Kind::kNum}, {"ctime", Kind::kNum}}};
constexpr std::array<Field, 2> kPointFields{{{"trsf", Kind::kTrsf}, {"config", Kind::kConfig}}};
constexpr std::array<Field, 2> kPointRsFields{{{"trsf", Kind::kTrsf}, {"config", Kind::kConfigRs}}};
constexpr std::array<Field, 3> kConfigFields{
    {{"shoulder", Kind::kShoulder}, {"elbow", Kind::kElbow}, {"wrist", Kind::kWrist}}};
constexpr std::array<Field, 8> kMdescFields{{{"accel", Kind::kNum},
                                             {"vel", Kind::kNum},
                                             {"decel", Kind::kNum},
                                             {"tvel", Kind::kNum},
                                             {"rvel", Kind::kNum},
                                             {"blend", Kind::kBlend},
                                             {"leave", Kind::kNum},
                                             {"reach", Kind::kNum}}};

// The first word of a kind is the one that messages write.
constexpr std::pair<std::string_view, Kind> kTypeWords[] = {
    {"num", Kind::kNum},           {"bool", Kind::kBool},       {"string", Kind::kString},
    {"dio", Kind::kDio},           {"aio", Kind::kAio},         {"sio", Kind::kSio},
    {"trsf", Kind::kTrsf},         {"frame", Kind::kFrame},     {"tool", Kind::kTool},
    {"mdesc", Kind::kMdesc},       {"jointRx", Kind::kJoint},   {"joint", Kind::kJoint},
    {"jointVrb", Kind::kJoint},    {"jointRs", Kind::kJointRs}, {"pointRx", Kind::kPoint},
    {"point", Kind::kPoint},       {"pointVrb", Kind::kPoint},  {"pointRs", Kind::kPointRs},
    {"configRx", Kind::kConfig},   {"config", Kind::kConfig},   {"configVrb", Kind::kConfig},
    {"configRs", Kind::kConfigRs}, {"screen", Kind::kScreen}};

}  // namespace

Kind kind_named(std::string_view word) {
  const auto* const found = std::ranges::find(kTypeWords, word, &std::pair<std::string_view, Kind>::first);
  return found == std::end(kTypeWords) ? Kind::kVoid : found->second;
}

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::kVoid:
      return "nothing";
    case Kind::kBlend:
      return "blend";
    case Kind::kShoulder:
      return "shoulder";
    case Kind::kElbow:
      return "elbow";
    case Kind::kWrist:
      return "wrist";
    case Kind::kUser:
      return "user type";
    default:
      break;
  }
  const auto* const found = std::ranges::find(kTypeWords, kind, &std::pair<std::string_view, Kind>::second);
  return found == std::end(kTypeWords) ? "nothing" : found->first;
}

Kind field_of(Kind kind, std::string_view field) {
  const auto fields = fields_of(kind);
  const auto found = std::ranges::find(fields, field, &Field::name);
  return found == fields.end() ? Kind::kVoid : found->kind;
}

std::span<const Field> fields_of(Kind kind) {
  switch (kind) {
    case Kind::kTrsf:
      return kTrsfFields;
    case Kind::kFrame:
      return kFrameFields;
    case Kind::kTool:
      return kToolFields;
    case Kind::kMdesc:
      return kMdescFields;
    case Kind::kJoint:
      return kJointFields;
    case Kind::kJointRs:
      return std::span(kJointFields).first(4);
    case Kind::kPoint:
      return kPointFields;
    case Kind::kPointRs:
      return kPointRsFields;
    case Kind::kConfig:
      return kConfigFields;
    case Kind::kConfigRs:
      return std::span(kConfigFields).first(1);
    default:
      return {};
  }
}

}  // namespace val3
