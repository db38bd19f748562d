// SPDX-License-Identifier: BSD-3-Clause
// The cells that the rays of one observation cross or end in, and the update of a map by them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "map/map_fusion.hpp"

namespace photonav {

/// The pixels of one observation whose rays end in the same cell: their grey values, and sums over
/// their points and normals for each face of the cell.
struct CellPixels {
    /// Sums of: weight, grey value minus firstGrey (so that constant grey values stay
    /// bit-identical), point (3), normal (3).
    using Sums [[gnu::vector_size(32)]] = float;

    double greySum = 0.;
    unsigned count = 0;
    float firstGrey = 0.F;
    bool isBetween = false;  ///< no ray ends in the cell; these are points between pixels
    std::array<Sums, 6> faces{};

    static constexpr float kLeastWeight = 0.05F;  ///< smaller weights of a pixel are not summed

    void add(float grey) {
        if (count == 0) firstGrey = grey;
        greySum += grey;
        ++count;
    }

    /// Adds a surface point to the sums of the faces that its normal points to.
    /// @param p point of the pixel relative to the cell's centre [cells]
    /// @param n unit normal of the surface, world frame
    void addSurface(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float grey) {
        const Sums pixel{1.F, grey - firstGrey, p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
        for (int a = 0; a < 3; ++a) {
            const float weight = n[a] * n[a];
            if (weight > kLeastWeight) faces[2 * a + (n[a] > 0.F ? 1 : 0)] += weight * pixel;
        }
    }

    /// Sum of the weights over all faces.
    float surfaceWeight() const {
        float sum = 0.F;
        for (const Sums& face : faces) sum += face[0];
        return sum;
    }
};

/// The cells in view of one observation: which of them were crossed by a ray, in which a ray ended
/// (hit), and the grey values observed there. A dense box of cells, x fastest, that consists of
/// whole bricks of 4 x 4 x 4 cells. Coordinates are in cells: OctoMap's keys minus kKeyOfZero.
class CellScan {
  public:
    /// @param cells box of cells that rays can reach [cells]; four more are kept on every side
    /// @param resolution edge of a cell [m]
    CellScan(const Eigen::AlignedBox3d& cells, double resolution)
        : resolution_(resolution),
          first_((cells.min().array() / 4.).floor().cast<int>() * 4 - 4),
          bricks_((cells.max().array().floor().cast<int>() - first_) / 4 + 2),
          stride_{1, std::ptrdiff_t{4} * bricks_.x(),
                  std::ptrdiff_t{16} * bricks_.x() * bricks_.y()},
          memory_(std::exchange(spareMemory(), {})) {
        const std::size_t bricks = bricks_.cast<std::size_t>().prod();
        memory_.crossed.assign(64 * bricks, 0);
        memory_.brickPixels.assign(bricks, kNoPixels);
        memory_.bricksHit.clear();
        memory_.pixels.clear();
        memory_.rayEnds.clear();
    }
    CellScan(const CellScan&) = delete;
    CellScan& operator=(const CellScan&) = delete;
    ~CellScan() {
        if (memory_.crossed.size() < kMostKept) spareMemory() = std::move(memory_);
    }

    /// Largest number of cells that a scan of this box stores.
    static double cellsNeeded(const Eigen::AlignedBox3d& cells) {
        return (cells.sizes().array() + 12.).prod();
    }

    /// The pixels of a cell that is hit. The reference is valid until the next call.
    CellPixels& obtain(const Eigen::Array3i& cell) {
        std::int32_t& brick = memory_.brickPixels[brickOf(cell)];
        if (brick == kNoPixels) {
            brick = static_cast<std::int32_t>(memory_.bricksHit.size());
            memory_.bricksHit.emplace_back();
        }
        BrickPixels& seen = memory_.bricksHit[brick];
        const unsigned bit = bitOf(cell);
        if ((seen.hit >> bit & 1U) == 0) {
            seen.hit |= 1ULL << bit;
            seen.cells[bit] = static_cast<std::int32_t>(memory_.pixels.size());
            memory_.pixels.emplace_back();
        }
        return memory_.pixels[seen.cells[bit]];
    }

    /// Marks a cell as crossed.
    /// @returns whether the cell was crossed for the first time
    bool cross(const Eigen::Array3i& cell) {
        return std::exchange(memory_.crossed[place(cell)], 1) == 0;
    }

