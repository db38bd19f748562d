// SPDX-License-Identifier: BSD-3-Clause
#include "render/mesh_renderer.hpp"
#include "core/photometry/synthetic_floor.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <thread>

#include "geometry/constants.hpp"
#include "render/mip_texture.hpp"

namespace photonav {
namespace {

/// A room of 6 x 6 m with boxes, a few of them small.
Scene clutter(int boxes) {
    Scene scene;
    const auto texture = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {0., 0., 0.}, {6., 6., 3.}, texture, BoxInside::hollow);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0.2, 5.5);
    std::uniform_real_distribution<double> size(0.03, 0.6);
    for (int i = 0; i < boxes; ++i) {
        const Eigen::Vector3d corner(place(random), place(random), 0.3 * place(random));
        addBox(scene, corner, corner + Eigen::Vector3d(size(random), size(random), size(random)),
               texture);
    }
    return scene;
}

struct Hit {
    double depth = 0.;
    double margin = 1.;  ///< smallest |barycentric coordinate| that decided any triangle
};

/// Tries every triangle (Moeller and Trumbore 1997) in double precision.
Hit firstHit(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    Hit hit;
    for (const Triangle& triangle : scene.triangles) {
        const Eigen::Vector3d corner = triangle.corners[0].cast<double>();
        const Eigen::Vector3d a = triangle.corners[1].cast<double>() - corner;
        const Eigen::Vector3d b = triangle.corners[2].cast<double>() - corner;
        const double determinant = a.dot(ray.cross(b));
        if (determinant == 0.) continue;
        const Eigen::Vector3d s = origin - corner;
        const double u = s.dot(ray.cross(b)) / determinant;
        const double v = ray.dot(s.cross(a)) / determinant;
        const double t = b.dot(s.cross(a)) / determinant;
        const double inside = std::min({u, v, 1. - u - v});
        if (t <= 0.) continue;
        hit.margin = std::min(hit.margin, std::abs(inside));
        if (inside >= 0. && (hit.depth == 0. || t < hit.depth)) hit.depth = t;
    }
    return hit;
}

/// @return pixels compared
int compareWithBruteForce(const Scene& scene, const MeshRenderer& renderer, const Camera& camera,
                          const Pose& T_c_w) {
    View view;
    renderer.render(camera, T_c_w, view);
    const Pose T_w_c = T_c_w.inverse();
    int compared = 0;
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(),
                                      (v - camera.cy()) / camera.fy(), 1.);
            const Hit hit = firstHit(scene, T_w_c.translation(), T_w_c.linear() * ray);
            if (hit.margin < 1e-4) continue;  // through an edge: either side is right
            ++compared;
            EXPECT_NEAR(view.depth[v][u], hit.depth, 1e-5 * hit.depth) << u << " " << v;
        }
    }
    return compared;
}

TEST(MeshRenderer, DepthAgreesWithTryingEveryTriangle) {
    const Scene scene = clutter(30);
    const MeshRenderer renderer(scene);
    // Many pixels per triangle are rasterized, few are ray-cast: both sides of the choice.
    for (const unsigned width : {61U, 37U}) {
        const Camera camera = makeCamera(width, width * 2 / 3, 1.4);
        int compared = 0;
        for (const double belowHorizon : {std::numbers::pi / 2., std::numbers::pi / 4., 0.1}) {
            for (const double yaw : {0.3, 2., 4.}) {
                compared += compareWithBruteForce(scene, renderer, camera,
                                                  lookFrom({3., 2.7, 2.2}, belowHorizon, yaw));
            }
        }
        EXPECT_GT(compared, 9 * static_cast<int>(camera.width * camera.height) * 97 / 100);
    }
}

TEST(MeshRenderer, NoPixelSlipsBetweenNeighbours) {
    // A fan of slivers around the camera's foot, so that rays meet edges and corners exactly.
    Scene scene;
    const auto texture = addTexture(scene, uniformTexture(0.5));
    constexpr int kSectors = 64;
    const auto rim = [](int i) -> Eigen::Vector3f {
        const double angle = 2. * std::numbers::pi * i / kSectors;
        return {static_cast<float>(9. * std::cos(angle)), static_cast<float>(9. * std::sin(angle)),
                0.F};
    };
    for (int i = 0; i < kSectors; ++i) {
        Triangle sliver;
        sliver.corners = {Eigen::Vector3f::Zero(), rim(i), rim((i + 1) % kSectors)};
        sliver.texture = texture;
        scene.triangles.push_back(sliver);
    }
    const MeshRenderer renderer(scene);
    View view;
    for (const unsigned width : {61U, 13U}) {
        for (const double x : {0., 0.1, 1.}) {
            const Camera camera = makeCamera(width, width, 1.2);
            renderer.render(camera, lookFrom({x, 0., 2.}, std::numbers::pi / 2.), view);
            for (unsigned i = 0; i < view.depth.getSize(); ++i) {
                ASSERT_NEAR(view.depth.bitmap[i], 2., 1e-5) << i;
            }
        }
    }
}

