// SPDX-License-Identifier: BSD-3-Clause
// The map: an OctoMap whose leaves store the grey values of their six faces.
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

/// Edges of cells that a map can have [m]: from a tenth of a millimetre, of which OctoMap's 16
/// levels make 6.5 m.
inline constexpr double kFinestCell = 1e-4, kCoarsestCell = 100.;

inline constexpr int kKeyOfZero = 32768;  ///< OctoMap's key of the cell that begins at the origin

/// How cells that no ray has visited are treated. Every function that needs this takes it as an
/// argument.
enum class UnknownPolicy { free, occupied };

/// Faces in the order -x, +x, -y, +y, -z, +z of the outward normal.
struct FaceTexture {
    float mean = 0.F;    ///< grey value in [0, 1]
    float weight = 0.F;  ///< sum of observation weights; 0: never seen

    bool observed() const { return weight > 0.F; }
    /// Weighted running mean. Observing a grey value equal to the mean leaves the mean
    /// bit-identical.
    /// @param maxWeight upper limit of the weight: older observations then count less and less, so
    ///        that a changed surface is learnt anew
    void observe(float grey, float addedWeight,
                 float maxWeight = std::numeric_limits<float>::infinity());
    bool operator==(const FaceTexture&) const = default;
};

/// Grey values of a cell's six faces as rendered in views; 65535 is white.
using ShownGreys = std::array<std::uint16_t, 6>;

/// How much the six greys are worth against those of cells in front and behind: 0 where the face
/// was never observed, else 1 + log2 of its weight, rounded down.
using ShownWeights = std::array<std::uint8_t, 6>;

/// Log-odds occupancy, six faces and, in occupied cells, the surfaces inside. Inner nodes carry
/// occupancy only.
class TexturedOcTreeNode : public octomap::OcTreeNode {
  public:
    std::array<FaceTexture, 6> faces;
    CellSurfaces surfaces;

    TexturedOcTreeNode() = default;
    TexturedOcTreeNode(const TexturedOcTreeNode& other);  ///< deep copy, with all children
    TexturedOcTreeNode& operator=(const TexturedOcTreeNode&) = delete;

    /// Mean over the observed faces by weight; nothing when no face was ever observed.
    std::optional<float> meanGrey() const;

    /// The grey values that views show for an occupied cell: a face that was never observed takes
    /// meanGrey(). Nothing when no face was ever observed.
    std::optional<ShownGreys> shownGreys() const;
    ShownWeights shownWeights() const;

    // What OctoMap asks of a node type; pruning merges leaves only when their faces agree as well.
    void copyData(const TexturedOcTreeNode& from);
    bool operator==(const TexturedOcTreeNode& other) const;
    static constexpr std::uint8_t kHasSurfaces = 0x40;  ///< in files: see readData()
    std::istream& readData(std::istream& stream);
    std::ostream& writeData(std::ostream& stream) const;
};

/// What one update changed in a brick of 4 x 4 x 4 cells.
struct BrickChange {
    bool occupancy = false;  ///< a cell became known, free or occupied
    bool texture = false;    ///< a shown grey value or surface of a cell changed that was already
                             ///< occupied
    float greyChange = 0.F;  ///< largest such change; 1 if there was no grey value before
    float surfaceMotion = 0.F;  ///< largest surfaceMotion() of such a cell
};

/// One observation of the 64 cells of a brick. Bit 8 * i + j of the masks is child j of child i in
/// OctoMap's order (see brickBit).
struct BrickObservation {
    octomap::OcTreeKey corner;  ///< the first cell: multiples of four
    std::uint64_t missed = 0;   ///< cells that were crossed, and none that were hit
    std::uint64_t hit = 0;
    BrickChange change{};  ///< what updateBricks() changed
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

    using TextureCell =
        std::function<void(TexturedOcTreeNode&, const BrickObservation&, unsigned bit)>;
    using KeepCell =
        std::function<bool(const TexturedOcTreeNode&, const BrickObservation&, unsigned bit)>;

    /// Starts to load the children of a node: nodes lie anywhere in memory, and waiting for one
    /// after the other takes longer than all that is done with them.
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

    /// One observation of many cells: the same effect as updateNode() on each, for a fraction of
    /// the time. A cell that becomes free loses its surfaces.
    /// @param bricks each at most once; their changes are added
    /// @param texture called for every hit cell after its occupancy was raised
    /// @param keep asked for every missed cell that is occupied and has surfaces, whether it stays
    ///        as it is: rays may pass through a cell before its surface; may be missing
    void updateBricks(std::span<BrickObservation> bricks, const TextureCell& texture,
                      const KeepCell& keep = {});

    /// Whether a cell has surfaces inside.
    bool hasSurfaces() const;

    /// Adds up the changes of what the brick at `corner` shows, so that many small changes in one
    /// direction are reported in the end.
    /// @param change in parts of the change that is tolerated
    /// @returns whether the sum exceeds 1; the sum is then reset to zero
    bool accumulateDrift(const octomap::OcTreeKey& corner, float change);

  private:
    struct Update;
    struct PlacedBrick;
    void updateNodes(TexturedOcTreeNode& node, bool justMade, unsigned level,
                     std::span<const PlacedBrick> bricks, const Update& update);
    void updateBrick(TexturedOcTreeNode& node, bool justMade, unsigned level, unsigned firstBit,
                     BrickObservation& brick, const Update& update);
    void updateCell(TexturedOcTreeNode& node, bool justMade, unsigned bit, BrickObservation& brick,
                    const Update& update);

    std::unordered_map<octomap::OcTreeKey, float, octomap::OcTreeKey::KeyHash> drift_;
};

/// Bit of a cell in its brick of 4 x 4 x 4, from the two low bits of its key.
constexpr unsigned brickBit(unsigned x, unsigned y, unsigned z) {
    return (x & 1U) | (y & 1U) << 1U | (z & 1U) << 2U | (x & 2U) << 2U | (y & 2U) << 3U |
           (z & 2U) << 4U;
}

}  // namespace photonav
