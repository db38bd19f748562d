// SPDX-License-Identifier: BSD-3-Clause
// The map: an OctoMap whose leaves store the grey values of their six faces and the surfaces
// inside.
#pragma once

#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>

#include "map/cell_surfaces.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Smallest and largest edge of a map's cells [m]. With OctoMap's 16 levels, the smallest edge
/// gives a map of 6.5 m.
inline constexpr double kFinestCell = 1e-4, kCoarsestCell = 100.;

inline constexpr int kKeyOfZero = 32768;  ///< OctoMap's key of the cell that begins at the origin

/// How unknown cells (cells that no ray has visited) are treated.
enum class UnknownPolicy { free, occupied };

/// Grey value of one face of a cell. Faces are in the order -x, +x, -y, +y, -z, +z of the outward
/// normal, world frame.
struct FaceTexture {
    float mean = 0.F;    ///< mean grey value in [0, 1]
    float weight = 0.F;  ///< sum of observation weights; 0: never observed

    bool observed() const { return weight > 0.F; }
    /// Adds an observation to the weighted running mean. Observing a grey value equal to the mean
    /// leaves the mean bit-identical.
    /// @param maxWeight upper limit of the weight: older observations then count less and less, so
    ///        that the mean follows a change of the surface
    void observe(float grey, float addedWeight,
                 float maxWeight = std::numeric_limits<float>::infinity());
    bool operator==(const FaceTexture&) const = default;
};

/// Grey values of a cell's six faces as rendered in views; 65535 is white.
using ShownGreys = std::array<std::uint16_t, 6>;

/// Weights of a cell's six grey values when views merge them with those of cells in front and
/// behind: 0 if the face was never observed, else 1 + log2 of its weight, rounded down and limited
/// to [1, 15].
using ShownWeights = std::array<std::uint8_t, 6>;

/// A node with log-odds occupancy, six faces and, in occupied cells, the surfaces inside. Inner
/// nodes have occupancy only.
class TexturedOcTreeNode : public octomap::OcTreeNode {
  public:
    std::array<FaceTexture, 6> faces;
    CellSurfaces surfaces;

    TexturedOcTreeNode() = default;
    TexturedOcTreeNode(const TexturedOcTreeNode& other);  ///< deep copy, with all children
    TexturedOcTreeNode& operator=(const TexturedOcTreeNode&) = delete;

    /// Weighted mean of the observed faces; none if no face was ever observed.
    std::optional<float> meanGrey() const;

    /// The grey values that views show for an occupied cell. A face that was never observed takes
    /// meanGrey(). None if no face was ever observed.
    std::optional<ShownGreys> shownGreys() const;
    ShownWeights shownWeights() const;

    /// Frees the memory for children, all of which were deleted.
    void releaseChildren();

    // Required by OctoMap. Pruning merges leaves only if their faces and surfaces are equal as
    // well.
    void copyData(const TexturedOcTreeNode& from);
    bool operator==(const TexturedOcTreeNode& other) const;
    static constexpr std::uint8_t kHasSurfaces = 0x40;  ///< in files: see readData()
    std::istream& readData(std::istream& stream);
    std::ostream& writeData(std::ostream& stream) const;
};

/// The changes in a brick of 4 x 4 x 4 cells by one update.
struct BrickChange {
    bool occupancy = false;  ///< the state of a cell (unknown, free, occupied) changed
    /// A shown grey value, its weight, or a shown surface changed in a cell that was occupied
    /// before.
    bool texture = false;
    float greyChange = 0.F;     ///< largest change of a grey value; 1 if there was none before
    float surfaceMotion = 0.F;  ///< largest surfaceMotion() of a cell that was occupied before
};

/// One observation of the 64 cells of a brick. Bit 8 * i + j of the masks is child j of child i in
/// OctoMap's order (see brickBit).
struct BrickObservation {
    octomap::OcTreeKey corner;  ///< key of the first cell, multiples of 4
    std::uint64_t missed = 0;   ///< cells that were crossed but not hit
    std::uint64_t hit = 0;      ///< cells in which a ray ended
    BrickChange change{};       ///< filled by updateBricks()
};

