// SPDX-License-Identifier: BSD-3-Clause
// Map files: OctoMap's .ot and .bt, checked to the last byte.
#pragma once

#include <memory>
#include <string>

#include "map/textured_octree.hpp"

namespace photonav {

/// Whether a file name ends in .ot or .bt.
bool isOcTreeFile(const std::string& file);

/// Reads a map. Besides our own .ot (class TexturedOcTree) it takes what other OctoMap programs
/// write: .ot of class ColorOcTree (all six faces of an occupied cell take the luma of its colour,
/// with weight 1) and .ot or .bt of class OcTree (occupancy only: no face was ever observed, so one
/// can plan around obstacles, but views carry no information).
/// @throws InputError when the file is missing, is none of these, is cut short or damaged (its node
///         count is compared with its header, nothing may follow), or holds values that are not
///         finite
std::unique_ptr<TexturedOcTree> loadTexturedOcTree(const std::string& file);

// Writing replaces the file only when all of it has been written.
// @throws InputError when the file cannot be written

/// Writes the complete map, for loadTexturedOcTree() and octomap::AbstractOcTree::read(): version 2
/// of our format (a comment in the header), with the surfaces inside cells. Files without a version
/// are read as well; their surfaces are at the faces of the cells.
void saveTexturedOcTree(const TexturedOcTree& map, const std::string& file);

/// Writes a map for octovis and other programs: an .ot of class ColorOcTree, grey by
/// TexturedOcTreeNode::meanGrey(). White becomes 254, since OctoMap takes 255 for "no colour set".
void saveColorOcTree(const TexturedOcTree& map, const std::string& file);

/// Writes only which cells are free or occupied: a .bt of class OcTree.
void saveBinaryOcTree(const TexturedOcTree& map, const std::string& file);

}  // namespace photonav
