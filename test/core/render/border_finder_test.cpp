// SPDX-License-Identifier: BSD-3-Clause
// Borders between surfaces, against pixels that average over their area.
#include "render/border_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/photometry/image_difference.hpp"
#include "core/photometry/synthetic_floor.hpp"
#include "geometry/se3.hpp"
#include "render/area_sensor.hpp"
#include "render/mesh_renderer.hpp"

namespace photonav {
namespace {

using test::kDown;
using test::largestDifference;
using test::rmsDifference;

const Camera kSmall = makeCamera(96, 64, 70. * std::numbers::pi / 180.);

/// A grey floor with a white and a black rectangle, 1 cm above it.
Scene rectangles() {
    Scene scene;
    const auto grey = addTexture(scene, uniformTexture(0.5));
    addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.}, grey);
    addPlane(scene, {0.1, -0.3, 0.01}, {0.7, 0., 0.}, {0., 0.5, 0.},
             addTexture(scene, uniformTexture(1.)));
    addPlane(scene, {-0.8, -0.2, 0.01}, {0.6, 0., 0.}, {0., 0.6, 0.},
             addTexture(scene, uniformTexture(0.)));
    return scene;
}

/// Boxes before others, in each other and on a floor.
Scene boxes() {
    Scene scene = rectangles();
    addBox(scene, {-9., -9., -1.}, {9., 9., 4.}, addTexture(scene, uniformTexture(0.8)),
           BoxInside::hollow);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 12; ++i) {
        const Eigen::Vector3d corner(4. * uniform(random) - 2., 4. * uniform(random) - 2., -0.1);
        const Eigen::Vector3d size(0.3 + uniform(random), 0.3 + uniform(random),
                                   0.3 + uniform(random));
        addBox(scene, corner, corner + size,
               addTexture(scene, uniformTexture(std::min(1., uniform(random)))));
    }
    return scene;
}

Camera withoutPointSpread() {
    Camera rays = kSmall;
    rays.hasPointSpread = false;
    return rays;
}

/// The average over 24 x 24 rays per pixel, with the same point spread.
View averaged(const MeshRenderer& world, const Pose& T_c_w) {
    View view;
    AreaSensor(world, 24).render(withoutPointSpread(), T_c_w, view);
    applyPointSpread(view);
    return view;
}

double errorOf(const MeshRenderer& world, const Pose& T_c_w) {
    View view;
    world.render(kSmall, T_c_w, view);
    return rmsDifference(view.intensity, averaged(world, T_c_w).intensity);
}

/// The error of a view whose pixels show what is at their centres.
double errorOfCentres(const MeshRenderer& world, const Pose& T_c_w) {
    View view;
    world.render(withoutPointSpread(), T_c_w, view);
    applyPointSpread(view);
    return rmsDifference(view.intensity, averaged(world, T_c_w).intensity);
}

/// Edges along rows and columns of pixels, and across them, wherever they are between two pixels.
TEST(BorderFinder, EdgesCoverTheSharesOfPixelsThatTheyDo) {
    const MeshRenderer world(rectangles());
    for (const double yaw : {0., 0.001, 0.2, 0.7854, 1.5}) {
        for (const double x : {0., 0.003, 0.007, 0.011}) {
            const Pose T_c_w = lookFrom({x, 0.5 * x, 1.5}, kDown, yaw);
            EXPECT_LT(errorOf(world, T_c_w), 0.2 * errorOfCentres(world, T_c_w)) << yaw << ' ' << x;
        }
    }
}

/// Surfaces that hide others, meet, and intersect. What is narrower than a pixel is seen or not.
TEST(BorderFinder, FindsTheSurfaceInFront) {
    const MeshRenderer world(boxes());
    for (int i = 0; i < 12; ++i) {
        const double yaw = 0.5 * i;
        const Pose T_c_w = lookFrom({-3. * std::cos(yaw), -3. * std::sin(yaw), 2.}, 0.05 * i, yaw);
        EXPECT_LT(errorOf(world, T_c_w), 0.5 * errorOfCentres(world, T_c_w)) << i;
    }
}

