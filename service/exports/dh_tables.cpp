#include "service/exports/dh_tables.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;

struct Convention {
  std::string_view name;
  std::string_view transform;
  bool x_of_next_frame;  // alpha, a and beta of row j are those of frame j+1
};

constexpr std::array kConventions{
    Convention{"modified", "Rot(y,beta) Rot(x,alpha) Trans(x,a) Rot(z,theta) Trans(z,d)", false},
    Convention{"standard", "Rot(z,theta) Trans(z,d) Rot(y,beta) Rot(x,alpha) Trans(x,a)", true}};

constexpr std::string_view kJointRule =
    "at a joint gain * position is added to theta (revolute) or d (prismatic)";

struct Row {
  std::string_view convention;
  int number = 0;
  std::string_view joint;  // revolute, prismatic or fixed
  double theta_deg = 0.0, d_mm = 0.0, a_mm = 0.0, alpha_deg = 0.0, beta_deg = 0.0;
  std::optional<double> gain;  // of a joint
};

Row make_row(const calib::KinematicModel& model, const Convention& convention, int number) {
  const auto link = [&model](int frame) {
    return frame < kFrameCount ? model.links[static_cast<std::size_t>(frame)] : calib::LinkParameters{};
  };
  const calib::LinkParameters z = link(number), x = link(convention.x_of_next_frame ? number + 1 : number);
  Row row{.convention = convention.name,
          .number = number,
          .joint = "fixed",
          .theta_deg = calib::degrees_from_radians(z.theta_rad),
          .d_mm = calib::mm_from_metres(z.r_m),
          .a_mm = calib::mm_from_metres(x.d_m),
          .alpha_deg = calib::degrees_from_radians(x.alpha_rad),
          .beta_deg = calib::degrees_from_radians(x.beta_rad)};
  if (number >= 1 && number <= kJointCount) {
    const auto joint = static_cast<std::size_t>(number - 1);
    row.joint = model.joint_types[joint] == calib::JointType::kRevolute ? "revolute" : "prismatic";
    row.gain = model.gains[joint];
  }
  return row;
}

std::vector<Row> rows_of(const calib::KinematicModel& model) {
  std::vector<Row> rows;
  for (const Convention& convention : kConventions)
    for (int number = 0; number < kFrameCount; ++number) rows.push_back(make_row(model, convention, number));
  return rows;
}

}  // namespace

std::string dh_csv(const Arm& arm, const std::string& origin) {
  std::string text = fmt::format("# {}: {}\n", arm.name, origin);
  for (const Convention& convention : kConventions)
    text += fmt::format("# {}: row j is {}\n", convention.name, convention.transform);
  text += fmt::format("# {}; from the block's frame to the centre of the stylus ball\n", kJointRule);
  text += "# compliance, harmonics and ripple have no column; offsets of the joints' zeros are in theta\n";
  text += "convention,row,joint,theta_deg,d_mm,a_mm,alpha_deg,beta_deg,gain\n";
  for (const Row& row : rows_of(arm.model)) {
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.convention, row.number, row.joint, row.theta_deg,
                        row.d_mm, row.a_mm, row.alpha_deg, row.beta_deg,
                        row.gain ? fmt::format("{}", *row.gain) : "");
  }
  return text;
}

std::string dh_json(const Arm& arm, const std::string& origin) {
  using Json = nlohmann::ordered_json;
  Json document{
      {"schema", "touchcal/dh/1"}, {"arm", arm.name}, {"origin", origin}, {"joint_rule", kJointRule}};
  for (const Convention& convention : kConventions)
    document["transforms"][std::string(convention.name)] = convention.transform;
  document["rows"] = Json::array();
  for (const Row& row : rows_of(arm.model)) {
    document["rows"].push_back({{"convention", row.convention},
                                {"row", row.number},
                                {"joint", row.joint},
                                {"theta_deg", row.theta_deg},
                                {"d_mm", row.d_mm},
                                {"a_mm", row.a_mm},
                                {"alpha_deg", row.alpha_deg},
                                {"beta_deg", row.beta_deg},
                                {"gain", row.gain ? Json(*row.gain) : Json(nullptr)}});
  }
  return document.dump(2) + "\n";
}

}  // namespace cell
