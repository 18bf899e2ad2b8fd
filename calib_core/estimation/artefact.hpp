#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/plane.hpp"

namespace calib {

/// How well one face is known. One standard deviation each; 0 is exactly known.
/// An estimated face has no figure to start from but its drawing: its offset and tilts are free.
struct FaceUncertainty {
  double std_offset_m = 0.0;
  double std_tilt_rad = 0.0;  // about each of the face's two edges
  bool estimated = false;
};

/// Two parallel faces that lie a certified length apart, at 20 degrees C.
struct KnownLength {
  std::array<int, 2> faces{};  // indices
  double value_m = 0.0;
  double std_m = 0.0;
};

/// All that the touches are measured against: the faces, the ball, and how well each is known. Revolute
/// joints measure no length, so these are the only rulers, and what is wrong with them the residuals do not
/// show.
struct ArtefactKnowledge {
  std::vector<Face> faces;                          // at 20 degrees C
  std::vector<FaceUncertainty> face_uncertainties;  // one a face, or empty: all exactly known
  std::vector<KnownLength> lengths;
  Stylus stylus;
  double std_radius_m = 0.0;
  double std_pretravel_m = 0.0;
  double warmer_than_20_c_k = 0.0;  // the block's temperature less 20 degrees C
  double std_temperature_k = 0.0;
  double thermal_expansion_per_k = 0.0;
};

enum class ArtefactKind { kFaceOffset, kFaceTilt, kStylusRadius, kPretravel, kTemperature };

/// One of these quantities as a parameter of the identification: what is wrong with it, beside the kinematic
/// errors. It shifts the signed distance of a ball's centre P from face f by
/// value * (constant[f] + per_metre[f] . P).
struct ArtefactParameter {
  struct Shift {
    double constant = 0.0;
    Eigen::Vector3d per_metre = Eigen::Vector3d::Zero();
  };

  std::string name;  // "stylus_radius", "plane3_offset", "plane3_tilt_u"
  ArtefactKind kind = ArtefactKind::kFaceOffset;
  double nominal = 0.0;       // as it was written down: metres, radians or degrees C
  std::optional<double> std;  // of its error; nothing for a face estimated in place
  std::vector<Shift> shifts;  // one a face
};

/// A certified length as an equation between artefact parameters: sum of weight * parameter = value.
struct ArtefactEquation {
  std::vector<std::pair<int, double>> weights;  // index of a parameter, weight
  double value_m = 0.0;
  double std_m = 0.0;
};

struct Artefact {
  std::vector<Plane> contact_planes;  // one a face: where the ball's centre is at the trigger, all as written
  std::vector<ArtefactParameter> parameters;  // those that are not exactly known
  std::vector<ArtefactEquation> equations;
};

/// The contact planes with these errors of the parameters: as they are written down but for what is wrong
/// with them. Takes no memory when `planes` has room. The normals are not brought back to unit length: to
/// first order they are.
void place_planes(const Artefact& artefact, const Eigen::VectorXd& errors, std::vector<Plane>& planes);

/// The contact planes at the block's temperature, and the parameters that are not exactly known, faces first.
Artefact describe(const ArtefactKnowledge& knowledge);

/// Faces that are exactly known, given where the ball's centre is at the trigger.
Artefact exact_artefact(std::vector<Plane> contact_planes);

}  // namespace calib
