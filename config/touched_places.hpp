#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"

/// The places at which the block stands in a run of a recipe: the first, where it was located, then those of
/// the recipe; and the tips that touch at each: the first, then those of the recipe. Of a block with n faces
/// and t tips the touches' face f at place p with tip k, all from 0, has the index (p * t + k) * n + f
/// everywhere; files and documents number these planes through from 1.
namespace cell {

int place_count(const Recipe& recipe);

/// How R_-1 at a further place moves in that of the first one when block and stand get warmer.
Eigen::Vector3d place_growth_m_per_k(const Block& block, const BlockPlace& place);

int tip_count(const Recipe& recipe);

/// Of all tips.
int faces_per_place(const Block& block, const Recipe& recipe);

/// By the index of the face; and which of the block's own faces it is.
int place_of_face(const Block& block, const Recipe& recipe, int face);
int tip_of_face(const Block& block, const Recipe& recipe, int face);
const calib::Face& face_of_block(const Block& block, int face);

/// Of a face that another tip touches than the first: the name in the probe's file.
std::optional<std::string> further_tip_name(const Cell& cell, const Recipe& recipe, int face);

/// "first", or the name in the block's file.
const std::string& place_name(const Block& block, const Recipe& recipe, int place);

/// Of a face at another place than the first.
std::optional<std::string> further_place_name(const Block& block, const Recipe& recipe, int face);

/// Whether nobody knows the place but the touches there; then it is within so much of where the file has it.
bool is_found_by_touches(const Block& block, const Recipe& recipe, int place);
double found_within_m(const Block& block, const Recipe& recipe, int place);

/// The poses of all places in R_-1 of the place `in`; empty for a recipe with the first place only. The steps
/// between them are as warm as the block.
std::vector<calib::ArtefactPlace> artefact_places(const Block& block, const Recipe& recipe, int in = 0);

/// The faces of all places and tips, each in R_-1 of its own, with the numbers of the recipe's touches.
std::vector<calib::Face> faces_of_places(const Block& block, const Recipe& recipe);

/// The faces that the recipe touches, with each tip, at the first place and at another one: of those that
/// move there with the block.
std::vector<int> faces_at_place(const Block& block, const Recipe& recipe, int place);

/// The same at all places, in their order.
std::vector<int> touched_faces(const Block& block, const Recipe& recipe);

/// The faces (indices) on the solid on which the first face lies: what is lifted with it. All of them where
/// that lies on none.
std::vector<int> faces_of_first_solid(const Block& block);

/// The solid on which the first face lies; null where there is none.
const calib::Box* first_solid(const Block& block);

/// artefact_knowledge() with all places and tips, in R_-1 of the place `in`.
calib::ArtefactKnowledge artefact_knowledge(const Cell& cell, const Recipe& recipe, int in = 0);

}  // namespace cell
