#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/estimation/pure_error.hpp"
#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/proof/calibration_record.hpp"

/// What a touch probe is like, from touches in which hardly anything but joint 6 moves: whatever the arm is
/// wrong by is then the same in all of them and falls out.
///
/// One face is touched with a leaning stylus that is turned about itself. With the nominal arm, u the push on
/// the ball in R_7 and the shapes of sideways_shapes(), a touch is
///
///     distance = c - e_x u_x - e_y u_y - l_c s^2 cos 3a - l_s s^2 sin 3a
///
/// from the face: c is the arm's error there (with the tilt of the pre-travel, which no turning shows), e the
/// run-out of the ball, l the lobes beyond those that the probe's file declares. Four turns of 90 degrees
/// cannot tell e from l: eight of 45 do.
namespace calib {

inline constexpr int kTurnCount = 8;     // evenly about the stylus, from that of the repeats on
inline constexpr int kRepeatCount = 10;  // touches of the first turn
inline constexpr int kStepTouches = 2;   // of either face of a known length

struct QualificationLimits {
  double scatter_max_m = 0.0;  // one standard deviation; kept unless the repeats show that it is exceeded
  std::optional<double> run_out_max_m;
  std::optional<double> lobes_max_m;  // amplitude, beyond what the probe's file declares
  std::optional<double> step_max_m;   // of a known length, as the calibrated arm measures it
  double p_min = 0.001;               // of each test: what is less likely is no chance
  bool guarded = false;               // a size must be within its limit with its expanded uncertainty, k = 2
};

/// What the touches are held against.
struct QualificationProblem {
  KinematicModel nominal;                // with the ball's centre where the cell's files have it
  std::vector<ContactSurface> surfaces;  // nominal, one a face
  std::vector<KnownLength> lengths;      // certified; those that were touched are judged
  QualificationLimits limits;
  const CalibrationRecord* record = nullptr;  // with the block where it stands; null: nothing judges lengths
  double std_growth = 0.0;                    // of the arm since that calibration, a share of its lengths
};

/// A vector across the stylus, in x and y of R_7.
struct AcrossStylus {
  Eigen::Vector2d value_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();

  [[nodiscard]] double size_m() const { return value_m.norm(); }
  /// One standard deviation of the size; along any direction where the size is 0.
  [[nodiscard]] double std_size_m() const;
  [[nodiscard]] double direction_rad() const;  // from x to y
};

/// The ball against where the calibrated arm has it.
struct StylusChange {
  AcrossStylus offset;
  double p = 1.0;  // of so large an offset by noise and by what the calibration left open
};

/// A certified length as the calibrated arm measures it.
struct StepReading {
  std::array<int, 2> faces{};
  double known_m = 0.0;
  double error_m = 0.0;  // measured less as the calibration has it, which took the certificate into account
  double std_m = 0.0;    // noise, the arm's warmth, what the calibration left open, block and ball among it
  double p = 1.0;        // of so large an error
};

/// What is judged: value within limit. Of a test the value is its p and the limit the least.
struct QualificationCriterion {
  enum class Kind { kScatter, kRunOut, kLobes, kTurns, kChange, kStep };
  Kind kind = Kind::kScatter;
  std::array<int, 2> faces{};  // of kStep
  double value = 0.0;          // metres, or a probability
  std::optional<double> limit;
  std::optional<double> std;  // of the value, metres
  bool passed = true;
};

struct QualificationVerdict {
  TouchNoise scatter;  // of the repeats about their mean
  AcrossStylus run_out;
  AcrossStylus lobes;  // beyond the declared ones; (cos, sin) of three times the direction of a lobe
  [[nodiscard]] double lobe_direction_rad() const { return lobes.direction_rad() / 3.0; }
  double turns_p = 1.0;  // that noise alone is between the turns and the model, by F against the repeats
  std::optional<StylusChange> change;
  std::vector<StepReading> steps;
  /// Of each touch, metres: of the turns from the model, of a length from its face by the calibrated arm;
  /// nothing where there is none.
  std::vector<std::optional<double>> deviations_m;
  std::vector<QualificationCriterion> criteria;
  bool passed = false;
  std::vector<std::string> reasons;  // why it did not; one sentence each with what to do
};

/// Why there is no verdict: one sentence with the remedy.
struct QualificationRefusal {
  std::string message;
};

/// The touches may have any order: the repeats and turns are those at the place and with the direction of the
/// stylus that most have. Refused: a face that does not exist, numbers that are not finite, fewer than eight
/// turns or ten repeats, repeats that are copies of each other.
std::variant<QualificationVerdict, QualificationRefusal> qualify(const QualificationProblem& problem,
                                                                 std::span<const Touch> touches);

}  // namespace calib
