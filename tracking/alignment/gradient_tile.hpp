// SPDX-License-Identifier: BSD-3-Clause
// Gradients of a model and an image, summed over small tiles of the image.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Sums of gradients over a tile of the image. A tile is so small that a motion of the camera moves
/// all of its pixels by the same vector.
struct GradientTile {
    double x = 0., y = 0.;                            ///< centre, normalised coordinates
    double inverseDepth = 0.;                         ///< mean [1/m]
    Eigen::Matrix2d model = Eigen::Matrix2d::Zero();  ///< sum of g g^T, g gradient of the model
    /// Symmetric part of the sum of g o^T, o gradient of the image.
    Eigen::Matrix2d shared = Eigen::Matrix2d::Zero();
    double observed = 0.;  ///< sum of |o|^2
    int pixels = 0;
};

/// Motion of a point in the image, in units of the focal length, with the camera's pose.
struct TileMotion {
    Vector6 du, dv;

    explicit TileMotion(const GradientTile& t) {
        const double x = t.x, y = t.y, w = t.inverseDepth;
        du << -w, 0., x * w, x * y, -(x * x + 1.), y;
        dv << 0., -w, y * w, y * y + 1., -x * y, -x;
    }
    /// J^T J of gradients whose sum of g g^T is given.
    Matrix6 squared(const Eigen::Matrix2d& gradients) const {
        Eigen::Matrix<double, 6, 2> D;
        D << du, dv;
        return D * gradients * D.transpose();
    }
    /// v^T squared(gradients) v
    double squared(const Eigen::Matrix2d& gradients, const Vector6& v) const {
        const Eigen::Vector2d motion(du.dot(v), dv.dot(v));
        return motion.dot(gradients * motion);
    }
};

}  // namespace photonav
