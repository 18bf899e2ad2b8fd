#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <string>
#include <variant>

/// What a stored value asks of the arm, and what the arm has to be told so that it goes there.
namespace cell {

/// Which of its configurations the arm takes (VAL3 manual 6, pages 133 to 136). `kSame`: that of the move
/// before; `kFree`: any.
enum class ShoulderWord { kSame, kFree, kRighty, kLefty };
enum class ElbowWord { kSame, kFree, kPositive, kNegative };
enum class WristWord { kSame, kFree, kPositive, kNegative };
struct PostureWords {
  ShoulderWord shoulder = ShoulderWord::kSame;
  ElbowWord elbow = ElbowWord::kSame;
  WristWord wrist = WristWord::kSame;
  bool operator==(const PostureWords&) const = default;
};

struct OfflineJoints {
  std::array<double, 6> joints_deg{};
};
/// Where the tool's tip is to be, in the controller's world; metres.
struct OfflinePose {
  Eigen::Isometry3d world_from_tool = Eigen::Isometry3d::Identity();
  PostureWords posture;
};
struct OfflineTarget {
  std::string name;  // "pPick[3]"
  std::variant<OfflineJoints, OfflinePose> place;
  std::string tool;  // of the list; empty where it names none
};

enum class CorrectionStatus { kOk, kWarned, kRefused };
/// What the nominal controller has to be told instead. Of a refused target only `reason` means anything.
struct Correction {
  CorrectionStatus status = CorrectionStatus::kRefused;
  std::string reason;  // of a warning or a refusal
  std::array<double, 6> joints_deg{};
  /// The pose that the nominal arm has at these joints, of the same tool, in the controller's world; metres.
  Eigen::Isometry3d world_from_tool = Eigen::Isometry3d::Identity();
  double moved_mm = 0.0;  // how far the tip would have been off without the correction
};
using Corrector = std::function<Correction(const OfflineTarget&)>;

}  // namespace cell