/// An OctoMap of textured nodes, registered with OctoMap's factory as "TexturedOcTree" (so that
/// octomap::AbstractOcTree::read() reads its files). A cell is unknown (no node), free or occupied.
class TexturedOcTree : public octomap::OccupancyOcTreeBase<TexturedOcTreeNode> {
  public:
    /// @param resolution edge of a cell [m] @throws std::invalid_argument unless positive
    explicit TexturedOcTree(double resolution);

    TexturedOcTree* create() const override { return new TexturedOcTree(resolution); }
    std::string getTreeType() const override { return "TexturedOcTree"; }
    void expandNode(TexturedOcTreeNode* node) override;

    /// Updates the faces and surfaces of a hit cell.
    using TextureCell =
        std::function<void(TexturedOcTreeNode&, const BrickObservation&, unsigned bit)>;
    /// Whether a missed cell is left unchanged.
    using KeepCell =
        std::function<bool(const TexturedOcTreeNode&, const BrickObservation&, unsigned bit)>;

    /// Prefetches the children of a node into the cache. Nodes are scattered in memory, and cache
    /// misses would take longer than the computation.
    void prefetchChildren(const TexturedOcTreeNode& node) const {
        for (unsigned i = 0; i < 8; ++i) {
            if (!nodeChildExists(&node, i)) continue;
            const TexturedOcTreeNode* child = getNodeChild(&node, i);
            __builtin_prefetch(child);
            __builtin_prefetch(&child->surfaces);
        }
    }

    /// The root node, created if the tree is empty.
    TexturedOcTreeNode& obtainRoot();

    /// Updates many cells by one observation, with the same effect as updateNode() on each cell but
    /// much faster. A cell that becomes free loses its surfaces.
    /// @param bricks each brick at most once; BrickObservation::change is set
    /// @param texture called for every hit cell after its occupancy was raised
    /// @param keep called for every missed cell that is occupied and has surfaces, because rays may
    ///        pass through a cell in front of its surface; empty: no cell is kept
    void updateBricks(std::span<BrickObservation> bricks, const TextureCell& texture,
                      const KeepCell& keep = {});

    /// Makes a cell unknown. (OctoMap's deleteNode() fails for the last child of a node.)
    void makeUnknown(const octomap::OcTreeKey& cell);

    /// Whether any cell has surfaces inside.
    bool hasSurfaces() const;

    /// Adds up the changes of the texture of the brick at `corner`, so that many small changes are
    /// reported as well.
    /// @param change change divided by its tolerance
    /// @returns whether the sum exceeds 1; the sum is then reset to zero
    bool accumulateDrift(const octomap::OcTreeKey& corner, float change);

  private:
    struct Update;
    struct PlacedBrick;
    bool makeUnknownBelow(TexturedOcTreeNode& node, unsigned level, const octomap::OcTreeKey& cell);
    void updateNodes(TexturedOcTreeNode& node, bool justMade, unsigned level,
                     std::span<const PlacedBrick> bricks, const Update& update);
    void updateBrick(TexturedOcTreeNode& node, bool justMade, unsigned level, unsigned firstBit,
                     BrickObservation& brick, const Update& update);
    void updateCell(TexturedOcTreeNode& node, bool justMade, unsigned bit, BrickObservation& brick,
                    const Update& update);

    std::unordered_map<octomap::OcTreeKey, float, octomap::OcTreeKey::KeyHash> drift_;
};

/// Bit of a cell in the masks of its brick of 4 x 4 x 4 cells, from the two low bits of its key
/// along each axis.
constexpr unsigned brickBit(unsigned x, unsigned y, unsigned z) {
    return (x & 1U) | (y & 1U) << 1U | (z & 1U) << 2U | (x & 2U) << 2U | (y & 2U) << 3U |
           (z & 2U) << 4U;
}

}  // namespace photonav
