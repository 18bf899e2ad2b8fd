#include "calib_core/qualification/turned_touches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

namespace calib {
namespace {

using IndexList = std::vector<std::size_t>;

/// Those that are alike to one of them, of the one that most are alike to.
IndexList largest_group(const IndexList& among,
                        const std::function<bool(std::size_t, std::size_t)>& are_alike) {
  IndexList largest;
  for (const std::size_t one : among) {
    IndexList group;
    std::ranges::copy_if(among, std::back_inserter(group),
                         [&](std::size_t other) { return are_alike(one, other); });
    if (group.size() > largest.size()) largest = std::move(group);
  }
  return largest;
}

/// How far a pose of the tip is turned about its z axis against another one that leans alike.
double turn_rad(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other) {
  const Eigen::Matrix3d between = one.linear().transpose() * other.linear();
  return std::abs(std::atan2(between(1, 0) - between(0, 1), between(0, 0) + between(1, 1)));
}

}  // namespace

TurnedTouches turned_touches(const KinematicModel& nominal, std::span<const ContactSurface> surfaces,
                             std::span<const Touch> touches) {
  const PreparedModel prepared = prepare(nominal);
  std::vector<Eigen::Isometry3d> tips;
  IndexList every;
  for (const Touch& touch : touches) {
    every.push_back(tips.size());
    tips.push_back(forward_chain(prepared, touch.joints).block_from_frame.back());
  }
  const auto are_of_one_place = [&](std::size_t one, std::size_t other) {
    const double cosine = tips[one].linear().col(2).dot(tips[other].linear().col(2));
    const Eigen::Vector3d& outward = surfaces[static_cast<std::size_t>(touches[one].face)].outward;
    const Eigen::Vector3d between_m = tips[one].translation() - tips[other].translation();
    return touches[one].face == touches[other].face &&
           (between_m - outward.dot(between_m) * outward).norm() < kSameTurningPlaceMetres &&
           std::acos(std::clamp(cosine, -1.0, 1.0)) < kSameLeanRadians;
  };
  const auto are_turned_alike = [&](std::size_t one, std::size_t other) {
    return turn_rad(tips[one], tips[other]) < kSameTurnRadians;
  };
  TurnedTouches turned{.all = largest_group(every, are_of_one_place)};
  turned.repeats = largest_group(turned.all, are_turned_alike);
  IndexList left = turned.all;
  while (!left.empty()) {
    const std::size_t first = left.front();
    std::erase_if(left, [&](std::size_t other) { return are_turned_alike(first, other); });
    ++turned.directions;
  }
  return turned;
}

}  // namespace calib
