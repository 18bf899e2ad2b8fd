#include "service/acquisition/commanded_touch.hpp"

#include <nlohmann/json.hpp>

namespace cell {

namespace {

using Json = nlohmann::json;

template <class Vector>
Json array_of(const Vector& vector) {
  return Json(std::vector<double>(vector.begin(), vector.end()));
}

template <class Vector>
void read_array(const Json& json, Vector& vector) {
  const auto values = json.get<std::vector<double>>();
  if (static_cast<Eigen::Index>(values.size()) != vector.size())
    throw std::invalid_argument("another length");
  std::copy(values.begin(), values.end(), vector.begin());
}

}  // namespace

std::string command_text(const calib::PlannedTouch& touch, const std::vector<calib::JointVector>& path) {
  Json way_rad = Json::array();
  for (const calib::JointVector& joints : path) way_rad.push_back(array_of(joints));
  return Json{{"face", touch.face},
              {"role", static_cast<int>(touch.role)},
              {"joints_rad", array_of(touch.joints)},
              {"clear_joints_rad", array_of(touch.clear_joints)},
              {"approach_joints_rad", array_of(touch.approach_joints)},
              {"search_end_joints_rad", array_of(touch.search_end_joints)},
              {"predicted_miss_m", touch.predicted_position_error_m},
              {"way_rad", way_rad}}
      .dump();
}

std::optional<CommandedTouch> command_from_text(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    calib::PlannedTouch touch{.face = json.at("face"),
                              .role = static_cast<calib::TouchRole>(json.at("role").get<int>()),
                              .predicted_position_error_m = json.at("predicted_miss_m")};
    read_array(json.at("joints_rad"), touch.joints);
    read_array(json.at("clear_joints_rad"), touch.clear_joints);
    read_array(json.at("approach_joints_rad"), touch.approach_joints);
    read_array(json.at("search_end_joints_rad"), touch.search_end_joints);
    CommandedTouch command{std::move(touch), {}};
    for (const Json& joints : json.at("way_rad")) read_array(joints, command.path.emplace_back());
    return command;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace cell
