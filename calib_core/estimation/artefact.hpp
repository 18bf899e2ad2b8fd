#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/face.hpp"

namespace calib {

/// How well one face is known: standard deviations, 0 is exactly known. An estimated face is known from its
/// drawing only: its offset and tilts have no prior, nor do the centre of a sphere and the place of the axis
/// of a bore; the radius keeps its own, as a ball or a ring is certified without its place, and so do the
/// tilts of the axis, which the short way that a ball goes into a bore shows only poorly.
struct FaceUncertainty {
  double std_offset_m = 0.0;  // of a sphere or bore, of its radius
  double std_tilt_rad = 0.0;  // about each of the face's two edges; of the axis of a bore about outward and
                              // across
  bool estimated = false;
  double std_center_m = 0.0;  // of each coordinate of a sphere's centre, of a bore's axis across it
};

/// The certified distance of two parallel faces at 20 degrees C. It is of the same certificate as the offsets
/// of the faces: both are statements about one measurement.
struct KnownLength {
  std::array<int, 2> faces{};  // indices
  double value_m = 0.0;
  double std_m = 0.0;
};

/// How well the pose of a place is known: standard deviations along each axis and about each, about the
/// origin of its own R_-1. All 0: exactly.
struct PlaceDeviation {
  double std_position_m = 0.0;
  double std_turn_rad = 0.0;
};

/// One of the places at which an artefact is touched: all of its faces move with one rigid pose. The step
/// between two places that is known is a ruler of its own (see use-and-plant, section 3 of the references).
struct ArtefactPlace {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();    // of R_-1 there, in the R_-1 of the problem
  std::optional<PlaceDeviation> std = PlaceDeviation{};      // nothing: found by the touches
  Eigen::Vector3d growth_m_per_k = Eigen::Vector3d::Zero();  // of what it stands on, in the same R_-1
};

/// A further tip of a star stylus: a ball of its own beside that at the origin of R_7. Where its centre is,
/// the touches with it find: the arms of a star are known no better.
struct ArtefactTip {
  std::string name;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();  // in R_7, by the drawing
  double radius_m = 0.0;
  double std_radius_m = 0.0;
  double within_m = 0.0;  // how far its centre may be from there
};

/// The material measure of a calibration: the faces and the ball, with the uncertainty of each. Revolute
/// joints measure no length, so these are the only length references, and the residuals do not show their
/// errors.
struct ArtefactKnowledge {
  std::vector<Face> faces;                          // at 20 degrees C
  std::vector<FaceUncertainty> face_uncertainties;  // one per face, or empty: all exactly known
  std::vector<KnownLength> lengths;
  std::vector<ArtefactPlace> places;  // in the order of the run; empty: one, R_-1 itself
  Stylus stylus;
  std::vector<ArtefactTip> tips;  // beside that of the stylus, whose pre-travel they have
  double std_radius_m = 0.0;
  double std_pretravel_m = 0.0;
  double std_pretravel_tilt_m = 0.0;
  double std_lobes_m = 0.0;  // of the lobes' size, and of that of lobes turned by 30 degrees beside them
  double warmer_than_20_c_k = 0.0;  // temperature of the block minus 20 degrees C
  double std_temperature_k = 0.0;
  double thermal_expansion_per_k = 0.0;
};

enum class ArtefactKind {
  kFaceOffset,
  kFaceTilt,
  kSphereCenter,
  kSphereRadius,
  kBoreAxis,  // its place across it
  kBoreTilt,
  kBoreRadius,
  kStylusRadius,
  kPretravel,
  kTemperature,
  kPlaceShift,
  kPlaceTurn,
  kTipCenter
};

/// One of these quantities as a parameter of the identification; its value is the error of the quantity. It
/// changes the signed distance of a ball centre P from face f by value * (constant[f] + per_metre[f] . P -
/// (center[f] + turn[f] x P) . n + ball[f] . p), n the normal of face f at P and p the same in R_7. Of a face
/// alone, only a sphere or bore has a `center`, only a bore a `turn`, only a plane a `per_metre`; a place
/// moves all of its faces by `center` and `turn`, the centre of a tip those that it touches by `ball`.
struct ArtefactParameter {
  struct Shift {
    double constant = 0.0;
    Eigen::Vector3d per_metre = Eigen::Vector3d::Zero();
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  // motion of the surface at the origin, per unit
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();    // its rotation about the origin, per unit
    Eigen::Vector3d ball = Eigen::Vector3d::Zero();    // motion of the ball in R_7, per unit

    [[nodiscard]] double at(const BallContact& contact) const {
      // The cross product is the same for all parameters of a touch; (turn x P) . n is turn . (P x n).
      return constant + per_metre.dot(contact.ball_m) - center.dot(contact.normal) -
             turn.dot(contact.ball_m.cross(contact.normal)) + ball.dot(contact.push);
    }
  };

