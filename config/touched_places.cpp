#include "config/touched_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace cell {
namespace {

constexpr double kOnFirstSolidMetres = 1e-3;
constexpr double kBlockFileCelsius = 20.0;

const BlockPlace& further_place(const Block& block, const Recipe& recipe, int place) {
  return block.places.at(static_cast<std::size_t>(recipe.places.at(static_cast<std::size_t>(place) - 1)));
}

bool is_on(const calib::Box& solid, const Eigen::Vector3d& point_m) {
  const Eigen::Array3d below = point_m - solid.min_m, above = solid.max_m - point_m;
  const double inside_m = std::min(below.minCoeff(), above.minCoeff());
  return std::abs(inside_m) < kOnFirstSolidMetres;
}

/// A place in R_-1 of the first one, as warm as the block.
struct WarmPlace {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d growth_m_per_k = Eigen::Vector3d::Zero();
};

WarmPlace warm_place(const Block& block, const Recipe& recipe, int place) {
  WarmPlace warm;
  if (place == 0) return warm;
  const BlockPlace& there = further_place(block, recipe, place);
  const double warmer_k = block.temperature_c.value_or(kBlockFileCelsius) - kBlockFileCelsius;
  warm.pose = there.first_from_place;
  warm.growth_m_per_k = place_growth_m_per_k(block, there);
  warm.pose.translation() += warmer_k * warm.growth_m_per_k;
  return warm;
}

}  // namespace

int place_count(const Recipe& recipe) { return 1 + static_cast<int>(recipe.places.size()); }

Eigen::Vector3d place_growth_m_per_k(const Block& block, const BlockPlace& place) {
  const double expansion =
      place.thermal_expansion_per_k.value_or(block.thermal_expansion_per_k.value_or(0.0));
  return expansion * place.first_from_place.translation();
}

int tip_count(const Recipe& recipe) { return 1 + static_cast<int>(recipe.tips.size()); }

int faces_per_place(const Block& block, const Recipe& recipe) {
  return tip_count(recipe) * static_cast<int>(block.faces.size());
}

int place_of_face(const Block& block, const Recipe& recipe, int face) {
  return face / faces_per_place(block, recipe);
}

int tip_of_face(const Block& block, const Recipe& recipe, int face) {
  return face / static_cast<int>(block.faces.size()) % tip_count(recipe);
}

std::optional<std::string> further_tip_name(const Cell& cell, const Recipe& recipe, int face) {
  const int tip = tip_of_face(cell.block, recipe, face);
  if (tip == 0) return std::nullopt;
  return cell.probe.tips.at(static_cast<std::size_t>(recipe.tips[static_cast<std::size_t>(tip) - 1])).name;
}

const calib::Face& face_of_block(const Block& block, int face) {
  return block.faces[static_cast<std::size_t>(face) % block.faces.size()];
}

const std::string& place_name(const Block& block, const Recipe& recipe, int place) {
  static const std::string first = kFirstPlace;
  return place == 0 ? first : further_place(block, recipe, place).name;
}

std::optional<std::string> further_place_name(const Block& block, const Recipe& recipe, int face) {
  const int place = place_of_face(block, recipe, face);
  return place == 0 ? std::nullopt : std::optional(place_name(block, recipe, place));
}

bool is_found_by_touches(const Block& block, const Recipe& recipe, int place) {
  return place > 0 && !further_place(block, recipe, place).std;
}

double found_within_m(const Block& block, const Recipe& recipe, int place) {
  return place == 0 ? 0.0 : further_place(block, recipe, place).within_m;
}

std::vector<calib::ArtefactPlace> artefact_places(const Block& block, const Recipe& recipe, int in) {
  if (recipe.places.empty()) return {};
  const WarmPlace here = warm_place(block, recipe, in);
  const Eigen::Isometry3d here_from_first = here.pose.inverse();
  std::vector<calib::ArtefactPlace> places;
  for (int place = 0; place < place_count(recipe); ++place) {
    const WarmPlace there = warm_place(block, recipe, place);
    calib::ArtefactPlace made{.name = place_name(block, recipe, place)};
    if (place != in) made.pose = here_from_first * there.pose;
    if (place > 0) made.std = further_place(block, recipe, place).std;
    made.growth_m_per_k = here_from_first.linear() * (there.growth_m_per_k - here.growth_m_per_k);
    places.push_back(std::move(made));
  }
  return places;
}

std::vector<calib::Face> faces_of_places(const Block& block, const Recipe& recipe) {
  std::vector<calib::Face> faces;
  for (int each = 0; each < place_count(recipe) * tip_count(recipe); ++each)
    faces.insert(faces.end(), block.faces.begin(), block.faces.end());
  return faces;
}

std::vector<int> faces_at_place(const Block& block, const Recipe& recipe, int place) {
  const std::vector<int> moving = faces_of_first_solid(block);
  const auto count = static_cast<int>(block.faces.size());
  std::vector<int> faces;
  for (int tip = 0; tip < tip_count(recipe); ++tip) {
    for (const int face : recipe.faces) {
      if (place == 0 || std::ranges::find(moving, face) != moving.end())
        faces.push_back(face + count * (tip + tip_count(recipe) * place));
    }
  }
  return faces;
}

std::vector<int> touched_faces(const Block& block, const Recipe& recipe) {
  std::vector<int> all;
  for (int place = 0; place < place_count(recipe); ++place) {
    const std::vector<int> there = faces_at_place(block, recipe, place);
    all.insert(all.end(), there.begin(), there.end());
  }
  return all;
}

const calib::Box* first_solid(const Block& block) {
  const auto found = std::ranges::find_if(
      block.solids, [&](const calib::Box& solid) { return is_on(solid, block.faces.front().center_m); });
  return found == block.solids.end() ? nullptr : &*found;
}

std::vector<int> faces_of_first_solid(const Block& block) {
  std::vector<int> all(block.faces.size());
  std::iota(all.begin(), all.end(), 0);
  const calib::Box* solid = first_solid(block);
  if (solid)
    std::erase_if(
        all, [&](int face) { return !is_on(*solid, block.faces[static_cast<std::size_t>(face)].center_m); });
  return all;
}

calib::ArtefactKnowledge artefact_knowledge(const Cell& cell, const Recipe& recipe, int in) {
  calib::ArtefactKnowledge knowledge = artefact_knowledge(cell);
  knowledge.places = artefact_places(cell.block, recipe, in);
  for (const int index : recipe.tips) {
    const ProbeTip& tip = cell.probe.tips.at(static_cast<std::size_t>(index));
    knowledge.tips.push_back({tip.name, tip.center_m, tip.radius_m, tip.std_radius_m, tip.within_m});
  }
  return knowledge;
}

}  // namespace cell
