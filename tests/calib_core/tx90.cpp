#include "tests/calib_core/tx90.hpp"

#include "calib_core/geometry/units.hpp"

namespace calib::tx90 {

JointVector degrees(double j1, double j2, double j3, double j4, double j5, double j6) {
  return kRadiansPerDegree * JointVector(j1, j2, j3, j4, j5, j6);
}

JointRanges joint_ranges() {
  return {degrees(-180, -130, -145, -270, -115, -270), degrees(180, 147.5, 145, 270, 140, 270)};
}

JointVector park_joints() { return degrees(0, 0, 60, 0, 90, 0); }

std::vector<Capsule> arm_bodies() {
  return {{"shoulder", 1, {0, 0, -0.368}, {0, 0, 0}, 0.110},
          {"upper arm", 2, {0, 0, 0.050}, {0.425, 0, 0.050}, 0.080},
          {"forearm", 4, {0, 0, -0.425}, {0, 0, -0.070}, 0.070},
          {"wrist", 5, {0, 0, 0}, {0, 0, 0}, 0.050},
          {"flange", 6, {0, 0, 0}, {0, 0, 0.060}, 0.040}};
}

std::vector<Capsule> probe_bodies(double ball_radius_m) {
  std::vector<Capsule> bodies{{"tool holder", 7, {0, 0, -0.2189}, {0, 0, -0.091}, 0.040},
                              {"probe body", 7, {0, 0, -0.091}, {0, 0, -0.050}, 0.0125},
                              {"stem", 7, {0, 0, -0.050}, {0, 0, -0.004}, 0.0015}};
  if (ball_radius_m > 0.0) bodies.push_back({"ball", 7, {0, 0, 0}, {0, 0, 0}, ball_radius_m});
  return bodies;
}

std::vector<Box> obstacles() {
  return {{"block", {-0.075, -0.150, -0.075}, {0.075, 0.0, 0.075}},
          {"plate", {-0.200, 0.0, -0.200}, {0.200, 0.020, 0.200}},
          {"table", {-0.400, 0.020, -0.600}, {0.600, 0.060, 0.600}}};
}

CollisionScene scene(double ball_radius_m) {
  CollisionScene scene{.bodies = arm_bodies(), .obstacles = obstacles()};
  for (Capsule& body : probe_bodies(ball_radius_m)) scene.bodies.push_back(std::move(body));
  return scene;
}

std::vector<Face> faces() {
  return {{{{0, 0, -1}, 0.075}, {0, -0.075, -0.075}, {1, 0, 0}, {0.075, 0.075}},
          {{{-1, 0, 0}, 0.075}, {-0.075, -0.075, 0}, {0, 0, 1}, {0.075, 0.075}},
          {{{0, -1, 0}, 0.150}, {0, -0.150, 0}, {1, 0, 0}, {0.075, 0.075}},
          {{{0, 0, 1}, 0.075}, {0, -0.075, 0.075}, {1, 0, 0}, {0.075, 0.075}},
          {{{0, -1, 0}, 0.0}, {0.140, 0, 0}, {1, 0, 0}, {0.050, 0.170}}};
}

}  // namespace calib::tx90
