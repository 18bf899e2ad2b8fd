#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "config/recipe.hpp"
#include "config/truth.hpp"
#include "sim_controller/world.hpp"

/// Calibrations of an arm that the identified model cannot represent exactly: the physics of the simulated
/// controller (droop, uneven gears, play, warming, stop scatter, the probe's tilt and lobes), touched along
/// the search's line but without its motion in time.
namespace calib::figures {

/// A hidden arm and what it does beside its nominal model.
struct HiddenArm {
  std::string name;
  cell::Truth truth;  // the centre of what a seed draws
};

/// The truth file of this name beside the cell's file.
HiddenArm shipped_arm(const cell::Cell& cell, const std::string& name);

/// One seed's cell: geometry, masses, block, ball, pre-travel and phases of the gears drawn around the truth
/// from the deviations that the cell's files declare.
class HiddenCell {
 public:
  HiddenCell(const cell::Cell& cell, const HiddenArm& arm, UniformChance& chance);

  /// The recipe's tips touch beside the first one, each ball off its drawing as an unmeasured star's are;
  /// before stand_at_places().
  void touch_with_tips(const cell::Cell& cell, const cell::Recipe& recipe, UniformChance& chance);

  /// The block can stand at the recipe's places: each true step is drawn from what the block's file says.
  void stand_at_places(const cell::Cell& cell, const cell::Recipe& recipe, UniformChance& chance);

  /// Makes these touches of the nominal arm in their order, while the arm warms up; after every so many the
  /// place of the first fitted one again, at the start and at the end too (0: never), as a run does; at each
  /// place of the block its own.
  std::vector<Touch> touch(const std::vector<Touch>& planned, int reference_every = 0);

  /// The stops and the probe scatter from now on as this seed draws them: cells of one seed that differ in
  /// their place, warmth or a fault share everything else.
  void restart_scatter(std::uint64_t seed) { stops_.seed(seed); }

  /// From now on the block creeps by this in all, evenly over so many touches.
  void creep(const Eigen::Vector3d& by_m, std::size_t touches);
  /// Where the block is now against the beginning.
  [[nodiscard]] const Eigen::Vector3d& crept_m() const { return crept_m_; }

  /// The touches of that place so far.
  [[nodiscard]] const std::vector<Touch>& references() const { return references_; }

  /// The arm's temperature above cold, mean over the fitted touches made so far.
  [[nodiscard]] double mean_rise_k() const { return rise_sum_k_ / fitted_; }

  /// Where the ball is at commanded joints, with the arm this much warmer than cold and without play.
  [[nodiscard]] std::vector<Eigen::Vector3d> tips_m(const std::vector<JointVector>& postures,
                                                    double rise_k) const;
  /// All frames likewise.
  [[nodiscard]] std::vector<Chain> chains(const std::vector<JointVector>& postures, double rise_k) const;
  /// The ball in the controller's world, which begins behind the place of the block.
  [[nodiscard]] std::vector<Eigen::Vector3d> tips_in_world_m(const std::vector<JointVector>& postures,
                                                             double rise_k) const;

 private:
  Touch touch_once(const Touch& planned);
  JointVector contact_joints(const Touch& planned);
  [[nodiscard]] double gap_m(int face, const JointVector& joints) const;

  std::vector<ContactSurface> planes_;  // where the faces really are, at each place of the block
  int faces_per_tip_ = 0, faces_per_place_ = 0;
  sim::Plant plant_;
  sim::World world_;
  std::mt19937_64 stops_;
  std::vector<Touch> references_;
  Eigen::Vector3d crept_m_ = Eigen::Vector3d::Zero(), creep_per_touch_m_ = Eigen::Vector3d::Zero();
  double rise_sum_k_ = 0.0;
  int fitted_ = 0;
};

/// A whole run: its touches, and what the reference place says of them, go into `problem`.
void make_run(HiddenCell& hidden, const std::vector<Touch>& planned, const cell::Recipe& recipe,
              IdentificationProblem& problem);

}  // namespace calib::figures
