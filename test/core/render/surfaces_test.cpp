// SPDX-License-Identifier: BSD-3-Clause
// Surfaces inside the cells of a map, from images of a mesh to views that are compared with other
// images of the mesh.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/photometry/synthetic_floor.hpp"
#include "map/map_fusion.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "scene/scene.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

constexpr double kEdge = 0.05;

/// A camera at `eye` that looks at `target`.
Pose lookAt(const Vector3d& eye, const Vector3d& target) {
    Pose T_w_c = Pose::Identity();
    const Vector3d z = (target - eye).normalized();
    const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
    T_w_c.linear() << x, z.cross(x), z;
    T_w_c.translation() = eye;
    return T_w_c.inverse();
}

Pose moved(const Vector3d& by) {
    Pose T = Pose::Identity();
    T.translation() = by;
    return T;
}

Pose tilted() {
    Pose T = moved({0.012, 0.021, 0.033});
    T.linear() = Eigen::AngleAxisd(std::numbers::pi / 9., Vector3d(1., 2., 0.5).normalized())
                     .toRotationMatrix();
    return T;
}

Scene withTexture() {
    Scene scene;
    addTexture(scene, valueNoise({.size = {4., 4.}, .seed = 3}));
    return scene;
}

/// Fuses views of a scene from a list of poses. The map's world may lie anyhow in the scene.
class MappedScene {
  public:
    MappedScene(const Scene& scene, const Pose& T_s_w, double resolution = kEdge)
        : mesh(scene), map(resolution), T_s_w_(T_s_w) {}

    void fuseViews(const std::vector<Pose>& poses_c_s, const FusionOptions& options = {}) {
        View view;
        for (const Pose& T_c_s : poses_c_s) {
            mesh.render(camera, T_c_s, view);
            fuse(map, view, camera, T_c_s * T_s_w_, options);
        }
    }

    struct Errors {
        std::vector<double> depth;  ///< absolute, sorted [m]
        double mean = 0.;           ///< with its sign [m]
        double missing = 0.;        ///< share of the pixels
        double wrong = 0.;          ///< share of the pixels that are off by two cells

        double quantile(double q) const {
            return depth.at(static_cast<std::size_t>(q * static_cast<double>(depth.size() - 1)));
        }
    };

    Errors errorsAt(const std::vector<Pose>& poses_c_s) const {
        const VoxelRenderer renderer(map, UnknownPolicy::free);
        Errors errors;
        View truth, seen;
        double pixels = 0.;
        for (const Pose& T_c_s : poses_c_s) {
            mesh.render(camera, T_c_s, truth);
            renderer.render(camera, T_c_s * T_s_w_, seen);
            for (unsigned i = 0; i < truth.depth.getSize(); ++i) {
                if (truth.depth.bitmap[i] == 0.F) continue;
                const double error = double{seen.depth.bitmap[i]} - truth.depth.bitmap[i];
                ++pixels;
                if (seen.depth.bitmap[i] == 0.F) {
                    ++errors.missing;
                    continue;
                }
                const bool wrong = std::abs(error) > 2. * map.getResolution();
                errors.wrong += wrong ? 1. : 0.;
                if (wrong) continue;
                errors.depth.push_back(std::abs(error));
                errors.mean += error;
            }
        }
        errors.mean /= static_cast<double>(errors.depth.size());
        errors.wrong /= pixels;
        errors.missing /= pixels;
        std::sort(errors.depth.begin(), errors.depth.end());
        return errors;
    }

    Camera camera = makeCamera(160, 120, 1.2);
    MeshRenderer mesh;
    TexturedOcTree map;

  private:
    Pose T_s_w_;
};

/// From all around, at two heights, toward the middle.
std::vector<Pose> around(double first, int count, double radius = 1.2) {
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) {
        const double angle = first + 2. * std::numbers::pi * i / count;
        const Vector3d eye(radius * std::cos(angle), radius * std::sin(angle),
                           i % 2 == 0 ? 1.6 : 0.7);
        poses.push_back(lookAt(eye, {-0.8 * eye.x(), -0.8 * eye.y(), 0.4}));
    }
    return poses;
}

/// A room of 4 x 4 x 2.4 m with a box in it.
Scene room() {
    Scene scene = withTexture();
    addBox(scene, {-2., -2., 0.}, {2., 2., 2.4}, 0, BoxInside::hollow);
    addBox(scene, {-0.3, -0.2, 0.}, {0.3, 0.3, 0.43}, 0);
    return scene;
}

class SurfacesIn : public testing::TestWithParam<Pose> {};

TEST_P(SurfacesIn, CellsAreSeenWhereTheyAre) {
    MappedScene mapped(room(), GetParam());
    mapped.fuseViews(around(0., 24));
    const auto errors = mapped.errorsAt(around(0.1, 12));
    EXPECT_LT(std::abs(errors.mean), 0.001);
    EXPECT_LT(errors.quantile(0.9), 0.003);
    EXPECT_LT(errors.quantile(0.98), 0.02);
    EXPECT_LT(errors.wrong, 0.01);
    EXPECT_LT(errors.missing, 0.02);
}

