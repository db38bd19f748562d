// SPDX-License-Identifier: BSD-3-Clause
#include "map/textured_octree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace photonav {
namespace {

/// Views merge the greys of faces one step apart by their weights (FacePatch). A weight that
/// doubles moves the merged grey by at most this share of their difference: w1 w2 / ((2 w1 + w2)
/// (w1 + w2)) at w2 = sqrt(2) w1.
constexpr float kMostByWeight = 0.1716F;

/// OctoMap's factory keeps one empty tree of every type it can read.
void registerWithOctomap() {
    struct Registration : TexturedOcTree {
        Registration() : TexturedOcTree(0.1) {
            clearKeyRays();
            AbstractOcTree::registerTreeType(this);
        }
    };
    static Registration registration;
}

[[maybe_unused]] const bool kRegistered = (registerWithOctomap(), true);

template <class T>
void readRaw(std::istream& stream, T& value) {
    stream.read(reinterpret_cast<char*>(&value), sizeof(value));
}

template <class T>
void writeRaw(std::ostream& stream, const T& value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Eight at a time, in one vector.
std::array<std::uint16_t, 8> quantised(const std::array<float, 8>& grey) {
    std::array<std::uint16_t, 8> units;
    for (unsigned i = 0; i < 8; ++i) {
        const float inRange = std::min(std::max(grey[i], 0.F), 1.F);
        units[i] = static_cast<std::uint16_t>(static_cast<int>(std::nearbyint(inRange * 65535.F)));
    }
    return units;
}

/// The largest difference between two sets of shown greys.
float difference(const std::optional<ShownGreys>& before, const std::optional<ShownGreys>& after) {
    if (!before || !after) return before.has_value() == after.has_value() ? 0.F : 1.F;
    int largest = 0;
    for (unsigned f = 0; f < 6; ++f)
        largest = std::max(largest, std::abs((*before)[f] - (*after)[f]));
    return static_cast<float>(largest) / 65535.F;
}

}  // namespace

void FaceTexture::observe(float grey, float addedWeight, float maxWeight) {
    weight += addedWeight;
    mean += (grey - mean) * (addedWeight / weight);
    weight = std::min(weight, maxWeight);
}

// The base's copy would make children of the base's type.
// NOLINTNEXTLINE(bugprone-copy-constructor-init)
TexturedOcTreeNode::TexturedOcTreeNode(const TexturedOcTreeNode& other)
    : octomap::OcTreeNode(),  // NOLINT(readability-redundant-member-init): g++ asks for it
      faces(other.faces),
      surfaces(other.surfaces) {
    value = other.value;
    if (other.children == nullptr) return;
    allocChildren();
    for (unsigned i = 0; i < 8; ++i) {
        if (const auto* child = static_cast<const TexturedOcTreeNode*>(other.children[i])) {
            children[i] = new TexturedOcTreeNode(*child);
        }
    }
}

void TexturedOcTreeNode::releaseChildren() {
    delete[] children;
    children = nullptr;
}

std::optional<float> TexturedOcTreeNode::meanGrey() const {
    double sum = 0., weight = 0.;
    for (const FaceTexture& face : faces) {
        sum += static_cast<double>(face.weight) * face.mean;
        weight += face.weight;
    }
    return weight > 0. ? std::optional(static_cast<float>(sum / weight)) : std::nullopt;
}

std::optional<ShownGreys> TexturedOcTreeNode::shownGreys() const {
    const std::optional<float> mean = meanGrey();
    if (!mean) return std::nullopt;
    std::array<float, 8> greys{};
    for (unsigned f = 0; f < 6; ++f) greys[f] = faces[f].observed() ? faces[f].mean : *mean;
    const auto units = quantised(greys);
    ShownGreys shown;
    std::copy_n(units.begin(), shown.size(), shown.begin());
    return shown;
}

ShownWeights TexturedOcTreeNode::shownWeights() const {
    ShownWeights weights{};
    for (unsigned f = 0; f < 6; ++f) {
        if (!faces[f].observed()) continue;
        weights[f] = static_cast<std::uint8_t>(std::clamp(1 + std::ilogb(faces[f].weight), 1, 15));
    }
    return weights;
}

void TexturedOcTreeNode::copyData(const TexturedOcTreeNode& from) {
    octomap::OcTreeNode::copyData(from);
    faces = from.faces;
    surfaces = from.surfaces;
}

bool TexturedOcTreeNode::operator==(const TexturedOcTreeNode& other) const {
    return value == other.value && faces == other.faces && surfaces == other.surfaces;
}

// Occupancy, a byte that says which faces were observed, and those faces' mean and weight: most
// nodes are free space and take five bytes. If the byte's bit kHasSurfaces is set, another one says
// which faces have surfaces, and these follow.
std::istream& TexturedOcTreeNode::readData(std::istream& stream) {
    std::uint8_t observed = 0;
    readRaw(stream, value);
    readRaw(stream, observed);
    for (unsigned f = 0; f < 6; ++f) {
        if ((observed >> f & 1U) == 0) continue;
        readRaw(stream, faces[f].mean);
        readRaw(stream, faces[f].weight);
    }
    if ((observed & kHasSurfaces) == 0) return stream;
    std::uint8_t inside = 0;
    readRaw(stream, inside);
    for (unsigned f = 0; f < 6; ++f) {
        if ((inside >> f & 1U) != 0) readRaw(stream, surfaces.obtain(f));
    }
    surfaces.refreshShown();
    return stream;
}

std::ostream& TexturedOcTreeNode::writeData(std::ostream& stream) const {
    unsigned observed = 0;
    for (unsigned f = 0; f < 6; ++f) observed |= static_cast<unsigned>(faces[f].observed()) << f;
    unsigned inside = 0;
    for (unsigned f = 0; f < 6; ++f) inside |= static_cast<unsigned>(surfaces[f].observed()) << f;
    if (inside != 0) observed |= kHasSurfaces;
    writeRaw(stream, value);
    writeRaw(stream, static_cast<std::uint8_t>(observed));
    for (const FaceTexture& face : faces) {
        if (!face.observed()) continue;
        writeRaw(stream, face.mean);
        writeRaw(stream, face.weight);
    }
    if (inside != 0) writeRaw(stream, static_cast<std::uint8_t>(inside));
    for (unsigned f = 0; f < 6; ++f) {
        if (surfaces[f].observed()) writeRaw(stream, surfaces[f]);
    }
    return stream;
}

TexturedOcTree::TexturedOcTree(double cellSize)
    : octomap::OccupancyOcTreeBase<TexturedOcTreeNode>(cellSize) {
    if (!(cellSize > 0.)) throw std::invalid_argument("TexturedOcTree: resolution not positive");
    // A single outlier makes a cell a hit, while a ray through a cell is stronger evidence.
    // OctoMap's defaults, 0.7 and 0.4, would thicken walls mapped by a depth camera.
    setProbHit(0.55);
    setProbMiss(0.2);
}

void TexturedOcTree::expandNode(TexturedOcTreeNode* node) {
    OccupancyOcTreeBase::expandNode(node);
    node->faces = {};
    node->surfaces.clear();
}

TexturedOcTreeNode& TexturedOcTree::obtainRoot() {
    if (root == nullptr) {
        root = new TexturedOcTreeNode;
        ++tree_size;
        size_changed = true;
    }
    return *root;
}

struct TexturedOcTree::Update {
    const TextureCell& texture;
    const KeepCell& keep;
};

/// A brick and the way to it from the root.
struct TexturedOcTree::PlacedBrick {
    std::uint64_t way;  // three bits for a child, those of the brick's cells lowest
    BrickObservation* brick;