    /// Adds a ray to castRays().
    /// @param end end of the ray [cells]
    void addRay(const Eigen::Vector3d& end) { memory_.rayEnds.push_back(end); }

    /// Marks all cells as crossed from the eye up to, not including, the cells in which rays end.
    /// @param eye position of the camera [cells]
    void castRays(const Eigen::Vector3d& eye);

    /// What the depth image says of a point of the map [cells].
    using PointCheck = std::function<bool(const Eigen::Vector3d& point)>;
    struct DepthChecks {
        /// Whether a surface point may still be there: asked for occupied cells that rays crossed,
        /// before they become free. Empty: none remains.
        PointCheck remains;
        /// Whether it sees through a point: asked for the centres of unknown cells that rays
        /// crossed, before they become free. Empty: it does.
        PointCheck seesThrough;
    };

    /// Updates the map by this observation.
    /// @param eye position of the camera [cells]; without it, surfaces are observed from all sides
    /// @returns what changed in the map
    MapChange apply(TexturedOcTree& map, const std::optional<Eigen::Vector3d>& eye,
                    const FusionOptions& options, const DepthChecks& depth = {}) const;

  private:
    static constexpr std::int32_t kNoPixels = -1;
    static constexpr std::size_t kMostKept = 1 << 23;  // cells in the box of a scan

    struct BrickPixels {
        std::uint64_t hit = 0;
        std::array<std::int32_t, 64> cells;  // index into Memory::pixels of those that were hit
    };

    /// Memory that is reused by the next scan of the same thread. New memory, which the system has
    /// to clear, would take longer than casting the rays.
    struct Memory {
        // Per cell; bytes, because setting single bits is slower.
        std::vector<std::uint8_t> crossed;
        std::vector<std::int32_t> brickPixels;  // per brick: index into bricksHit
        std::vector<BrickPixels> bricksHit;
        std::vector<CellPixels> pixels;
        std::vector<Eigen::Vector3d> rayEnds;
    };
    static Memory& spareMemory() {
        thread_local Memory memory;
        return memory;
    }

    std::uint64_t hitInBrick(std::size_t brick) const {
        const std::int32_t index = memory_.brickPixels[brick];
        return index != kNoPixels ? memory_.bricksHit[index].hit : 0;
    }
    bool isHit(const Eigen::Array3i& cell) const {
        return (hitInBrick(brickOf(cell)) >> bitOf(cell) & 1U) != 0;
    }
    /// Null for a cell that is not hit.
    const CellPixels* pixelsOf(const Eigen::Array3i& cell) const {
        if (!isHit(cell)) return nullptr;
        const BrickPixels& brick = memory_.bricksHit[memory_.brickPixels[brickOf(cell)]];
        return &memory_.pixels[brick.cells[bitOf(cell)]];
    }
    std::size_t brickOf(const Eigen::Array3i& cell) const {
        const Eigen::Array3i c = cell - first_;
        return (std::size_t(c.z() >> 2) * bricks_.y() + (c.y() >> 2)) * bricks_.x() + (c.x() >> 2);
    }
    unsigned bitOf(const Eigen::Array3i& cell) const {  // first_ is a multiple of 4
        return brickBit(cell.x(), cell.y(), cell.z());
    }
    std::ptrdiff_t place(const Eigen::Array3i& cell) const {
        const Eigen::Array3i c = cell - first_;
        return c.x() + c.y() * stride_[1] + c.z() * stride_[2];
    }
    std::uint64_t crossedInBrick(const Eigen::Array3i& corner) const;
    std::vector<BrickObservation> observedBricks() const;
    static Eigen::Array3i cellAt(const BrickObservation& brick, unsigned bit);
    static void keepUnknown(const TexturedOcTree& map, const PointCheck& seesThrough,
                            std::vector<BrickObservation>& bricks);
    void observeFaces(TexturedOcTreeNode& node, const Eigen::Array3i& cell, const CellPixels& seen,
                      const std::optional<Eigen::Vector3d>& eye,
                      const FusionOptions& options) const;
    CellPixels::Sums acrossCells(const Eigen::Array3i& cell, int face, double depthNoise) const;

    double resolution_;
    Eigen::Array3i first_, bricks_;
    std::array<std::ptrdiff_t, 3> stride_;
    Memory memory_;
};

}  // namespace photonav