TEST_P(SurfacesIn, CornersOfThreeSurfacesAreSharp) {
    MappedScene inside(room(), GetParam());
    std::vector<Pose> poses, between;
    for (int i = 0; i < 9; ++i) {
        const Vector3d eye(-0.7 + 0.3 * (i % 3), -0.7 + 0.3 * (i / 3), 0.9);
        poses.push_back(lookAt(eye, {-2., -2., 0.}));
        between.push_back(lookAt(eye + Vector3d(0.13, 0.08, 0.1), {-2., -2., 0.}));
    }
    inside.fuseViews(poses);
    const auto concave = inside.errorsAt(between);
    EXPECT_LT(concave.quantile(0.99), 0.01);
    EXPECT_LT(concave.wrong, 0.002);
    EXPECT_LT(concave.missing, 0.03);  // parts that no fused view shows

    Scene box = withTexture();
    addBox(box, {-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}, 0);
    MappedScene outside(box, GetParam());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double x = 1. + 0.1 * static_cast<double>(i % 3);
        const double y = 1. + 0.1 * static_cast<double>(i / 3);
        poses[i] = lookAt({x, y, 1.1}, {0.3, 0.3, 0.3});
        between[i] = lookAt({x + 0.04, y + 0.06, 1.05}, {0.3, 0.3, 0.3});
    }
    outside.fuseViews(poses);
    const auto convex = outside.errorsAt(between);
    EXPECT_LT(convex.quantile(0.95), 0.01);
    EXPECT_LT(convex.wrong, 0.01);
}

TEST_P(SurfacesIn, ThinWallsAreSeenFromBothSides) {
    Scene scene = withTexture();  // a sheet and a wall of 2 cm, both thinner than a cell
    addPlane(scene, {-1., 0., 0.}, {1., 0., 0.}, {0., 0., 1.}, 0);
    addBox(scene, {0., 0., 0.}, {1., 0.02, 1.}, 0);
    MappedScene mapped(scene, GetParam());
    std::vector<Pose> poses, between;
    for (int i = 0; i < 20; ++i) {
        const double y = i % 2 == 0 ? 1.2 : -1.2, x = -0.8 + 0.08 * i;
        poses.push_back(lookAt({x, y, 0.5}, {0.3 * x, 0., 0.5}));
        between.push_back(lookAt({x + 0.05, y, 0.45}, {0.3 * x, 0., 0.5}));
    }
    mapped.fuseViews(poses);
    const auto errors = mapped.errorsAt(between);
    EXPECT_LT(std::abs(errors.mean), 0.001);
    EXPECT_LT(errors.quantile(0.9), 0.002);
    EXPECT_LT(errors.wrong, 0.01);
    EXPECT_LT(errors.missing, 0.02);
}

TEST_P(SurfacesIn, SilhouettesStayWhereTheyAre) {
    Scene scene = withTexture();  // a board before a wall
    addPlane(scene, {-3., 3., -1.}, {6., 0., 0.}, {0., 0., 3.}, 0);
    addBox(scene, {-0.4, 1., 0.1}, {0.4, 1.1, 0.9}, 0);
    MappedScene mapped(scene, GetParam());
    std::vector<Pose> poses, between;
    for (int i = 0; i < 12; ++i) {
        const double x = -0.6 + 0.1 * i;
        poses.push_back(lookAt({x, -0.4, 0.5}, {0., 1., 0.5}));
        between.push_back(lookAt({x + 0.04, -0.35, 0.5}, {0., 1., 0.5}));
    }
    mapped.fuseViews(poses);
    const auto errors = mapped.errorsAt(between);
    // The outline is 3.2 m long, at about 85 pixels a metre: half a cell of it is 6 % of the image.
    EXPECT_LT(errors.wrong, 0.03);
    EXPECT_LT(errors.missing, 0.03);
    EXPECT_LT(errors.quantile(0.9), 0.003);
}

INSTANTIATE_TEST_SUITE_P(Worlds, SurfacesIn,
                         testing::Values(Pose::Identity(), moved({0.013, 0.021, 0.037}), tilted()));

TEST(Surfaces, AreSeenAtTheFacesOfCellsIfFusionLeavesThemOut) {
    MappedScene mapped(room(), moved({0.013, 0.021, 0.037}));
    mapped.fuseViews(around(0., 24), {.surfaces = false});
    EXPECT_LT(mapped.errorsAt(around(0.1, 12)).mean, -0.01);
}

