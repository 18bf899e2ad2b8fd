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

/// What is asked of a person to find the block: which faces, roughly where.
struct PlaceSpot {
  int face = 0;             // index
  Eigen::Vector3d point_m;  // on the face, in R_-1
  std::string words;        // "plane 3, near planes 1 and 2"
};

/// Three spots on the top, two on a side, one on an end: faces whose places are known, with the top where
/// gravity has it and the others as square to it and to each other as there are. Throws std::invalid_argument
/// when the cell's block has no three such faces.
std::vector<PlaceSpot> place_spots(const Cell& cell);

/// How exactly a touch by hand tells where the face is.
inline constexpr double kHandNoiseMetres = 1e-4;
/// A ball that went farther than this from one state to the next came too fast.
inline constexpr double kHandMovedMaxMetres = 1e-3;
/// A touch that was taken by word may have gone on behind the trigger by this share of the overtravel.
inline constexpr double kTakenOvertravelShare = 0.5;

/// The dialogue that finds the block: a step machine without I/O. Touches go in, what to do next comes out;
/// behind the sixth touch there is a place or a reason why not.
class Locating {
 public:
  /// The block is sought from where `cell` has it.
  explicit Locating(const Cell& cell);

  /// What to do next.
  [[nodiscard]] HandGuide guide() const;
  /// One touch more; one that cannot count is told by guide().problem.
  void take(const HandTouch& touch);
  /// Forgets the last touch; nothing happens when there is none.
  void undo();

  [[nodiscard]] const std::vector<calib::RegistrationTouch>& touches() const { return touches_; }
  /// Once all touches are made and fit.
  [[nodiscard]] const std::optional<calib::BlockRegistration>& fit() const { return fit_; }

 private:
  void find_place();

  calib::BlockRegistrationProblem problem_of_place_;  // without touches
  double touch_noise_m_ = 0.0;
  double overtravel_m_ = 0.0;
  std::vector<PlaceSpot> spots_;
  std::vector<calib::RegistrationTouch> touches_;
  std::optional<calib::BlockRegistration> fit_;
  std::optional<std::string> problem_;
};

/// One standard deviation of each error of an arm that is known as well as the nominal miss says; the maker's
/// where they are wider.
calib::ErrorTolerances believable_errors(const Cell& cell);

}  // namespace cell