TEST(MeshRenderer, NoSurfaceIsDepthZero) {
    Scene scene;
    addPlane(scene, {0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.},
             addTexture(scene, uniformTexture(0.5)));
    const MeshRenderer renderer(scene);
    View view;
    renderer.render(makeCamera(40, 30, 1.), lookFrom({0.5, 0.5, 1.}, -std::numbers::pi / 2.), view);
    EXPECT_EQ(test::pixels(view.depth), std::vector<float>(1200, 0.F));
    EXPECT_EQ(test::pixels(view.intensity), std::vector<float>(1200, 0.F));
}

TEST(MeshRenderer, UniformSurfacesAreUniformToTheBit) {
    Scene scene;
    const Texture white = uniformTexture(0.9);
    const Texture noise = valueNoise({.size = {4., 4.}});
    const auto half = addTexture(
        scene, patchedTexture(white, {{{10., 0.}, {20., 20.}, &noise}}, {20., 20.}, 0.02));
    addPlane(scene, {0., 0., 0.}, {20., 0., 0.}, {0., 20., 0.}, half);
    const MeshRenderer renderer(scene);
    View view;
    renderer.render(makeCamera(188, 120, 1.2), lookFrom({5., 10., 2.}, 1.4, 0.3), view);
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
        ASSERT_EQ(view.intensity.bitmap[i], view.intensity.bitmap[0]);
    }
    EXPECT_NEAR(view.intensity.bitmap[0], 0.9, 1e-5);
}

/// The floor's texture averaged over each pixel's footprint by many samples.
ImageF supersampled(const Texture& texture, const Camera& camera, const Pose& T_c_w) {
    constexpr int kSamples = 12;
    const Pose T_w_c = T_c_w.inverse();
    ImageF image(camera.height, camera.width, 0.F);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            double sum = 0.;
            for (int k = 0; k < kSamples * kSamples; ++k) {
                const double du = (k % kSamples + 0.5) / kSamples - 0.5;
                const double dv = (k / kSamples + 0.5) / kSamples - 0.5;
                const Eigen::Vector3d ray =
                    T_w_c.linear() * Eigen::Vector3d((u + du - camera.cx()) / camera.fx(),
                                                     (v + dv - camera.cy()) / camera.fy(), 1.);
                const Eigen::Vector3d p =
                    T_w_c.translation() - T_w_c.translation().z() / ray.z() * ray;
                sum += texture.at(p.head<2>());
            }
            image[v][u] = static_cast<float>(sum / (kSamples * kSamples));
        }
    }
    return image;
}

struct Comparison {
    double contrast = 0.;  ///< root mean square of the true image about its mean
    double error = 0.;     ///< root mean square difference
};

Comparison compareWithSupersampling(const Texture& texture, const Pose& T_c_w) {
    Scene scene;
    addPlane(scene, {0., 0., 0.}, {40., 0., 0.}, {0., 40., 0.}, addTexture(scene, texture));
    const Camera camera = makeCamera(94, 60, 70. * std::numbers::pi / 180.);
    View view, truth;
    MeshRenderer(scene).render(camera, T_c_w, view);
    truth.intensity = supersampled(texture, camera, T_c_w);
    truth.depth = view.depth;
    applyPointSpread(truth);
    const unsigned n = camera.width * camera.height;
    double mean = 0.;
    for (unsigned i = 0; i < n; ++i) mean += truth.intensity.bitmap[i] / n;
    Comparison result;
    for (unsigned i = 0; i < n; ++i) {
        const double t = truth.intensity.bitmap[i];
        result.contrast += (t - mean) * (t - mean) / n;
        result.error += std::pow(view.intensity.bitmap[i] - t, 2) / n;
    }
    return {std::sqrt(result.contrast), std::sqrt(result.error)};
}

TEST(MeshRenderer, FineTextureIsIntegratedOverPixels) {
    // At 1 m a pixel of this camera covers 1.5 cm, as the default one does at 2 m.
    const Texture fine = valueNoise({.size = {5., 5.}, .cells = {0.1, 0.03}, .seed = 2});
    for (const double height : {0.5, 1., 1.5, 3.}) {
        const auto down = compareWithSupersampling(
            fine, lookFrom({20.3, 20.1, height}, std::numbers::pi / 2., 0.4));
        EXPECT_LT(down.error, 0.08 * down.contrast) << height << " m, contrast " << down.contrast;
        const auto oblique = compareWithSupersampling(
            fine, lookFrom({20.3, 20.1, height}, std::numbers::pi / 4., 0.4));
        EXPECT_LT(oblique.error, 0.15 * oblique.contrast)
            << height << " m, contrast " << oblique.contrast;
    }
}

