#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"
#include "config/cell.hpp"
#include "service/acquisition/hand_touch.hpp"
#include "service/run/hand_guide.hpp"

namespace cell {

/// A touch that a person is asked for to find the block: on which face, roughly where.
struct PlaceSpot {
  int face = 0;             // index
  Eigen::Vector3d point_m;  // on the face, in R_-1
  std::string words;        // "plane 3, near planes 1 and 2"
};

/// Three spots on the top, two on a side, one on an end: faces with known poses, the top by the direction of
/// gravity, the others as square to it and to each other as possible. Throws std::invalid_argument when the
/// cell's block has no three such faces.
std::vector<PlaceSpot> place_spots(const Cell& cell);

/// Standard deviation of a touch by hand.
inline constexpr double kHandNoiseMetres = 1e-4;
/// The farthest motion of the ball from one state to the next at which a touch counts.
inline constexpr double kHandMovedMaxMetres = 1e-3;
/// Share of the overtravel by which a touch taken by command may have moved on after the trigger.
inline constexpr double kTakenOvertravelShare = 0.5;

/// The dialogue that finds the block: a state machine without I/O. Touches go in, instructions come out;
/// after the sixth touch there is a pose or a reason why not.
class Locating {
 public:
  /// Starts from the pose of the block in `cell`.
  explicit Locating(const Cell& cell);

  /// What to do next.
  [[nodiscard]] HandGuide guide() const;
  /// Why a touch cannot be the one that is asked for; nothing when it can.
  [[nodiscard]] std::optional<std::string> why_not(const HandTouch& touch) const;
  /// Adds a touch; for one that cannot count, guide().problem says why.
  void take(const HandTouch& touch);
  /// The last touch did not count, for this reason.
  void refuse(std::string why) { problem_ = std::move(why); }
  /// Discards the last touch, if any.
  void undo();

  [[nodiscard]] const std::vector<calib::RegistrationTouch>& touches() const { return touches_; }
  /// Present when all touches are made and fit.
  [[nodiscard]] const std::optional<calib::BlockRegistration>& fit() const { return fit_; }

 private:
  void find_place();

  calib::BlockRegistrationProblem problem_of_place_;  // without touches
  double touch_noise_m_ = 0.0;
  double overtravel_m_ = 0.0;
  bool is_star_ = false;  // any of its balls trips, and only the first one finds the place
  std::vector<PlaceSpot> spots_;
  std::vector<calib::RegistrationTouch> touches_;
  std::optional<calib::BlockRegistration> fit_;
  std::optional<std::string> problem_;
};

/// Standard deviation of each error of an arm that misses by the nominal miss, or the maker's where it is
/// wider.
calib::ErrorTolerances believable_errors(const Cell& cell);

}  // namespace cell
