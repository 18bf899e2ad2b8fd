#include "tests/figures/hidden_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "config/touched_places.hpp"
#include "service/run/run_repeats.hpp"
#include "sim_controller/contact.hpp"
#include "tests/calib_core/block_study.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr double kTouchSeconds = 7.5;      // of one touch with its way, as in the plans of the demo cell
constexpr double kStandoffMetres = 0.012;  // the search begins so far from the nominal face
constexpr double kOnFaceMetres = 1e-10;
constexpr int kContactStepsMax = 40;

/// The joint displacement that moves the ball by 1 m along `direction` without turning the stylus.
JointVector joints_per_metre(const KinematicModel& model, const JointVector& joints,
                             const Eigen::Vector3d& direction) {
  const Chain chain = forward_chain(model, joints);
  Eigen::Matrix<double, 6, 6> jacobian;
  jacobian.topRows<3>() = tip_jacobian(model, chain);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    jacobian.bottomRows<3>().col(joint) =
        model.gains[index] * chain.block_from_frame[index + 1].linear().col(2);
  }
  Eigen::Matrix<double, 6, 1> wanted = Eigen::Matrix<double, 6, 1>::Zero();
  wanted.head<3>() = direction;
  return jacobian.colPivHouseholderQr().solve(wanted);
}

cell::Truth drawn(const cell::Cell& cell, cell::Truth truth, UniformChance& chance) {
  for (int i = 0; i < kErrorParameterCount; ++i) {
    truth.errors[i] += cell.arm.std_errors[static_cast<std::size_t>(i)].value_or(0.0) * study::normal(chance);
  }
  truth.face_offsets_m.resize(cell.block.faces.size(), 0.0);
  const std::vector<double> errors_m = draw_offset_errors_m(cell::artefact_knowledge(cell), chance);
  for (std::size_t i = 0; i < errors_m.size(); ++i) truth.face_offsets_m[i] += errors_m[i];
  cell::TrueProbe& probe = truth.probe;
  probe.stylus_radius_m = probe.stylus_radius_m.value_or(cell.probe.stylus.radius_m) +
                          cell.probe.std_stylus_radius_m * study::normal(chance);
  probe.pretravel_m = probe.pretravel_m.value_or(cell.probe.stylus.pretravel_m) +
                      cell.probe.std_pretravel_m * study::normal(chance);
  for (cell::Ripple& ripple : truth.ripple) ripple.phase_rad = 2.0 * std::numbers::pi * chance();
  return truth;
}

}  // namespace

HiddenArm shipped_arm(const cell::Cell& cell, const std::string& name) {
  return {name, cell::read_truth(cell.file.parent_path() / (name + ".json"))};
}

HiddenCell::HiddenCell(const cell::Cell& cell, const HiddenArm& arm, UniformChance& chance)
    : plant_(sim::make_plant(cell, drawn(cell, arm.truth, chance))) {
  const cell::Block& block = cell.block;
  constexpr double kReferenceCelsius = 20.0;
  const double growth = 1.0 + block.thermal_expansion_per_k.value_or(0.0) *
                                  (block.temperature_c.value_or(kReferenceCelsius) - kReferenceCelsius +
                                   plant_.hidden.warming.block_warmer_k);
  for (std::size_t i = 0; i < block.faces.size(); ++i) {
    const Face& face = block.faces[i];
    const double std_rad = block.face_uncertainties[i].std_tilt_rad;
    const Eigen::AngleAxisd about_u(std_rad * study::normal(chance), face.edge_u);
    const Eigen::AngleAxisd about_v(std_rad * study::normal(chance), face.edge_v());
    const Eigen::Vector3d middle_m =
        growth * (face.center_m + plant_.hidden.face_offsets_m[i] * face.plane.outward);
    const Eigen::Vector3d outward = about_u * (about_v * face.plane.outward);
    planes_.push_back({outward, outward.dot(middle_m)});
  }
  for (int frame = 1; frame < kFrameCount; ++frame) {
    const double std =
        cell.arm.nongeometric_std[static_cast<std::size_t>(mass_position(frame))].value_or(0.0);
    plant_.truth.masses[static_cast<std::size_t>(frame)].mass_kg *= 1.0 + std * study::normal(chance);
  }
  faces_per_tip_ = faces_per_place_ = static_cast<int>(planes_.size());
  plant_.tips.clear();  // until touch_with_tips()
  world_ = sim::make_world(plant_);
  stops_.seed(static_cast<std::uint64_t>(chance() * 0x1p53));
}