  /// "stylus_radius", "plane3_offset", "plane3_tilt_u", "plane6_center_x", "plane6_radius"; of a bore
  /// "plane6_axis_u", "plane6_tilt_u", u from the axis to the middle of the wall and v the bore's axis x u;
  /// of a place "place_stand_x", "place_stand_turn_x", along and about the axes of the problem's R_-1; of a
  /// tip "tip_left_radius", "tip_left_x", along the axes of R_7.
  std::string name;
  ArtefactKind kind = ArtefactKind::kFaceOffset;
  double nominal = 0.0;       // the given value: metres, radians or degrees C
  std::optional<double> std;  // of its error; nothing for a face that is estimated in place
  std::vector<Shift> shifts;  // one per face
  double within_m = 0.0;      // of a tip's centre: how far it may be from where it is drawn, in any direction
};

/// Whether it is of the place of a sphere or bore and has no prior: the touches have to go around.
inline bool is_free_round_place(const ArtefactParameter& parameter) {
  return (parameter.kind == ArtefactKind::kSphereCenter || parameter.kind == ArtefactKind::kBoreAxis) &&
         !parameter.std;
}

/// The faces of an artefact are about so far from the origin of its R_-1: what a place that turns moves them
/// by.
inline constexpr double kPlaceLeverMetres = 0.1;

/// Whether it is of the pose of a place.
inline bool is_of_place(const ArtefactParameter& parameter) {
  return parameter.kind == ArtefactKind::kPlaceShift || parameter.kind == ArtefactKind::kPlaceTurn;
}

/// Whether the touches alone find that place, and the face stands there.
inline bool is_free_place_of(const ArtefactParameter& parameter, std::size_t face) {
  return parameter.kind == ArtefactKind::kPlaceShift && !parameter.std &&
         !parameter.shifts[face].center.isZero(0.0);
}

/// What the certified lengths say beyond the offsets, as an equation between artefact parameters: sum of
/// weight * parameter = value. Its deviation is so much larger than the certified one that with the priors of
/// the offsets it is the certified one again: a certificate counts once.
struct ArtefactEquation {
  std::vector<std::pair<int, double>> weights;  // index of a parameter, weight
  double value_m = 0.0;
  double std_m = 0.0;
};

inline constexpr int kPlaceParameterCount = 6;

/// The six parameters of the pose of a place, shifts before turns, and the point that it turns about.
struct PlaceParameters {
  int place = 0;  // index
  int first = 0;  // index of the first of them
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
};

struct Artefact {
  /// Nominal, of the ball centre at the trigger: one per face, tip and place, in the order of the faces, for
  /// each tip, at each place. A face at another place or for another tip has the index face + face_count *
  /// (tip + tip_count * place), as its touches have.
  std::vector<ContactSurface> contact_planes;
  std::size_t face_count = 0;  // 0: there is one place and one tip
  std::size_t tip_count = 1;
  std::vector<ArtefactParameter> parameters;  // of quantities that are not exactly known
  std::vector<ArtefactEquation> equations;
  std::vector<PlaceParameters> places;  // of those whose pose is not exactly known
  /// One standard deviation of what is known of the pre-travel of a push from the side, by the shapes of
  /// sideways_shapes(). Never estimated: the touches do not show it.
  Eigen::Vector3d std_sideways_m = Eigen::Vector3d::Zero();

  /// The place and the tip of a face, by its index; from 0.
  [[nodiscard]] std::size_t place_of(std::size_t face) const {
    return face_count == 0 ? 0 : face / (face_count * tip_count);
  }
  [[nodiscard]] std::size_t tip_of(std::size_t face) const {
    return face_count == 0 ? 0 : face / face_count % tip_count;
  }
  /// Whether a touch may have been of the one or of the other: which place and which tip it was is known.
  [[nodiscard]] bool may_be_mistaken(std::size_t a, std::size_t b) const {
    return place_of(a) == place_of(b) && tip_of(a) == tip_of(b);
  }
};

/// Sets `planes` to the contact planes with these errors of the artefact parameters. Allocates no memory when
/// the capacity of `planes` suffices. The normals of planes are not normalised again: their length is 1 to
/// first order. A place is moved as a rigid body.
void correct_contact_planes(const Artefact& artefact, const Eigen::VectorXd& errors,
                            std::vector<ContactSurface>& planes);

/// The contact planes at the temperature of the block, and the parameters of everything that is not exactly
/// known, faces first. A length that is known no better than the offsets of its two faces tell it makes no
/// equation.
Artefact make_artefact(const ArtefactKnowledge& knowledge);

/// Indices of the parameters without a prior: of faces that are estimated in place.
std::vector<int> parameters_without_prior(const Artefact& artefact);

/// Standard deviation of a parameter without a prior (metres, radians): practically free.
inline constexpr double kFreeArtefactStd = 0.1;

/// Covariance of the errors of the parameters before any touch, with what the certified lengths say: the
/// offsets of two faces with a length between them are correlated. SI units.
Eigen::MatrixXd prior_covariance(const Artefact& artefact);

/// An artefact with exactly known contact planes.
Artefact exact_artefact(std::vector<ContactSurface> contact_planes);

}  // namespace calib
