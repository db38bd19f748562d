// SPDX-License-Identifier: BSD-3-Clause
// Surfaces inside a cell: the means that a map stores, and the planes that views show.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

namespace photonav {

/// The surface that was observed through one face of a cell: weighted means of its points and
/// normals, world axes. Points are relative to the cell's centre [cells]. Normals have unit length
/// and point out of the solid.
struct FaceSurface {
    static constexpr float kUnit = 32767.F;  ///< value of `point` and `normal` that stands for 1

    float weight = 0.F;                    ///< sum of inverse variances [1/m^2]; 0: never observed
    std::array<std::int16_t, 3> point{};   ///< mean point [cells / kUnit]
    std::array<std::int16_t, 3> normal{};  ///< mean of unit normals; shorter if they scatter

    bool observed() const { return weight > 0.F; }
    /// Adds an observation to the weighted running means. Observing the means again leaves them
    /// bit-identical.
    /// @param p point relative to the cell's centre [cells]
    /// @param n unit normal
    /// @param maxWeight upper limit of the weight: older observations then count less and less
    void observe(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float addedWeight,
                 float maxWeight);
    Eigen::Vector3f meanPoint() const;   ///< relative to the cell's centre [cells]
    Eigen::Vector3f meanNormal() const;  ///< not normalised
    bool operator==(const FaceSurface&) const = default;
};
static_assert(sizeof(FaceSurface) == 16);  // written to files as it is

/// A plane in 32 bits. With a the axis of the largest component of its normal and p < q the other
/// two axes, the plane is
///     x_a = offset + slope[0] x_p + slope[1] x_q,
/// relative to the cell's centre [cells]. Bits 0-8 and 9-17 are the slopes, bits 18-28 the offset,
/// bits 29-31 the code: 1 + the number of the face that the normal points to. The value 0 means no
/// plane.
struct SurfacePlane {
    static constexpr float kSlopeUnit = 1.F / 255.F;   ///< unit of the slopes; |slope| <= 1
    static constexpr float kOffsetUnit = 1.F / 682.F;  ///< unit of the offset; |offset| <= 1.5
    static constexpr unsigned kSeveral = 7;            ///< code of an index into VoxelGrid::several

    static unsigned codeOf(std::uint32_t plane) { return plane >> 29U; }
};

/// The surfaces of an occupied cell as shown in views: at most three planes that meet in the cell.
struct ShownSurfaces {
    static constexpr unsigned kMost = 3;  ///< largest number of planes

    std::array<std::uint32_t, kMost> plane{};  ///< SurfacePlane values, in the order of their faces
    /// How the pairs of planes (0, 1), (0, 2), (1, 2) meet. Bits 0-2: in a convex edge, the solid
    /// is behind both planes. Bits 3-5: in a concave edge, the solid is behind one of them. Neither
    /// bit: they are the two sides of a thin wall.
    std::uint32_t edges = 0;

    bool empty() const { return plane[0] == 0; }
    bool several() const { return plane[1] != 0; }  ///< more than one plane
    bool operator==(const ShownSurfaces&) const = default;
};

/// The surfaces observed through the six faces of a cell, and the planes that views show of them.
/// Most cells of a map are free and have no surfaces; they take the memory of one pointer.
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

    /// The surface of a face for changes, created if it does not exist. Call refreshShown() after
    /// the changes.
    FaceSurface& obtain(unsigned face);
    /// Computes shown() from the surfaces of the faces.
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

/// How far the surfaces of a cell have moved: the largest change of an offset [cells] or of a
/// slope; 1 if the planes belong to other faces or meet in other edges.
float surfaceMotion(const ShownSurfaces& before, const ShownSurfaces& after);

}  // namespace photonav
