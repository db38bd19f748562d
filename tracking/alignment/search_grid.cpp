// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/search_grid.hpp"

#include <cmath>

#include "geometry/eigensystem.hpp"

namespace photonav {
namespace {

constexpr double kReach = 3.;       // from the prior's mean [standard deviations]
constexpr double kMaxPlaces = 4e3;  // views compared; the spacing grows beyond

/// Between points of a grid in the box around an ellipsoid, which has no more than kMaxPlaces
/// [pixels].
double spacingWithin(const Vector6& sigmas) {
    double spacing = kSearchSpacing;
    for (int axis = 0; axis < 6; ++axis) {  // of those wider than the spacing, one less each time
        const auto places = (2. * kReach / spacing * sigmas.array()).max(1.).eval();
        const auto wide = (places > 1.).count();
        const double excess = places.prod() / kMaxPlaces;
        if (excess > 1.) spacing *= std::pow(excess, 1. / static_cast<double>(wide));
    }
    return spacing;
}

}  // namespace

ImageMotion imageMotionOf(const Matrix6& covariance, const Camera& camera, double depth) {
    // At the side of the image, a motion dz along the optical axis moves the content by side * dz /
    // depth, and a rotation about this axis by side times the angle.
    const double side = 0.5 * camera.width;
    Vector6 pixels;
    pixels << camera.fx() / depth, camera.fy() / depth, side / depth, camera.fy(), camera.fx(),
        side;
    const auto [variances, axes] =
        eigensystem(pixels.asDiagonal() * covariance * pixels.asDiagonal());
    return {pixels.cwiseInverse().asDiagonal() * axes, variances.cwiseMax(0.).cwiseSqrt()};
}

std::vector<Vector6> placesWithin(const Vector6& sigmas) {
    const Vector6 radii = kReach * sigmas;
    const double spacing = spacingWithin(sigmas);
    std::vector<Vector6> places{Vector6::Zero()};
    for (int axis = 0; axis < 6; ++axis) {
        const int reach = static_cast<int>(radii[axis] / spacing);
        for (std::size_t k = places.size(); k-- > 0;) {
            for (int i = -reach; i <= reach; ++i) {
                Vector6 place = places[k];
                place[axis] = spacing * i;
                const Vector6 share = place.cwiseQuotient(radii.cwiseMax(spacing));
                if (i != 0 && share.squaredNorm() <= 1.) places.push_back(place);
            }
        }
    }
    return places;
}

double searchSpacing(const Matrix6& covariance, const Camera& camera, double depth) {
    return spacingWithin(imageMotionOf(covariance, camera, depth).sigmas);
}

}  // namespace photonav
