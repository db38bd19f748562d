// SPDX-License-Identifier: BSD-3-Clause
#include "map_picture.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace photonav {
namespace {

/// A floor at z = 0, bright in the quarter x > 0, y > 0, with nothing where x < -3.
class QuarterFloor : public ViewSource {
  public:
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        view.intensity.resize(camera.height, camera.width);
        view.depth.resize(camera.height, camera.width);
        const Pose T_w_c = T_c_w.inverse();
        for (unsigned v = 0; v < camera.height; ++v)
            for (unsigned u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                          (v - camera.cy()) / camera.fy(), 1.0);
                const double depth = -T_w_c.translation().z() / (T_w_c.linear() * ray).z();
                const Eigen::Vector3d p = T_w_c * (depth * ray);
                view.depth[v][u] = p.x() < -3.0 ? 0.F : static_cast<float>(depth);
                view.intensity[v][u] = p.x() > 0.0 && p.y() > 0.0 ? 0.9F : 0.2F;
            }
    }
};

TEST(MapPicture, ShowsTheFloorWhereItIs) {
    const Eigen::AlignedBox2d area(Eigen::Vector2d(-4, -2), Eigen::Vector2d(6, 4));
    for (const double height : {0.8, 2.0, 5.0}) {
        const ImageF picture = pictureFromAbove(QuarterFloor(), area, height);
        ASSERT_EQ(picture.getWidth(), 400U);
        ASSERT_EQ(picture.getHeight(), 240U);
        // 40 pixels a metre; x = 0 is column 160, y = 0 is row 160.
        int wrong = 0;
        for (unsigned r = 0; r < 240; ++r)
            for (unsigned c = 0; c < 400; ++c) {
                if (std::abs(c - 160.0) < 4 || std::abs(r - 160.0) < 4 || std::abs(c - 40.0) < 5)
                    continue;
                const float expected = c < 40 ? 1.F : c > 160 && r < 160 ? 0.9F : 0.2F;
                wrong += picture[r][c] != expected;
            }
        EXPECT_EQ(wrong, 0) << "height " << height;
    }
    EXPECT_THROW(pictureFromAbove(QuarterFloor(), {}, 2.0), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