TEST(MeshRenderer, LevelsOfDetailChangeWithoutSteps) {
    Scene scene;
    const auto texture =
        addTexture(scene, valueNoise({.size = {5., 5.}, .cells = {0.1, 0.03}, .seed = 2}));
    addPlane(scene, {0., 0., 0.}, {40., 0., 0.}, {0., 40., 0.}, texture);
    const MeshRenderer renderer(scene);
    const Camera camera = makeCamera(47, 30, 70. * std::numbers::pi / 180.);
    View before, view;
    renderer.render(camera, lookFrom({20.3, 20.1, 0.5}, std::numbers::pi / 4.), before);
    float largest = 0.F;
    for (double height = 0.5; height < 4.; height *= 1.0002) {
        renderer.render(camera, lookFrom({20.3, 20.1, height}, std::numbers::pi / 4.), view);
        for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
            largest =
                std::max(largest, std::abs(view.intensity.bitmap[i] - before.intensity.bitmap[i]));
        }
        before = view;
    }
    EXPECT_LT(largest, 0.01F);
}

TEST(MeshRenderer, TheSamePoseGivesTheSameBitsInAnyThread) {
    const MeshRenderer renderer(clutter(20));
    const Camera camera = makeCamera(94, 60, 1.2);
    const Pose T_c_w = lookFrom({3., 2.7, 2.2}, std::numbers::pi / 4., 0.3);
    View expected;
    renderer.render(camera, T_c_w, expected);
    std::vector<View> views(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < views.size(); ++i) {
        threads.emplace_back([&, i] {
            View other;
            renderer.render(camera, lookFrom({2., 2., 1.}, 0.5, 0.1 * i), other);
            renderer.render(camera, T_c_w, views[i]);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const View& view : views) {
        EXPECT_EQ(test::pixels(view.intensity), test::pixels(expected.intensity));
        EXPECT_EQ(test::pixels(view.depth), test::pixels(expected.depth));
    }
}

/// A white floor with a noisy area.
Texture whiteWithNoise(unsigned size) {
    Texture texture;
    texture.image = ImageF(size, size, 0.9F);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> grey(0.F, 1.F);
    for (unsigned v = size / 3; v < size / 2; ++v) {
        for (unsigned u = size / 4; u < size / 2; ++u) texture.image[v][u] = grey(random);
    }
    return texture;
}

TEST(MipTexture, KnowsWhereItIsUniform) {
    constexpr unsigned kSize = 150;
    const ImageF image = whiteWithNoise(kSize).image;
    const MipTexture texture(image);
    EXPECT_TRUE(texture.hasUniformTiles());
    EXPECT_FALSE(texture.uniform());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-500., 500.), width(0., 60.);
    int uniform = 0;
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Array2d low(place(random), place(random));
        const Eigen::Array2d high = low + Eigen::Array2d(width(random), width(random));
        const auto texel = texture.uniformWithin(low, high);
        if (!texel) continue;
        ++uniform;
        EXPECT_EQ(*texel, std::lrint(0.9F * MipTexture::kOne));
        for (double v = std::floor(low.y()); v <= high.y(); ++v) {
            for (double u = std::floor(low.x()); u <= high.x(); ++u) {
                const auto column = static_cast<unsigned>(u - kSize * std::floor(u / kSize));
                const auto row = static_cast<unsigned>(v - kSize * std::floor(v / kSize));
                ASSERT_EQ(image[row][column], 0.9F) << u << ", " << v;
            }
        }
    }
    EXPECT_GT(uniform, 3000);
    EXPECT_FALSE(texture.uniformWithin({-kInfinity, 0.}, {kInfinity, 1.}));
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(texture.uniformWithin({none, 0.}, {none, 1.}));
    EXPECT_FALSE(MipTexture(valueNoise({.size = {1., 1.}, .seed = 3}).image).hasUniformTiles());
}

/// A texture that is uniform nowhere, by the least grey value that is stored, looks the same.
TEST(MeshRenderer, UniformPartsOfATextureAreNoShortCut) {
    const auto floorOf = [](const Texture& texture) {
        Scene scene;
        const auto index = addTexture(scene, texture);
        addPlane(scene, {-4., -4., 0.}, {16., 0., 0.}, {0., 16., 0.}, index);
        return scene;
    };
    Texture plain = whiteWithNoise(1000);
    plain.size = {16., 16.};
    Texture marked = plain;
    for (unsigned v = 0; v < 1000; v += 8) {
        for (unsigned u = 0; u < 1000; u += 8) marked.image[v][u] += 2.F / MipTexture::kOne;
    }
    const MeshRenderer fast(floorOf(plain)), slow(floorOf(marked));
    const Camera camera = makeCamera(188, 120, 1.2);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(0., 8.), height(0.2, 3.), angle(-3., 3.);
    View a, b;
    for (int i = 0; i < 200; ++i) {
        const Pose T_c_w = lookFrom({place(random), place(random), height(random)},
                                    0.15 + 0.45 * std::abs(angle(random)), angle(random));
        fast.render(camera, T_c_w, a);
        slow.render(camera, T_c_w, b);
        for (unsigned k = 0; k < a.depth.getSize(); ++k) {
            ASSERT_EQ(a.depth.bitmap[k], b.depth.bitmap[k]);
            ASSERT_NEAR(a.intensity.bitmap[k], b.intensity.bitmap[k], 3.F / MipTexture::kOne)
                << "view " << i << ", pixel " << k;
        }
    }
}

}  // namespace
}  // namespace photonav
