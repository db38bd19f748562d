// SPDX-License-Identifier: BSD-3-Clause
// Where surfaces lie inside a cell: what a map keeps of them, and the planes that views show.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

namespace photonav {

/// Weighted means over the surface points that were observed through one face of a cell. Points are
/// in cells from the cell's centre, normals have unit length and point out of the solid.
struct FaceSurface {
    static constexpr float kUnit = 32767.F;  ///< of `point` and `normal`; stored exactly in files

    float weight = 0.F;  ///< sum of inverse variances [1/m^2]; 0: never observed
    std::array<std::int16_t, 3> point{};
    std::array<std::int16_t, 3> normal{};  ///< mean of unit normals: shorter where they scatter

    bool observed() const { return weight > 0.F; }
    /// Weighted running mean. Observing the means leaves them bit-identical.
    /// @param maxWeight upper limit of the weight: older observations then count less and less
    void observe(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float addedWeight,
                 float maxWeight);
    Eigen::Vector3f meanPoint() const;
    Eigen::Vector3f meanNormal() const;
    bool operator==(const FaceSurface&) const = default;
};
static_assert(sizeof(FaceSurface) == 16);  // written to files as it is

/// A plane in 32 bits, along the axis a on which its normal is longest: x_a = offset + slope[0] x_p
/// + slope[1] x_q, in cells from the cell's centre, p < q the other axes. Bits 0-8 and 9-17 the
/// slopes, 18-28 the offset, 29-31 the code: face + 1, the face being the one its normal points to.
/// 0: no plane.
struct SurfacePlane {
    static constexpr float kSlopeUnit = 1.F / 255.F;   ///< |slope| <= 1
    static constexpr float kOffsetUnit = 1.F / 682.F;  ///< |offset| <= 1.5
    static constexpr unsigned kSeveral = 7;  ///< code of an index to ShownSurfaces (VoxelGrid)

    static unsigned codeOf(std::uint32_t plane) { return plane >> 29U; }
};

/// The surfaces of an occupied cell as views show them: at most three planes that meet in the cell.
struct ShownSurfaces {
    static constexpr unsigned kMost = 3;

    std::array<std::uint32_t, kMost> plane{};  ///< SurfacePlane, in the order of their faces
    /// How pairs of planes (0, 1), (0, 2), (1, 2) meet, bits 0-2: in a convex edge, the solid is
    /// behind both; bits 3-5: in a concave edge, the solid is behind either. None: they are the two
    /// sides of a thin wall.
    std::uint32_t edges = 0;

    bool empty() const { return plane[0] == 0; }
    bool several() const { return plane[1] != 0; }
    bool operator==(const ShownSurfaces&) const = default;
};

/// The surfaces of a cell's six faces, and what views show of them. Most cells of a map are free
/// and have none: they cost one pointer.
class CellSurfaces {
  public:
    CellSurfaces() = default;
    CellSurfaces(const CellSurfaces& other) { *this = other; }
    CellSurfaces(CellSurfaces&&) = default;
    CellSurfaces& operator=(const CellSurfaces& other);
    CellSurfaces& operator=(CellSurfaces&&) = default;
    ~CellSurfaces() = default;

    bool empty() const { return content_ == nullptr; }
    void clear() { content_.reset(); }
    const FaceSurface& operator[](unsigned face) const { return content().faces[face]; }
    const ShownSurfaces& shown() const { return content().shown; }

    /// A face's surface to be changed, made if there is none. refreshShown() has to follow.
    FaceSurface& obtain(unsigned face);
    void refreshShown();
    bool operator==(const CellSurfaces& other) const;

  private:
    struct Content {
        std::array<FaceSurface, 6> faces;
        ShownSurfaces shown;
    };

    const Content& content() const;

    std::unique_ptr<Content> content_;
};

/// How far the surfaces of a cell have moved [cells], with turns in radians as lengths; 1 when
/// another set of surfaces is shown.
float surfaceMotion(const ShownSurfaces& before, const ShownSurfaces& after);

}  // namespace photonav