/// The rows of an image as wide as a poster repeat: next to its bright side is its dark one.
TEST(BorderFinder, APosterDoesNotShowItsOppositeSide) {
    Scene scene;
    addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.},
             addTexture(scene, uniformTexture(0.5)));
    Texture poster{ImageF(8, 64, 0.F), {1., 1.}};
    for (unsigned v = 0; v < 8; ++v) std::fill_n(poster.image[v] + 32, 32, 1.F);
    addPlane(scene, {-0.5, -0.4, 0.01}, {1., 0., 0.}, {0., 0.8, 0.},
             addTexture(scene, std::move(poster)));
    const MeshRenderer world(std::move(scene));
    for (const double x : {0., 0.003, 0.007, 0.011, 0.015, 0.019}) {
        const Pose T_c_w = lookFrom({x, 0., 1.5}, kDown, 0.);
        EXPECT_LT(errorOf(world, T_c_w), 0.6 * errorOfCentres(world, T_c_w)) << x;
    }
}

/// A bar narrower than a pixel, seen from some pixel centres, is as bright as it is wide.
TEST(BorderFinder, ThinBarsAreAsBrightAsTheyAreWide) {
    const double pixel = 1.49 / kSmall.fx();  // at the bar [m]
    for (const double width : {0.3, 0.6, 0.9}) {
        Scene scene;
        addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.},
                 addTexture(scene, uniformTexture(0.)));
        // Image columns are world x for this camera. The middle is seen from the centres of
        // column 40.
        const double middle = (40. - kSmall.cx()) * pixel;
        addPlane(scene, {middle - 0.5 * width * pixel, -2., 0.01}, {width * pixel, 0., 0.},
                 {0., 4., 0.}, addTexture(scene, uniformTexture(1.)));
        const MeshRenderer world(std::move(scene));
        Pose T_w_c = Pose::Identity();
        T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
        T_w_c.translation().z() = 1.5;
        View view;
        world.render(kSmall, T_w_c.inverse(), view);
        double sum = 0.;
        for (unsigned u = 0; u < kSmall.width; ++u) sum += view.intensity[30][u];
        EXPECT_NEAR(sum, width, 0.01) << width;
    }
}

/// Alignment follows the slope of the grey values: it must be there between two pixels, too.
TEST(BorderFinder, ViewsChangeSmoothlyWithThePose) {
    const MeshRenderer world(rectangles());
    const double pixel = 1.5 / kSmall.fx();  // [m]
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> phase(0., pixel);
    View before, after;
    for (int start = 0; start < 10; ++start) {
        const double x = phase(random), y = phase(random);
        for (int i = 0; i <= 50; ++i) {
            const double moved = 0.02 * i * pixel;
            world.render(kSmall, lookFrom({x + moved, y + moved, 1.5}, kDown, 0.), after);
            // A corner of a rectangle moves a quarter of a pixel from one to another; an edge that
            // jumps would change them by 0.12.
            if (i > 0) {
                EXPECT_LT(largestDifference(before.intensity, after.intensity), 0.07) << i;
            }
            before = after;
        }
    }
}

/// A camera in the plane of a surface, with corners behind it, and images of a row and a column.
TEST(BorderFinder, GivesFiniteViewsFromEverywhere) {
    const MeshRenderer world(boxes());
    for (const Camera& camera : {kSmall, makeCamera(64, 1, 1.2), makeCamera(1, 64, 0.02)}) {
        for (const double height : {0.01, 0.0101, 0.5}) {
            for (const double yaw : {0., 0.7854, 2.}) {
                View view;
                world.render(camera, lookFrom({0.1, -0.3, height}, 0., yaw), view);
                for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
                    ASSERT_GE(view.intensity.bitmap[i], -1e-5F);
                    ASSERT_LE(view.intensity.bitmap[i], 1.00001F);
                }
            }
        }
    }
}

/// Depth is that of the surface at the centre; where there is none, nothing is mixed in.
TEST(BorderFinder, LeavesDepthAndEmptySpaceAlone) {
    Scene scene;
    addPlane(scene, {-0.4, -0.3, 0.}, {0.83, 0., 0.}, {0., 0.61, 0.},
             addTexture(scene, uniformTexture(1.)));
    const MeshRenderer world(std::move(scene));
    const Pose T_c_w = lookFrom({0.013, 0.007, 1.5}, kDown, 0.);
    View view, single;
    world.render(kSmall, T_c_w, view);
    world.render(withoutPointSpread(), T_c_w, single);
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        EXPECT_EQ(view.depth.bitmap[i], single.depth.bitmap[i]);
        EXPECT_EQ(view.intensity.bitmap[i], single.intensity.bitmap[i]);
    }
}

}  // namespace
}  // namespace photonav
