// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_renderer.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/photometry/synthetic_floor.hpp"
#include "map/map_fusion.hpp"

namespace photonav {
namespace {

using test::floorView;
using test::kDown;
using test::lookDown;

constexpr double kCell = 0.05;

/// Sets one cell; grey < 0 leaves its faces unobserved.
void setCell(TexturedOcTree& map, int x, int y, int z, bool occupied, float grey = 0.5F,
             unsigned observedFaces = 0x3F) {
    auto* node = map.setNodeValue(octomap::OcTreeKey(32768 + x, 32768 + y, 32768 + z),
                                  occupied ? 1.F : -1.F, true);
    for (unsigned f = 0; f < 6 && grey >= 0.F; ++f) {
        if ((observedFaces >> f & 1U) != 0) node->faces[f].observe(grey, 1.F);
    }
}

/// A world of 24 x 20 x 16 cells: walls all around but for holes, clutter inside, a part unknown.
TexturedOcTree clutteredRoom(unsigned seed) {
    TexturedOcTree map(kCell);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.F, 1.F);
    for (int z = 0; z < 16; ++z) {
        for (int y = 0; y < 20; ++y) {
            for (int x = 0; x < 24; ++x) {
                const bool wall = x == 0 || y == 0 || z == 0 || x == 23 || y == 19 || z == 15;
                const float dice = uniform(random), grey = uniform(random);
                if (wall ? dice < 0.9F : dice < 0.04F) {
                    setCell(map, x - 12, y - 9, z - 3, true, dice < 0.02F ? -1.F : grey);
                } else if (dice < 0.9F) {
                    setCell(map, x - 12, y - 9, z - 3, false);
                }
            }
        }
    }
    map.updateInnerOccupancy();
    return map;
}

struct ReferenceHit {
    double depth = 0.;
    octomap::OcTreeKey key;
    unsigned face = 0;
};

/// The plainest ray: cell by cell in double precision, asking the octree itself.
ReferenceHit castReference(TexturedOcTree& map, UnknownPolicy unknown, const Eigen::Vector3d& eye,
                           Eigen::Vector3d ray) {
    Eigen::Array3d low, high;
    map.getMetricMin(low.x(), low.y(), low.z());
    map.getMetricMax(high.x(), high.y(), high.z());
    ray = (ray.array() == 0.).select(1e-12, ray);
    const double r = map.getResolution();
    double t = 0., tExit = 1e30;
    int axis = -1;
    for (int a = 0; a < 3; ++a) {
        const double t0 = ((ray[a] > 0. ? low : high)[a] - eye[a]) / ray[a];
        const double t1 = ((ray[a] > 0. ? high : low)[a] - eye[a]) / ray[a];
        if (t0 > t) {
            t = t0;
            axis = a;
        }
        tExit = std::min(tExit, t1);
    }
    Eigen::Array3i cell = ((eye + t * ray).array() / r).floor().cast<int>();
    if (axis >= 0) {
        cell[axis] = static_cast<int>(std::lround((ray[axis] > 0. ? low : high)[axis] / r)) -
                     (ray[axis] > 0. ? 0 : 1);
    }
    while (t < tExit) {
        const Eigen::Array3i k = cell + 32768;
        const octomap::OcTreeKey key(k.x(), k.y(), k.z());
        const auto* node = map.search(key);
        const bool occupied = node != nullptr && map.isNodeOccupied(node);
        if (node == nullptr && unknown == UnknownPolicy::occupied) return {};
        if (occupied) {
            if (axis < 0 || !node->meanGrey()) return {};
            return {t, key, 2U * axis + (ray[axis] < 0. ? 1U : 0U)};
        }
        t = 1e30;
        for (int a = 0; a < 3; ++a) {
            const double next = ((cell[a] + (ray[a] > 0. ? 1 : 0)) * r - eye[a]) / ray[a];
            if (next < t) {
                t = next;
                axis = a;
            }
        }
        cell[axis] += ray[axis] > 0. ? 1 : -1;
    }
    return {};
}

Pose randomPose(std::mt19937& random, double reach) {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const Eigen::Vector3d axis(uniform(random), uniform(random), uniform(random));
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = Eigen::AngleAxisd(3. * uniform(random), axis.normalized()).toRotationMatrix();
    T_w_c.translation() =
        reach * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    return T_w_c.inverse();
}

struct Agreement {
    int pixels = 0, different = 0, surface = 0;
};

Agreement compareWithReference(TexturedOcTree& map, UnknownPolicy unknown, const Camera& camera,
                               const Pose& T_c_w) {
    const VoxelRenderer renderer(map, unknown);
    View view;
    renderer.render(camera, T_c_w, view);
    const Pose T_w_c = T_c_w.inverse();
    Agreement agreement;
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                      (v - camera.cy()) / camera.fy(), 1.);
            const auto hit = castReference(map, unknown, T_w_c.translation(), T_w_c.linear() * ray);
            const double error = std::abs(hit.depth - view.depth[v][u]);
            ++agreement.pixels;
            agreement.surface += static_cast<int>(hit.depth > 0.);
            agreement.different += static_cast<int>(error > 1e-5 * (1. + hit.depth));
        }
    }
    return agreement;
}

