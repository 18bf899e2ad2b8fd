#include "tests/sim_controller/aimed_touch.hpp"

#include <Eigen/Geometry>
#include <stdexcept>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "sim_controller/admission.hpp"
#include "tests/sim_controller/whole_path.hpp"

namespace sim::testing {

std::string cell_folder(const std::string& name) {
  return std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + name;
}

cell::Cell read_cell(const std::string& name) { return cell::read_cell(cell_folder(name) + "/cell.json"); }

Plant true_plant(const std::string& name) {
  return make_plant(read_cell(name), cell::read_truth(cell_folder(name) + "/truth.json").errors);
}

Plant perfect_plant(const std::string& name) {
  return make_plant(read_cell(name), calib::ErrorVector::Zero());
}

AimedTouch aimed_touch(const cell::Cell& cell, const Aim& aim) {
  const Plant nominal = make_plant(cell, calib::ErrorVector::Zero());
  const calib::Face& face = cell.block.faces.at(static_cast<std::size_t>(aim.face));
  const calib::ContactSurface plane = calib::contact_plane(face, cell.probe.stylus);
  const Eigen::Vector3d point = face.center_m + aim.u_m * face.edge_u + aim.v_m * face.edge_v() +
                                (plane.offset_m - face.plane.offset_m) * plane.outward;
  for (int azimuth = 0; azimuth < 12; ++azimuth) {
    for (int spin = 0; spin < 12; ++spin) {
      const auto turn = [](int twelfths, const Eigen::Vector3d& axis) {
        return Eigen::AngleAxisd(calib::radians_from_degrees(30.0 * twelfths), axis);
      };
      const Eigen::Vector3d tilt_axis = turn(azimuth, plane.outward) * face.edge_u;
      const Eigen::Vector3d stylus = Eigen::AngleAxisd(aim.tilt_rad, tilt_axis) * -plane.outward;
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = (turn(spin, stylus) * calib::shortest_rotation(Eigen::Vector3d::UnitZ(), stylus))
                          .toRotationMatrix();
      pose.translation() = point;
      const auto at_height = [&](double height_m, const calib::JointVector& near) {
        Eigen::Isometry3d there = pose;
        there.translation() += height_m * plane.outward;
        return calib::solve_near(nominal.nominal, there, near);
      };
      for (const calib::JointVector& joints :
           calib::inverse_kinematics(nominal.nominal, nominal.joint_ranges, pose)) {
        const auto clear = at_height(kClearMetres, joints);
        const auto approach = at_height(aim.standoff_m, joints);
        const auto end = at_height(-aim.end_depth_m, joints);
        if (!clear || !approach || !end) continue;
        const bool in_range = nominal.joint_ranges.contains(*clear) &&
                              nominal.joint_ranges.contains(*approach) && nominal.joint_ranges.contains(*end);
        const TouchMotion motion{{*clear}, *approach, *end, 0.25, 0.02, 0.008};
        if (!in_range) continue;
        const ToolPath line = straight_line(nominal, *approach, *end);
        const double until = find_trip(nominal, line.path, 0.0).value_or(1.0);
        if (!line.complete || find_hit(nominal, {*clear, *approach}, 1.0) ||
            find_hit(nominal, line.path, until))
          continue;
        return {motion, face, plane};
      }
    }
  }
  throw std::logic_error("no posture for the touch of this test");
}

std::optional<calib::JointVector> search_contact(const Plant& plant, const TouchMotion& motion,
                                                 double noise_m) {
  const ToolPath line = straight_line(plant, motion.approach, motion.search_end);
  const auto trip = find_trip(plant, line.path, noise_m);
  return trip ? std::optional(posture(line.path, *trip)) : std::nullopt;
}

Eigen::Vector3d tip_m(const calib::KinematicModel& model, const calib::JointVector& joints) {
  return calib::forward_kinematics(model, joints).translation();
}

}  // namespace sim::testing
