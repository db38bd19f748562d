// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/floor_plane.hpp"

#include <gtest/gtest.h>

#include <random>

namespace photonav {
namespace {

/// A tilted room: floor with 5 mm of noise, a wall of more points, and clutter.
std::vector<Eigen::Vector3d> room(const Eigen::Matrix3d& R, int floor, int wall, int clutter) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0., 0.005);
    std::uniform_real_distribution<double> metre(0., 3.);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < floor; ++i)
        points.push_back(R * Eigen::Vector3d(metre(random), metre(random), noise(random)));
    for (int i = 0; i < wall; ++i)
        points.push_back(R * Eigen::Vector3d(noise(random), metre(random), metre(random)));
    for (int i = 0; i < clutter; ++i)
        points.push_back(R * Eigen::Vector3d(metre(random), metre(random), metre(random)));
    return points;
}

const Eigen::Matrix3d kTilt =
    Eigen::AngleAxisd(0.35, Eigen::Vector3d(1., 0.5, 0.2).normalized()).toRotationMatrix();

TEST(FloorPlane, FindsTheTiltThroughWallsAndClutter) {
    const auto up = floorNormal(room(kTilt, 600, 900, 500), Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(up);
    EXPECT_LT(std::acos(up->dot(kTilt.col(2))), 0.005);
    EXPECT_EQ(*up, *floorNormal(room(kTilt, 600, 900, 500), Eigen::Vector3d::UnitZ()));
}

TEST(FloorPlane, SaysWhenThereIsNone) {
    EXPECT_FALSE(floorNormal(room(kTilt, 0, 900, 500), Eigen::Vector3d::UnitZ()));
    EXPECT_FALSE(floorNormal({}, Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace photonav