TEST(VoxelRenderer, AgreesWithPlainRayCasting) {
    const Camera camera = makeCamera(61, 47, 1.4);
    std::mt19937 random(11);
    Agreement all;
    for (int i = 0; i < 40; ++i) {
        TexturedOcTree map = clutteredRoom(i / 8);
        const auto unknown = i % 2 == 0 ? UnknownPolicy::free : UnknownPolicy::occupied;
        // Half of the eyes are inside the room, half anywhere around it.
        const Pose T_c_w = randomPose(random, i % 4 < 2 ? 0.4 : 2.);
        const Agreement one = compareWithReference(map, unknown, camera, T_c_w);
        EXPECT_LE(one.different, 3) << "view " << i;
        all.pixels += one.pixels;
        all.different += one.different;
        all.surface += one.surface;
    }
    EXPECT_GT(all.surface, all.pixels / 5);
    EXPECT_LE(all.different, all.pixels / 10000);  // rays that graze an edge of a cell
}

TEST(VoxelRenderer, AxisAlignedRaysAndEyesOnCellEdgesAreNoSpecialCase) {
    TexturedOcTree map = clutteredRoom(1);
    const Camera camera = makeCamera(9, 9, 1.2);
    for (const double yaw : {0., kDown, -kDown, 2 * kDown}) {
        const auto inside = compareWithReference(map, UnknownPolicy::free, camera,
                                                 lookDown(0.02, 0.013, 0.007, 0., yaw));
        EXPECT_EQ(inside.different, 0) << yaw;
        const auto onEdge =
            compareWithReference(map, UnknownPolicy::free, camera, lookDown(0., 0., 0., 0., yaw));
        EXPECT_LE(onEdge.different, 17) << yaw;  // the middle row and column, along edges
    }
}

TEST(VoxelRenderer, InterpolatesBetweenFaceCentres) {
    TexturedOcTree map(kCell);
    const auto grey = [](int x, int y) { return 0.5F + 0.3F * std::sin(3.F * x + 5.F * y * y); };
    for (int y = -20; y < 20; ++y) {
        for (int x = -20; x < 20; ++x) setCell(map, x, y, 0, true, grey(x, y));
    }
    for (const double belowHorizon : {kDown, 0.9}) {
        const Camera camera = makeCamera(64, 48, 0.5);
        const Pose T_c_w = lookDown(-0.3, 0.1, 0.8, belowHorizon, 0.3);
        View view;
        VoxelRenderer(map, UnknownPolicy::free).render(camera, T_c_w, view);
        View expected = view;
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d p = test::pointOf(view, camera, T_c_w, u, v);
                const double x = p.x() / kCell - 0.5, y = p.y() / kCell - 0.5;
                const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
                EXPECT_NEAR(p.z(), kCell, 1e-5);
                expected.intensity[v][u] = static_cast<float>(
                    (j + 1 - y) * ((i + 1 - x) * grey(i, j) + (x - i) * grey(i + 1, j)) +
                    (y - j) * ((i + 1 - x) * grey(i, j + 1) + (x - i) * grey(i + 1, j + 1)));
            }
        }
        Camera sharp = camera;
        sharp.hasPointSpread = false;
        View rays;
        VoxelRenderer(map, UnknownPolicy::free).render(sharp, T_c_w, rays);
        for (unsigned i = 0; i < rays.intensity.getSize(); ++i) {
            ASSERT_NEAR(rays.intensity.bitmap[i], expected.intensity.bitmap[i], 5e-5);
        }
        applyPointSpread(rays);
        for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
            ASSERT_EQ(rays.intensity.bitmap[i], view.intensity.bitmap[i]);
        }
        applyPointSpread(expected);
        for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
            ASSERT_NEAR(view.intensity.bitmap[i], expected.intensity.bitmap[i], 5e-5);
        }
    }
}

