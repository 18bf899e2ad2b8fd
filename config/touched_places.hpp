#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"

/// The places at which the block stands in a run of a recipe: the first, where it was located, then those of
/// the recipe. Of a block with n faces the touches' face f at place p, both from 0, has the index p * n + f
/// everywhere; files and documents number these planes through from 1.
namespace cell {

int place_count(const Recipe& recipe);

/// How R_-1 at a further place moves in that of the first one when block and stand get warmer.
Eigen::Vector3d place_growth_m_per_k(const Block& block, const BlockPlace& place);

/// By the index of the face; and which of the block's own faces it is.
int place_of_face(const Block& block, int face);
const calib::Face& face_of_block(const Block& block, int face);

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

/// The faces of all places, each in R_-1 of its own, with the numbers of the recipe's touches.
std::vector<calib::Face> faces_of_places(const Block& block, const Recipe& recipe);

/// The faces that the recipe touches, at the first place and at another one: of those that move there with
/// the block.
std::vector<int> faces_at_place(const Block& block, const Recipe& recipe, int place);

/// The same at all places, in their order.
std::vector<int> touched_faces(const Block& block, const Recipe& recipe);

/// The faces (indices) on the solid on which the first face lies: what is lifted with it. All of them where
/// that lies on none.
std::vector<int> faces_of_first_solid(const Block& block);

/// The solid on which the first face lies; null where there is none.
const calib::Box* first_solid(const Block& block);

/// artefact_knowledge() with all places, in R_-1 of the place `in`.
calib::ArtefactKnowledge artefact_knowledge(const Cell& cell, const Recipe& recipe, int in = 0);

}  // namespace cell