/// With the noise of a depth camera of this standard deviation at 1 m.
void fuseNoisy(MappedScene& mapped, const std::vector<Pose>& poses_c_s, const Pose& T_s_w,
               float sigma) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    View view;
    for (const Pose& T_c_s : poses_c_s) {
        mapped.mesh.render(mapped.camera, T_c_s, view);
        for (unsigned i = 0; i < view.depth.getSize(); ++i) {
            float& z = view.depth.bitmap[i];
            if (z > 0.F) z += sigma * z * z * normal(random);
        }
        fuse(mapped.map, view, mapped.camera, T_c_s * T_s_w, {.depthNoise = sigma});
    }
}

TEST(Surfaces, OfNoisyDepthAreMeans) {
    const Pose T_s_w = moved({0.013, 0.021, 0.037});
    MappedScene mapped(room(), T_s_w);
    fuseNoisy(mapped, around(0., 48), T_s_w, 0.0015F);
    const auto errors = mapped.errorsAt(around(0.1, 12));
    EXPECT_LT(std::abs(errors.mean), 0.004);
    EXPECT_LT(errors.quantile(0.9), 0.015);
    EXPECT_LT(errors.wrong, 0.01);
    EXPECT_LT(errors.missing, 0.02);
}

/// The noise spreads the points of such a floor over two layers of cells.
TEST(Surfaces, OfNoisyDepthOnTheBorderOfCellsAreMeans) {
    Scene floor = withTexture();
    addPlane(floor, {-3., -3., 0.}, {6., 0., 0.}, {0., 6., 0.}, 0);
    std::vector<Pose> poses, between;
    for (int i = 0; i < 16; ++i) {
        const Vector3d eye(0.3 * (i % 4), 0.3 * (i / 4), 1.8);
        poses.push_back(lookAt(eye, {1.5 - eye.x(), 0.5, 0.}));
        between.push_back(lookAt(eye + Vector3d(0.1, 0.1, -0.1), {1. - eye.x(), 0.4, 0.}));
    }
    using CellAndNoise = std::pair<double, float>;
    for (const auto& [edge, sigma] :
         {CellAndNoise(0.05, 0.0015F), CellAndNoise(0.025, 0.0015F), CellAndNoise(0.05, 3e-3F)}) {
        MappedScene mapped(floor, Pose::Identity(), edge);
        fuseNoisy(mapped, poses, Pose::Identity(), sigma);
        const auto errors = mapped.errorsAt(between);
        EXPECT_LT(std::abs(errors.mean), 0.7 * sigma) << edge << ' ' << sigma;
        EXPECT_LT(errors.quantile(0.9), 4. * sigma) << edge << ' ' << sigma;
        EXPECT_LT(errors.wrong, 0.01) << edge;
        EXPECT_LT(errors.missing, 0.1) << edge;  // some views show what no fused view does
    }
}

/// Rounding puts such a floor on either side of the border between two layers of cells.
TEST(Surfaces, OnTheBorderOfCellsHaveNoHoles) {
    const Camera camera = makeCamera(94, 60, 1.2);
    for (const double height : {0., 1e-6, -1e-6, 1e-5}) {
        for (const Pose& T_c_w : {test::lookDown(0.013, 0.021, 1.2, test::kDown),
                                  lookAt({-1., 0.1, 1.2}, {0.3, 0.2, 0.})}) {
            TexturedOcTree map(kEdge);
            const View floor = test::floorView(camera, T_c_w, test::carpet, height);
            fuse(map, floor, camera, T_c_w);
            View seen;
            VoxelRenderer(map, UnknownPolicy::free).render(camera, T_c_w, seen);
            std::size_t holes = 0, all = 0;
            for (unsigned i = 0; i < seen.depth.getSize(); ++i) {
                all += floor.depth.bitmap[i] > 0.F;
                holes += floor.depth.bitmap[i] > 0.F &&
                         !(std::abs(seen.depth.bitmap[i] - floor.depth.bitmap[i]) < 0.02F);
            }
            EXPECT_GT(all, 1000U);
            EXPECT_LT(holes, all / 100) << height;
        }
    }
}

TEST(Surfaces, GoWithTheirCells) {
    const Camera camera = makeCamera(64, 48, 1.);
    const Pose T_c_w = test::lookDown(0., 0., 1.2, test::kDown);
    TexturedOcTree map(kEdge);
    fuse(map, test::floorView(camera, T_c_w, test::carpet, 0.02), camera, T_c_w);
    const auto* cell = map.search(0.01, 0.01, 0.025);
    ASSERT_TRUE((*cell).surfaces[5].observed());
    EXPECT_NEAR(cell->surfaces[5].meanPoint().z(), 0.02 / kEdge - 0.5, 1e-3);
    EXPECT_NEAR(cell->surfaces[5].meanNormal().z(), 1., 1e-3);
    fuse(map, test::floorView(camera, T_c_w, test::carpet, -0.2), camera, T_c_w);
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        EXPECT_TRUE(map.isNodeOccupied(*leaf) || leaf->surfaces.empty());
    }
}

}  // namespace
}  // namespace photonav
