#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/planning/touch_planning.hpp"

/// Aiming on the way: from the first touch on, the touches themselves say where the arm really goes.
namespace calib {

/// A touch that the touches before it aimed begins its search at least so far before its face.
inline constexpr double kAimedStandoffMinMetres = 0.005;
/// No miss is predicted to be less: an arm also droops, warms up and lies in its gears' play.
inline constexpr double kPredictedMissMinMetres = 0.001;

/// How a contact was where it was expected, along the face's normal.
struct AimedContact {
  double miss_m = 0.0;  // of the ball as it was believed to stand then; positive outside the material
  double predicted_miss_m = 0.0;  // 3 sigma of it
  bool contradicts = false;       // the other touches; it has no say until it agrees with them
};

/// What the touches so far tell of an arm. A value: a copy goes its own way.
///
/// The maximum a posteriori estimate of every error (theta0 to beta7, the compliance of joints 2 and 3 where
/// somebody has a figure) and every artefact parameter, linearised anew at each touch. Before the first touch
/// an error is taken to be as large as its tolerance or as the nominal miss allows, whichever is more: a
/// length nominal_miss / 6, an angle nominal_miss / 6 per metre, the block's place nominal_miss / 2 and
/// nominal_miss / 2 over 0.6 m; the offset and tilts of a face that is estimated in place likewise. A touch
/// counts with 0.1 mm: nothing says here that droop, ripple and play are small beside the declared noise.
class Aim {
 public:
  /// Knows nothing but `problem`: its nominal arm, knowledge, nominal miss and bodies.
  explicit Aim(const PlanningProblem& problem);

  /// One contact more, of whatever role. It is left out when it is more than 5 standard deviations off what
  /// the others say; the touch that fits least goes first.
  AimedContact add(const Touch& touch);

  [[nodiscard]] std::size_t touch_count() const { return knowledge_.touches.size(); }
  /// The nominal arm with the estimated errors.
  [[nodiscard]] const KinematicModel& model() const { return model_; }

  /// 3 sigma of where the ball is at these joints, in the worst direction, from the covariance of all errors;
  /// more when the last touches missed by more than was predicted. Never above the nominal miss, for which
  /// the nominal arm itself is good enough, and never below kPredictedMissMinMetres.
  [[nodiscard]] double predicted_miss_m(const JointVector& joints) const;

  /// The problem of a move or touch that goes through these postures: `nominal` is the estimate, the nominal
  /// miss the largest predicted one, and a body that may be farther off than the ball has that as its margin.
  /// Nothing when the nominal arm is as good: it misses by less there than is predicted of the estimate; and
  /// nothing in a cell with a face that is estimated in place, whose solid nobody knows well enough.
  [[nodiscard]] std::optional<PlanningProblem> aimed_problem(const PlanningProblem& problem,
                                                             std::span<const JointVector> postures) const;

  /// How far the estimate has a face's contact plane off where it is written down, at a point; along the
  /// outward normal. Only faces that are estimated in place move by more than their uncertainty.
  [[nodiscard]] double face_shift_m(int face, const Eigen::Vector3d& point_m) const;

 private:
  void solve(LeastSquares& fit);
  bool drop_one(LeastSquares& fit);
  void take_back(const LeastSquares& fit);
  /// The same of a body's middle line, in a posture of model().
  [[nodiscard]] double predicted_miss_m(const PreparedModel& prepared, const Chain& chain,
                                        const Capsule& body) const;
  [[nodiscard]] double inflation() const;

  IdentificationProblem knowledge_;  // with the touches and the wide tolerances
  std::vector<int> columns_;         // of ArmVector
  double nominal_miss_m_ = 0.0;
  std::vector<bool> kept_;         // of the touches
  std::vector<double> surprises_;  // one a touch: miss over its standard deviation
  Estimate estimate_;
  KinematicModel model_;
  Eigen::MatrixXd covariance_;  // of the unknowns: columns_, then the artefact
};

/// A touch that was aimed, and what it was made with: the arm as it was believed to be and how far off, by
/// which its approach, its search and a way to the park posture are clear.
struct AimedTouch {
  PlannedTouch touch;
  PlanningProblem problem;
};

/// The planned touch at the same point of its face and in the same orientation, aimed with all that is known;
/// its approach, search and clear posture follow the predicted miss. As long as the nominal arm is as good,
/// it is the planned touch with the nominal miss. Or in a few words why it cannot be made.
std::variant<AimedTouch, std::string> aim_touch(const PlanningProblem& problem, const Aim& aim,
                                                const PlannedTouch& planned);

/// The planned touch as the nominal arm makes it when nothing is known: with the nominal miss.
std::variant<AimedTouch, std::string> nominal_touch(const PlanningProblem& problem,
                                                    const PlannedTouch& planned);

/// Where a transfer begins or ends: a posture, the direction in which its last or next touch leaves the face,
/// and the problem with which a way from there to the park posture is known to be clear (null: the nominal
/// one), which must outlive this.
struct TransferEnd {
  JointVector joints;
  std::optional<Eigen::Vector3d> outward;
  const PlanningProblem* made_with = nullptr;
};
TransferEnd end_of(const AimedTouch& touch);

/// find_transfer for an arm that is known as far as `aim` says, clear by the largest predicted miss on the
/// way. An end that is nearer to its face than that (the touch has told where the face really is) is first
/// left, or reached last, along `outward`. At most kAimedTransferPosturesMax postures.
std::optional<std::vector<JointVector>> find_aimed_transfer(const PlanningProblem& problem, const Aim& aim,
                                                            const TransferEnd& from, const TransferEnd& to);
inline constexpr std::size_t kAimedTransferPosturesMax = 5;

/// What the miss of each touch will be when its turn comes, made in this order; the first is the nominal one.
/// From the covariances alone: no touch needs to have been made.
std::vector<double> predicted_misses_m(const PlanningProblem& problem, std::span<const PlannedTouch> touches);

}  // namespace calib
