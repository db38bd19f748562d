// SPDX-License-Identifier: BSD-3-Clause
// Conversions between Eigen's and ViSP's types. No other file converts them.
#pragma once

#include <visp3/core/vpColVector.h>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpMatrix.h>

#include "geometry/types.hpp"

namespace photonav {

/// T_a_b as ViSP's aMb.
inline vpHomogeneousMatrix toVisp(const Pose& T_a_b) {
    vpHomogeneousMatrix aMb;
    for (unsigned i = 0; i < 3; ++i) {
        for (unsigned j = 0; j < 4; ++j) aMb[i][j] = T_a_b(i, j);
    }
    return aMb;
}

/// ViSP's aMb as T_a_b.
inline Pose fromVisp(const vpHomogeneousMatrix& aMb) {
    Pose T_a_b = Pose::Identity();
    for (unsigned i = 0; i < 3; ++i) {
        for (unsigned j = 0; j < 4; ++j) T_a_b(i, j) = aMb[i][j];
    }
    return T_a_b;
}

/// A twist (rho, phi) as ViSP's (v, omega).
inline vpColVector toVisp(const Vector6& xi) {
    vpColVector v(6);
    for (unsigned i = 0; i < 6; ++i) v[i] = xi[i];
    return v;
}

/// ViSP's (v, omega) as a twist (rho, phi). v must have at least six elements.
inline Vector6 twistFromVisp(const vpColVector& v) { return Eigen::Map<const Vector6>(v.data); }

inline vpMatrix toVisp(const Matrix6& matrix) {
    vpMatrix m(6, 6);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.data) = matrix;
    return m;
}

/// m must be 6x6: information, covariance or twist transformation.
inline Matrix6 matrix6FromVisp(const vpMatrix& m) {
    return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.data);
}

}  // namespace photonav
