// SPDX-License-Identifier: BSD-3-Clause
// Plausible intrinsics of a camera. Values outside mean that a file holds a wrong number.
#pragma once

namespace photonav {

/// Fields of view up to 179 degrees, principal points up to ten images outside.
struct IntrinsicsBounds {
    static constexpr double kMostFocalLength = 1e9;  ///< [pixels]

    double leastFocalLength;        ///< of the axis [pixels]
    double farthestPrincipalPoint;  ///< of the axis, on either side of pixel 0 [pixels]

    /// @param pixels of the image along an axis: its width, or its height
    explicit constexpr IntrinsicsBounds(double pixels)
        : leastFocalLength(0.005 * pixels), farthestPrincipalPoint(10. * pixels) {}

    /// Whether focal length and principal point of the axis are within them; NaN is not.
    constexpr bool contain(double focalLength, double principalPoint) const {
        return focalLength >= leastFocalLength && focalLength <= kMostFocalLength &&
               principalPoint >= -farthestPrincipalPoint &&
               principalPoint <= farthestPrincipalPoint;
    }
};

}  // namespace photonav