TEST(VoxelRenderer, ConstantFloorsAreConstantToTheBit) {
    TexturedOcTree map(kCell);
    for (int y = -20; y < 20; ++y) {
        for (int x = -20; x < 20; ++x) {
            if ((x * 7 + y * 5) % 11 == 0) continue;  // holes
            setCell(map, x, y, (x + y) % 5 == 0 ? 1 : 0, true, 0.3F, 0x20);
        }
    }
    View view;
    VoxelRenderer(map, UnknownPolicy::free)
        .render(makeCamera(188, 120, 1.2), lookDown(0., 0.1, 0.9, 0.8), view);
    float seen = 0.F;
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
        if (view.depth.bitmap[i] == 0.F) continue;
        if (seen == 0.F) seen = view.intensity.bitmap[i];
        ASSERT_EQ(view.intensity.bitmap[i], seen);
    }
    EXPECT_NEAR(seen, 0.3, 1e-5);
}

TEST(VoxelRenderer, SurfacesGoOnOverStepsOfOneCell) {
    TexturedOcTree map(kCell);
    for (int y = -20; y < 20; ++y) {
        for (int x = -20; x < 20; ++x) {
            setCell(map, x, y, x < 0 ? 0 : 1, true, 0.5F + 0.02F * static_cast<float>(x), 0x20);
        }
    }
    const Camera camera = makeCamera(101, 51, 0.4);
    View view;
    VoxelRenderer(map, UnknownPolicy::free)
        .render(camera, lookDown(0.001, 0.1, 1., kDown, -kDown), view);
    double largest = 0.;
    for (unsigned u = 1; u < camera.width; ++u) {
        largest =
            std::max<double>(largest, std::abs(view.intensity[25][u] - view.intensity[25][u - 1]));
    }
    // The ramp rises by 0.4 grey values per metre: an edge would rise by half a step of 0.02.
    EXPECT_LT(largest, 1.3 * 0.4 * 0.05 * 20. / camera.fx());
}

TEST(VoxelRenderer, UnseenFacesTakeTheirCellsMeanAndUnseenCellsNothing) {
    TexturedOcTree map(kCell);
    setCell(map, 0, 0, 0, true, 0.25F, 0x20);  // only its top was seen
    setCell(map, 0, 10, 0, true, -1.F);
    const Camera camera = makeCamera(15, 15, 0.02);
    const VoxelRenderer renderer(map, UnknownPolicy::free);
    View view;
    renderer.render(camera, lookDown(-1., 0.025, 0.025, 0.), view);  // its -x side
    EXPECT_NEAR(view.depth[7][7], 1., 1e-5);
    EXPECT_NEAR(view.intensity[7][7], 0.25, 1e-5);
    renderer.render(camera, lookDown(-1., 0.525, 0.025, 0.), view);
    EXPECT_EQ(view.depth[7][7], 0.F);
    EXPECT_EQ(view.intensity[7][7], 0.F);
}

TEST(VoxelRenderer, UnknownSpaceEndsRaysOnlyWhenAsked) {
    TexturedOcTree map(kCell);
    for (int x = 0; x < 20; ++x) {
        if (x != 10) setCell(map, x, 0, 0, x == 19);
    }
    const Camera camera = makeCamera(5, 5, 0.01);
    const Pose T_c_w = lookDown(0.025, 0.025, 0.025, 0.);
    View view;
    VoxelRenderer(map, UnknownPolicy::free).render(camera, T_c_w, view);
    EXPECT_NEAR(view.depth[2][2], 0.925, 1e-5);
    VoxelRenderer(map, UnknownPolicy::occupied).render(camera, T_c_w, view);
    EXPECT_EQ(view.depth[2][2], 0.F);
}

TEST(VoxelRenderer, EmptyMapsAndBadPosesAreHandled) {
    const Camera camera = makeCamera(5, 5, 1.);
    View view;
    VoxelRenderer(TexturedOcTree(0.1), UnknownPolicy::occupied)
        .render(camera, Pose::Identity(), view);
    EXPECT_EQ(view.depth.getMaxValue(), 0.F);
    TexturedOcTree map(0.1);
    setCell(map, 0, 0, 0, true);
    const VoxelRenderer renderer(map, UnknownPolicy::free);
    renderer.render(camera, lookDown(1e9, 0., 0., 0.), view);
    EXPECT_EQ(view.depth.getMaxValue(), 0.F);
    Pose broken = Pose::Identity();
    broken.translation().x() = std::nan("");
    EXPECT_THROW(renderer.render(camera, broken, view), std::invalid_argument);
}

TEST(VoxelRenderer, RefusesMapsTooLargeForAGrid) {
    TexturedOcTree map(0.01);
    setCell(map, -30000, -30000, -30000, true);
    setCell(map, 30000, 30000, 30000, true);
    EXPECT_THROW(VoxelRenderer(map, UnknownPolicy::free), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
