#include "service/documents/block_pose_file.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/shapes.hpp"
#include "config/strict_json.hpp"
#include "service/base/digest.hpp"
#include "service/base/durable_file.hpp"

namespace cell {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kTouchesMin = 6;
constexpr std::size_t kTouchesMax = 100;

template <class Vector>
Json list_of(const Vector& values, double scale = 1.0) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) list.push_back(scale * values[i]);
  return list;
}

Eigen::Vector3d turn_of(const Eigen::Isometry3d& pose) {
  const Eigen::AngleAxisd turn(pose.linear());
  return turn.angle() * turn.axis();
}

Eigen::Isometry3d pose_of(const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0.0) pose.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  pose.translation() = shift_m;
  return pose;
}

/// Of the document without its checksum, keys sorted.
std::string checksum_of(const std::string& text) { return sha256_hex(nlohmann::json::parse(text).dump()); }

}  // namespace

std::string block_pose_document(const BlockPose& place) {
  const Eigen::Matrix<double, 6, 1> std = place.covariance.diagonal().cwiseSqrt();
  Json document{{"schema", kBlockPoseSchema},
                {"located_at", place.located_at},
                {"digest", place.digest},
                {"shift_mm", list_of(place.cell_from_block.translation(), 1e3)},
                {"turn_rad", list_of(turn_of(place.cell_from_block))},
                {"std_shift_mm", list_of(std.head<3>(), 1e3)},
                {"std_turn_rad", list_of(std.tail<3>())}};
  Json& covariance = document["covariance_si"] = Json::array();
  for (int row = 0; row < 6; ++row) covariance.push_back(list_of(place.covariance.row(row)));
  Json& errors = document["std_errors_si"] = Json::object();
  for (std::size_t i = 0; i < place.std_block_pose.size(); ++i)
    if (place.std_block_pose[i]) errors[calib::error_parameters()[i].name()] = *place.std_block_pose[i];
  Json& touches = document["touches"] = Json::array();
  for (const calib::RegistrationTouch& touch : place.touches)
    touches.push_back({{"plane", touch.face + 1},
                       {"joints_deg", list_of(touch.joints, 1.0 / calib::kRadiansPerDegree)},
                       {"std_mm", calib::mm_from_metres(touch.std_m)}});
  document[std::string(kBlockPoseChecksum)] = checksum_of(document.dump());
  return document.dump();
}

void write_block_pose(const std::filesystem::path& file, const BlockPose& place) {
  replace_file(file, block_pose_document(place) + '\n');
}

std::optional<BlockPose> read_block_pose(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::string source = file.string();
  const nlohmann::json json = read_json_file(file);
  const JsonObject document =
      JsonValue(source, json)
          .document(kBlockPoseSchema,
                    {"schema", "located_at", "digest", "shift_mm", "turn_rad", "std_shift_mm", "std_turn_rad",
                     "covariance_si", "std_errors_si", "touches", kBlockPoseChecksum});
  nlohmann::json summed = json;
  summed.erase(std::string(kBlockPoseChecksum));
  if (document.at(kBlockPoseChecksum).text() != sha256_hex(summed.dump()))
    document.at(kBlockPoseChecksum)
        .fail(
            "does not match: the file was changed after the block was located; remove the file, then "
            "touchcal "
            "locate finds the block");
  BlockPose place{.located_at = document.at("located_at").text(), .digest = document.at("digest").text()};
  place.cell_from_block =
      pose_of(document.at("shift_mm").numbers<3>() * 1e-3, document.at("turn_rad").numbers<3>());
  const auto rows = document.at("covariance_si").items(6, 6);
  for (int row = 0; row < 6; ++row)
    place.covariance.row(row) = rows[static_cast<std::size_t>(row)].numbers<6>().transpose();
  for (const auto& [name, value] : document.at("std_errors_si").members()) {
    const auto index = calib::error_parameter_index(name);
    if (!index) value.fail("is not the name of an arm error");
    place.std_block_pose[static_cast<std::size_t>(*index)] = value.number(kNotNegative);
  }
  for (const JsonValue& value : document.at("touches").items(kTouchesMin, kTouchesMax)) {
    const JsonObject touch = value.object({"plane", "joints_deg", "std_mm"});
    place.touches.push_back({touch.at("plane").integer(1, 1000) - 1,
                             touch.at("joints_deg").numbers<6>() * calib::kRadiansPerDegree,
                             touch.at("std_mm").number(kPositive) * 1e-3});
  }
  return place;
}

}  // namespace cell