void HiddenCell::touch_with_tips(const cell::Cell& cell, const cell::Recipe& recipe, UniformChance& chance) {
  const std::vector<ContactSurface> faces = planes_;
  constexpr double kDrawnMetres = 0.2e-3;  // of a star that nobody measured, along each axis
  for (const int index : recipe.tips) {
    const cell::ProbeTip& tip = cell.probe.tips[static_cast<std::size_t>(index)];
    const Eigen::Vector3d off_m(study::normal(chance), study::normal(chance), study::normal(chance));
    const double radius_m = tip.radius_m + tip.std_radius_m * study::normal(chance);
    const double smaller_m = cell.probe.stylus.radius_m - radius_m;
    plant_.tips.push_back({tip.center_m + kDrawnMetres * off_m, plant_.trip_distance_m - smaller_m});
    planes_.insert(planes_.end(), faces.begin(), faces.end());
  }
  faces_per_tip_ = static_cast<int>(faces.size());
  faces_per_place_ = static_cast<int>(planes_.size());
}

void HiddenCell::stand_at_places(const cell::Cell& cell, const cell::Recipe& recipe, UniformChance& chance) {
  const std::vector<ContactSurface> faces = planes_;
  const auto draw = [&chance](double std) -> Eigen::Vector3d {
    return std * Eigen::Vector3d(study::normal(chance), study::normal(chance), study::normal(chance));
  };
  constexpr PlaceDeviation kByEye{1e-3, 3e-3};  // where nobody certifies a step
  for (int place = 1; place < cell::place_count(recipe); ++place) {
    const ArtefactPlace there = cell::artefact_places(cell.block, recipe)[static_cast<std::size_t>(place)];
    const PlaceDeviation std = there.std.value_or(kByEye);
    const Eigen::Vector3d turn = draw(std.std_turn_rad);
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * there.pose.linear();
    const Eigen::Vector3d position_m = there.pose.translation() + draw(std.std_position_m);
    for (const ContactSurface& face : faces) {
      const Eigen::Vector3d outward = rotation * face.outward;
      planes_.push_back({outward, face.offset_m + outward.dot(position_m)});
    }
  }
}

double HiddenCell::gap_m(int face, const JointVector& joints) const {
  const ContactSurface& plane = planes_[static_cast<std::size_t>(face)];
  const Eigen::Isometry3d tool = sim::true_chain(plant_, world_, joints).block_from_frame.back();
  const double trip_m = sim::trip_distance_m(plant_, tool, plane.outward, world_.noise_m);
  const int tip = face % faces_per_place_ / faces_per_tip_;
  if (tip == 0) return signed_distance_m(plane, tool.translation()) - trip_m;
  const sim::TipBall& ball = plant_.tips[static_cast<std::size_t>(tip) - 1];
  return signed_distance_m(plane, tool * ball.center_m) -
         (trip_m + ball.trip_distance_m - plant_.trip_distance_m);
}

JointVector HiddenCell::contact_joints(const Touch& planned) {
  const Eigen::Vector3d& outward = planes_[static_cast<std::size_t>(planned.face)].outward;
  const JointVector per_metre = joints_per_metre(plant_.nominal, planned.joints, outward);
  const JointVector start = planned.joints + kStandoffMetres * per_metre;
  const JointVector half_rad = 0.5 * plant_.hidden.backlash_rad;
  world_.slack_rad = (world_.slack_rad - (start - world_.joints)).cwiseMin(half_rad).cwiseMax(-half_rad);
  world_.joints = start;
  sim::begin_search(plant_, world_, stops_);
  double along_m = kStandoffMetres;
  for (int step = 0; step < kContactStepsMax; ++step) {
    const double gap = gap_m(planned.face, planned.joints + along_m * per_metre);
    along_m -= gap;
    if (std::abs(gap) < kOnFaceMetres) return planned.joints + along_m * per_metre;
  }
  throw std::logic_error("the ball found no contact");
}

