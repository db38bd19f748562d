// SPDX-License-Identifier: BSD-3-Clause
// Map files in OctoMap's formats .ot and .bt, which are checked completely when they are read.
#pragma once

#include <memory>
#include <string>

#include "map/textured_octree.hpp"

namespace photonav {

/// Whether a file name ends in .ot or .bt.
bool isOcTreeFile(const std::string& file);

/// Reads a map. Besides our own .ot (class TexturedOcTree), it reads files of other OctoMap
/// programs: .ot of class ColorOcTree (all six faces of an occupied cell take the luma of its
/// colour, with weight 1), .ot of class OcTree and .bt of both (occupancy only: such a map can be
/// used for obstacle avoidance, but its views have no information).
/// @throws InputError when the file is missing, is none of these, is cut short or damaged (its node
///         count is compared with its header, nothing may follow), or holds values that are not
///         finite
std::unique_ptr<TexturedOcTree> loadTexturedOcTree(const std::string& file);

// An existing file is replaced only after the new one has been written completely.
// @throws InputError when the file cannot be written

/// Writes the complete map, with the surfaces inside cells, for loadTexturedOcTree() and
/// octomap::AbstractOcTree::read(). The file has version 2 of our format (a comment in the header).
/// Files without a version can be read as well; their surfaces are at the faces of the cells.
void saveTexturedOcTree(const TexturedOcTree& map, const std::string& file);

/// Writes a map for octovis and other programs: an .ot of class ColorOcTree with the grey values of
/// TexturedOcTreeNode::meanGrey(). White becomes 254, because 255 means "no colour set" in OctoMap.
void saveColorOcTree(const TexturedOcTree& map, const std::string& file);

/// Writes the occupancy only (free or occupied): a .bt of class OcTree.
void saveBinaryOcTree(const TexturedOcTree& map, const std::string& file);

}  // namespace photonav
