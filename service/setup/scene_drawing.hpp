#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell.hpp"

namespace cell {

/// What the three views are called: along z, from above, along x.
using SceneTitles = std::array<std::string_view, 3>;
inline constexpr SceneTitles kSceneTitles{"seen along z", "seen from above", "seen along x"};

/// The scene in three views (along z, from above, from the arm's side) with the arm in its park posture:
/// bodies of arm and probe, the block with the faces that are touched, boxes that are kept out of, the
/// workspace box. One SVG document; millimetres.
std::string scene_svg(const Cell& scene, const SceneTitles& titles = kSceneTitles);

/// The same in a page that a browser shows anew each second, with the remarks below it.
std::string scene_html(const Cell& scene, const std::vector<std::string>& remarks);

}  // namespace cell