void HiddenCell::creep(const Eigen::Vector3d& by_m, std::size_t touches) {
  creep_per_touch_m_ = by_m / static_cast<double>(touches);
}

Touch HiddenCell::touch_once(const Touch& planned) {
  crept_m_ += creep_per_touch_m_;
  for (ContactSurface& plane : planes_) plane.offset_m += plane.outward.dot(creep_per_touch_m_);
  sim::pass(plant_, world_, kTouchSeconds);
  Touch made = planned;
  made.joints = contact_joints(planned);
  world_.slack_rad = (world_.slack_rad - (made.joints - world_.joints))
                         .cwiseMin(0.5 * plant_.hidden.backlash_rad)
                         .cwiseMax(-0.5 * plant_.hidden.backlash_rad);
  world_.joints = made.joints;
  made.joints = sim::encoder_reading(plant_, made.joints);
  return made;
}

std::vector<Touch> HiddenCell::touch(const std::vector<Touch>& planned, int reference_every) {
  std::vector<Touch> captured;
  const Touch* place = nullptr;
  const auto look_again = [&] {
    if (reference_every > 0 && place) references_.push_back(touch_once(*place));
  };
  for (const Touch& touch : planned) {
    const bool is_elsewhere = place && place->face / faces_per_place_ != touch.face / faces_per_place_;
    if (is_elsewhere) {
      look_again();
      place = nullptr;
    }
    captured.push_back(touch_once(touch));
    const auto done = static_cast<int>(captured.size());
    const bool is_first = !place && touch.role == TouchRole::kFit;
    if (is_first) place = &touch;
    if (reference_every > 0 && (is_first || done % reference_every == 0)) look_again();
    if (touch.role != TouchRole::kFit) continue;
    rise_sum_k_ += world_.rise_k;
    ++fitted_;
  }
  look_again();
  return captured;
}

std::vector<Eigen::Vector3d> HiddenCell::tips_m(const std::vector<JointVector>& postures,
                                                double rise_k) const {
  std::vector<Eigen::Vector3d> tips;
  for (const Chain& chain : chains(postures, rise_k)) tips.push_back(chain.tip_in_block_m());
  return tips;
}

std::vector<Chain> HiddenCell::chains(const std::vector<JointVector>& postures, double rise_k) const {
  sim::Plant warm = plant_;
  warm.hidden.warming.arm_rise_k = rise_k;
  warm.hidden.warming.arm_time_constant_s = 1.0;
  warm.hidden.backlash_rad.setZero();
  sim::World world = sim::make_world(warm);
  constexpr double kLongSeconds = 100.0;
  sim::pass(warm, world, kLongSeconds);
  std::vector<Chain> chains;
  for (const JointVector& joints : postures) chains.push_back(sim::true_chain(warm, world, joints));
  return chains;
}

std::vector<Eigen::Vector3d> HiddenCell::tips_in_world_m(const std::vector<JointVector>& postures,
                                                         double rise_k) const {
  const auto& links = plant_.truth.links;
  const Eigen::Isometry3d world_from_block =
      (frame_transform(links[0]) * frame_transform(links[1])).inverse();
  std::vector<Eigen::Vector3d> tips = tips_m(postures, rise_k);
  for (Eigen::Vector3d& tip_m : tips) tip_m = world_from_block * tip_m;
  return tips;
}

void make_run(HiddenCell& hidden, const std::vector<Touch>& planned, const cell::Recipe& recipe,
              IdentificationProblem& problem) {
  problem.touches = hidden.touch(planned, recipe.reference_every);
  cell::note_repeats(
      {.references = hidden.references(), .reference_times_s = {}, .two_speed = {}, .touched_again = {}},
      problem);
}

}  // namespace calib::figures
