#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/endpoint.hpp"

/// What a person says of a new cell. The files of the cell are made of it (cell_files.hpp); they stay the
/// truth. Millimetres and degrees, as they are asked for; in R_-1 of the block unless said otherwise.
namespace cell {

inline constexpr std::string_view kSetupSchema = "touchcal/setup/1";

/// Where the arm's model comes from: one of the three.
struct ArmChoice {
  std::string file = "tx90";  // a shipped arm's name, or the path of an arm's file
  std::string urdf;           // a URDF file, with the links between which the six joints are
  std::string base_link;
  std::string tip_link;
  std::string dh;             // a table of Denavit-Hartenberg parameters, CSV
  std::string dh_convention;  // "standard" or "modified", of a table that does not say it
  /// Radii of the bodies of an arm of a URDF or a table, from the shoulder to the flange, as somebody
  /// measured them; nothing: guessed from its size.
  std::optional<std::vector<double>> body_radii_mm;
  bool operator==(const ArmChoice&) const = default;
};

/// The arm's base in R_-1. For an arm's file this is R_1 where joint 1 is at 0 (the world of a controller: on
/// axis 1, at the height of the shoulder); for an arm of a URDF its base link; of a table its first frame.
struct BasePlace {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();  // Rot(x) Rot(y) Rot(z)
};

/// A flat of the block that is touched.
struct TouchedSide {
  std::string side;  // one of kSideNames
  std::string name;  // as operators call it
};

/// The recipes that a new cell has, copies of the shipped ones; they touch all planes of the block.
inline constexpr std::string_view kSetupRecipes[] = {"quick", "best"};

/// The recipe that a cell has beside them whose block can stand elsewhere: `best` at all its places.
inline constexpr std::string_view kSetupPlacesRecipe = "places";

/// The sides of a cuboid by the direction of their outward normal; none below.
inline constexpr std::string_view kSideNames[] = {"-z", "-x", "-y", "+z", "+x"};

/// Where the block can stand beside its first place, R_-1 there in R_-1 of the first one; the touches find
/// it.
struct PlaceAnswers {
  std::string name;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();
  double within_mm = 20.0;  // how far from there a person may put it
};

/// A cuboid that stands on its bottom face; R_-1 is in the middle of that face, y down.
struct CuboidAnswers {
  std::string name = "block";
  std::optional<std::string> serial;
  Eigen::Vector3d size_mm{150.0, 150.0, 150.0};  // along x, y (its height) and z
  double std_mm = 0.005;                         // of each certified face and length
  std::vector<TouchedSide> sides{{"-z", "right"}, {"-x", "near"}, {"-y", "top"}, {"+z", "left"}};
  bool ground_plate = true;  // a certified plate that it stands on, touched too
  Eigen::Vector3d plate_mm{400.0, 20.0, 400.0};
  std::optional<double> temperature_c = 20.0;
  double std_temperature_k = 1.0;
  double expansion_per_k = 2.36e-5;
  std::map<std::string, std::string> certificate;  // number, laboratory, issued, valid_until, ...
  std::vector<PlaceAnswers> places;
};

/// What nobody has said follows what was said, where it could not stand beside it: a plate that is touched
/// has at least this much more than the block along x and z, one that follows has as much as the shipped one;
/// the stem has this share of the ball's radius, likewise.
inline constexpr double kPlateRoomMinMm = 110.0;
inline constexpr double kPlateRoomMm = 250.0;
inline constexpr double kStemShare = 0.6;

/// The edge of a plate that nobody has said, beside a block with this edge.
inline double fitting_plate_mm(double plate_mm, double block_mm) {
  return plate_mm < block_mm + kPlateRoomMinMm ? block_mm + kPlateRoomMm : plate_mm;
}

struct ProbeAnswers {
  std::string name = "probe";
  std::optional<std::string> serial;
  double ball_radius_mm = 3.0;
  double std_ball_radius_mm = 0.005;
  double pretravel_mm = 0.01;
  double std_pretravel_mm = 0.002;
  double overtravel_mm = 6.5;
  double speed_mm_s = 2.0;  // of the contact that counts, at which the probe was calibrated
  /// To the ball's centre, along axis 6 from the wrist centre (frame 7's r), of an arm that was made of a
  /// URDF or a table from its tip; nothing: as the arm's file has it, or as long as the parts below.
  std::optional<double> length_mm;
  double stem_length_mm = 50.0;  // from the ball's centre to the probe's body
  double stem_radius_mm = 1.5;
  double body_length_mm = 41.0;
  double body_radius_mm = 12.5;
  double holder_length_mm = 127.9;  // between the flange and the probe's body; 0: none
  double holder_radius_mm = 40.0;
};

struct BoxAnswers {
  std::string name;
  Eigen::Vector3d min_mm;
  Eigen::Vector3d max_mm;
};

/// The ball about a tool's centre with which it can touch the block itself.
struct ToolTipAnswers {
  double radius_mm = 0.0;  // 0: a point
  double std_radius_mm = 0.005;
};

struct ToolAnswers {
  std::string name;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // in R_6
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();
  std::optional<ToolTipAnswers> tip;
};

struct LimitAnswers {
  double held_out_mean_max_mm = 0.05;
  double held_out_rms_max_mm = 0.07;
  double condition_number_max = 300.0;
  double tip_box_max_mm = 5.0;
  std::map<std::string, double> tip_box_max_by_recipe_mm;
  bool from_plans = true;  // those by recipe are what the plans of the cell promise, and half of it more
};

struct SetupAnswers {
  std::string name = "cell";
  ArmChoice arm;
  std::optional<std::string> arm_serial;
  std::optional<std::string> controller_serial;
  std::optional<BasePlace> base;  // nothing: as the arm's file has it
  CuboidAnswers block;
  ProbeAnswers probe;
  BoxAnswers workspace_box{"in front of the arm", {-300.0, -500.0, -250.0}, {300.0, 0.0, 550.0}};
  std::vector<BoxAnswers> keep_out_boxes{{"table", {-400.0, 20.0, -600.0}, {600.0, 60.0, 600.0}}};
  double nominal_miss_mm = 12.0;
  double stylus_tilt_max_deg = 70.0;
  double touch_noise_mm = 0.02;
  std::optional<std::vector<double>> park_joints_deg;  // nothing: one that is clear is searched
  LimitAnswers limits;
  std::vector<ToolAnswers> tools;
  std::string default_recipe = "quick";
  Endpoint controller{"127.0.0.1", 11000};
};

/// The answers of a document of schema touchcal/setup/1; what it does not name has its default. ConfigError
/// with the pointer of the answer and the remedy; messages call the bytes `source`.
SetupAnswers read_setup_answers(const std::string& source, std::string_view text);

/// All answers as a document that read_setup_answers() takes.
std::string setup_document(const SetupAnswers& answers);

}  // namespace cell