    explicit PlacedBrick(BrickObservation& observation)
        : way(spread(observation.corner[0]) | spread(observation.corner[1]) << 1U |
              spread(observation.corner[2]) << 2U),
          brick(&observation) {}

    /// Moves bit i to bit 3 i.
    static std::uint64_t spread(octomap::key_type key) {
        std::uint64_t bits = key;
        bits = (bits | bits << 16U) & 0xFF0000FFU;
        bits = (bits | bits << 8U) & 0xF00F00F00FU;
        bits = (bits | bits << 4U) & 0xC30C30C30C3U;
        return (bits | bits << 2U) & 0x249249249249U;
    }
    unsigned childOf(unsigned level) const { return way >> 3 * (level - 1) & 7U; }
};

void TexturedOcTree::updateBricks(std::span<BrickObservation> bricks, const TextureCell& texture,
                                  const KeepCell& keep) {
    std::vector<PlacedBrick> placed;
    placed.reserve(bricks.size());
    for (BrickObservation& brick : bricks) {
        if ((brick.missed | brick.hit) != 0) placed.emplace_back(brick);
    }
    if (placed.empty()) return;
    std::sort(placed.begin(), placed.end(),
              [](const auto& a, const auto& b) { return a.way < b.way; });
    const bool empty = root == nullptr;
    updateNodes(obtainRoot(), empty, tree_depth, placed, {texture, keep});
}

/// Updates a node `level` levels above the cells.
void TexturedOcTree::updateNodes(TexturedOcTreeNode& node, bool justMade, unsigned level,
                                 std::span<const PlacedBrick> bricks, const Update& update) {
    if (level == 2) return updateBrick(node, justMade, level, 0, *bricks.front().brick, update);
    const bool pruned = !justMade && !nodeHasChildren(&node);
    const auto isHit = [](const PlacedBrick& placed) { return placed.brick->hit != 0; };
    if (pruned && node.getLogOdds() <= clamping_thres_min && std::ranges::none_of(bricks, isHit)) {
        return;
    }
    if (pruned) expandNode(&node);
    while (!bricks.empty()) {
        const unsigned i = bricks.front().childOf(level);
        std::size_t count = 1;
        while (count < bricks.size() && bricks[count].childOf(level) == i) ++count;
        const bool make = !nodeChildExists(&node, i);
        TexturedOcTreeNode* child = make ? createNodeChild(&node, i) : getNodeChild(&node, i);
        updateNodes(*child, make, level - 1, bricks.first(count), update);
        bricks = bricks.subspan(count);
    }
    if (!pruneNode(&node)) node.updateOccupancyChildren();
}

/// The same within a brick. @param firstBit of the node's cells
void TexturedOcTree::updateBrick(TexturedOcTreeNode& node, bool justMade, unsigned level,
                                 unsigned firstBit, BrickObservation& brick, const Update& update) {
    if (level == 0) return updateCell(node, justMade, firstBit, brick, update);
    const std::uint64_t cells = level == 2 ? ~0ULL : 0xFFULL << firstBit;
    const bool pruned = !justMade && !nodeHasChildren(&node);
    if (pruned && node.getLogOdds() <= clamping_thres_min && (brick.hit & cells) == 0) return;
    if (pruned) expandNode(&node);
    prefetchChildren(node);
    for (unsigned i = 0; i < 8; ++i) {
        const unsigned first = level == 2 ? 8 * i : firstBit + i;
        const std::uint64_t ofChild = (level == 2 ? 0xFFULL : 1ULL) << first;
        if (((brick.missed | brick.hit) & ofChild) == 0) continue;
        const bool make = !nodeChildExists(&node, i);
        TexturedOcTreeNode* child = make ? createNodeChild(&node, i) : getNodeChild(&node, i);
        updateBrick(*child, make, level - 1, first, brick, update);
    }
    if (!pruneNode(&node)) node.updateOccupancyChildren();
}

void TexturedOcTree::updateCell(TexturedOcTreeNode& node, bool justMade, unsigned bit,
                                BrickObservation& brick, const Update& update) {
    const bool hit = (brick.hit >> bit & 1U) != 0;
    const bool wasOccupied = !justMade && isNodeOccupied(node);
    const bool hasSurface = wasOccupied && !node.surfaces.empty();
    if (!hit && hasSurface && update.keep && update.keep(node, brick, bit)) return;
    std::optional<ShownGreys> greys;
    ShownWeights weights{};
    ShownSurfaces surfaces;
    if (hit && wasOccupied) {
        greys = node.shownGreys();
        weights = node.shownWeights();
        surfaces = node.surfaces.shown();
    }
    updateNodeLogOdds(&node, hit ? prob_hit_log : prob_miss_log);
    const bool isOccupied = isNodeOccupied(node);
    if (hit) update.texture(node, brick, bit);
    if (!isOccupied) node.surfaces.clear();
    BrickChange& change = brick.change;
    if (justMade || isOccupied != wasOccupied) {
        change.occupancy = true;
    } else if (hit && wasOccupied) {
        const float painted = difference(greys, node.shownGreys());
        const float moved = surfaceMotion(surfaces, node.surfaces.shown());
        const float weighed = weights != node.shownWeights() ? kMostByWeight : 0.F;
        change.texture = change.texture || painted > 0.F || moved > 0.F || weighed > 0.F;
        change.greyChange = std::max({change.greyChange, painted, weighed});
        change.surfaceMotion = std::max(change.surfaceMotion, moved);
    }
}

void TexturedOcTree::makeUnknown(const octomap::OcTreeKey& cell) {
    if (search(cell) == nullptr) return;
    if (makeUnknownBelow(*root, tree_depth - 1, cell)) clear();
}

/// @param level of the children @returns whether none of them is left
bool TexturedOcTree::makeUnknownBelow(TexturedOcTreeNode& node, unsigned level,
                                      const octomap::OcTreeKey& cell) {
    if (!nodeHasChildren(&node)) expandNode(&node);
    const auto child = octomap::computeChildIdx(cell, static_cast<int>(level));
    if (level == 0 || makeUnknownBelow(*getNodeChild(&node, child), level - 1, cell)) {
        deleteNodeChild(&node, child);
    }
    if (nodeHasChildren(&node)) {
        node.updateOccupancyChildren();
        return false;
    }
    node.releaseChildren();
    return true;
}

bool TexturedOcTree::hasSurfaces() const {
    for (auto leaf = begin_leafs(); leaf != end_leafs(); ++leaf) {
        if (!leaf->surfaces.empty()) return true;
    }
    return false;
}

bool TexturedOcTree::accumulateDrift(const octomap::OcTreeKey& corner, float change) {
    float& drift = drift_[corner];
    drift += change;
    if (!(drift > 1.F)) return false;
    drift = 0.F;
    return true;
}

}  // namespace photonav
