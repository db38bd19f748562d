// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/shared_gradients.hpp"

#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "map/map_fusion.hpp"
#include "render/voxel_renderer.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kSigma = 0.02;

const Camera& tileCamera() {
    static const Camera small = makeCamera(188, 120, 1.2);
    return small;
}

View viewOf(const ViewSource& source, const Pose& T_c_w) {
    View view;
    source.render(tileCamera(), T_c_w, view);
    return view;
}

/// What a comparison of two images knows of the pose.
struct Compared {
    Matrix6 information, slope;

    Compared(const View& model, const ImageF& observed, const Exposure& exposure = {}) {
        ViewComparison compare(tileCamera(), {});
        information = compare(model, observed, exposure, {}).AtA.topLeftCorner<6, 6>();
        slope = sharedSlope(compare.tiles(exposure)).slope;
    }
    /// Share of the information along a direction that is left.
    double leftAlong(const Vector6& xi) const {
        const Vector6 response = slope * xi;
        return response.dot(information * response) / xi.dot(information * xi);
    }
    double least() const {
        double share = kInfinity;
        for (int axis = 0; axis < 6; ++axis)
            share = std::min(share, leftAlong(Vector6::Unit(axis)));
        return share;
    }
    double most() const {
        double share = 0.;
        for (int axis = 0; axis < 6; ++axis)
            share = std::max(share, leftAlong(Vector6::Unit(axis)));
        return share;
    }
};

const Pose kInRoom = lookFrom({2., 3., 1.5}, 0.5);

View blank() {
    View view = viewOf(test::room(), kInRoom);
    view.intensity = ImageF(tileCamera().height, tileCamera().width, 0.5F);
    return view;
}

View withNoise(View view, double sigma, std::mt19937_64& random) {
    view.intensity = test::noisy(view.intensity, sigma, random);
    return view;
}

TEST(SharedGradients, NoiseIsNotShared) {
    std::mt19937_64 random(1);
    for (const double sigma : {0.005, 0.05}) {
        const ImageF observed = test::noisy(blank().intensity, kSigma, random);
        EXPECT_LT(Compared(withNoise(blank(), sigma, random), observed).most(), 1e-2);
    }
    // The same noise in both cannot be told from texture: maps and images must not share it.
    const View same = withNoise(blank(), kSigma, random);
    EXPECT_GT(Compared(same, same.intensity).least(), 0.99);
}

std::optional<SharedTexture> textureSharedBy(const View& model, const ImageF& observed,
                                             bool isModelNoisy) {
    ViewComparison compare(tileCamera(), {});
    compare(model, observed, {}, {});
    return sharedTexture(compare.tiles({}), kSigma, isModelNoisy);
}

TEST(SharedTexture, IsAllOfTheSamePlaceAndNothingOfAnother) {
    std::mt19937_64 random(1);
    for (const bool isModelNoisy : {false, true}) {
        const View here = viewOf(test::room(), kInRoom);
        const View elsewhere = viewOf(test::room(), lookFrom({4., 3., 1.5}, 0.5, 2.));
        const SharedTexture same =
            *textureSharedBy(here, test::noisy(here.intensity, kSigma, random), isModelNoisy);
        EXPECT_NEAR(same.share, 1., 3. * same.sigma);
        EXPECT_LT(same.sigma, 0.02);
        const SharedTexture other =
            *textureSharedBy(here, test::noisy(elsewhere.intensity, kSigma, random), isModelNoisy);
        EXPECT_NEAR(other.share, 0., 3. * other.sigma);
        EXPECT_LT(other.sigma, 0.05);
    }
}

TEST(SharedTexture, OfAFaintTextureIsKnownByManyPixels) {
    const MeshRenderer faint(test::floorOf(valueNoise(
        {.size = {20., 20.}, .cells = {0.2}, .amplitudes = {0.01}, .mean = 0.5, .seed = 3})));
    std::mt19937_64 random(2);
    const View here = viewOf(faint, lookFrom({0., 0., 1.}, test::kDown));
    const View elsewhere = viewOf(faint, lookFrom({2., 1., 1.}, test::kDown));
    EXPECT_TRUE(
        textureSharedBy(here, test::noisy(here.intensity, 0.01, random), false)->isAbove(0.5));
    EXPECT_TRUE(
        textureSharedBy(here, test::noisy(elsewhere.intensity, 0.01, random), false)->isBelow(0.5));
}

TEST(SharedTexture, OfNoiseIsNotKnown) {
    std::mt19937_64 random(3);
    const ImageF observed = test::noisy(blank().intensity, kSigma, random);
    for (const double sigma : {0.5 * kSigma, kSigma}) {
        const View noise = withNoise(blank(), sigma, random);
        EXPECT_TRUE(textureSharedBy(noise, observed, false)->isBelow(0.5)) << "an exact model";
        EXPECT_FALSE(textureSharedBy(noise, observed, true)) << sigma;
    }
    EXPECT_FALSE(textureSharedBy(blank(), observed, false)) << "no texture at all";
}

TEST(SharedTexture, OfASingleTileIsNotKnown) {
    View view = blank();
    for (unsigned v = 20; v < 23; ++v) view.intensity[v][20] = 0.8F;
    EXPECT_FALSE(textureSharedBy(view, blank().intensity, false));
}

/// With information A = T + N of texture and noise, A M is T, and T A^-1 T is left.
TEST(SharedGradients, TextureRespondsAsWithoutNoise) {
    std::mt19937_64 random(1);
    const View clean = viewOf(test::room(), kInRoom);
    const View model = withNoise(clean, 0.01, random);
    const Compared noisy(model, test::noisy(clean.intensity, kSigma, random));
    const Matrix6 texture = Compared(clean, clean.intensity).information;
    const Matrix6 found = noisy.information * noisy.slope;
    for (int axis = 0; axis < 6; ++axis) {
        EXPECT_GT(noisy.information(axis, axis), 1.05 * texture(axis, axis));
        EXPECT_NEAR(found(axis, axis), texture(axis, axis), 0.05 * texture(axis, axis));
    }
}

/// Half the contrast is half the response, unless it is that of the exposure; more than the model's
/// is no more information.
TEST(SharedGradients, AreTheSlopeOfTheImage) {
    const View model = viewOf(test::room(), kInRoom);
    const auto slopeAt = [&](float contrast, double gain = 1.) {
        ImageF observed = model.intensity;
        for (unsigned i = 0; i < observed.getSize(); ++i) observed.bitmap[i] *= contrast;
        return Compared(model, observed, {gain, 0.}).slope;
    };
    EXPECT_LT((slopeAt(0.5F) - 0.5 * Matrix6::Identity()).norm(), 1e-3);
    EXPECT_LT((slopeAt(2.F) - Matrix6::Identity()).norm(), 1e-6);
    EXPECT_TRUE(slopeAt(-1.F).isZero(0.));
    EXPECT_LT((slopeAt(0.5F, 0.5) - Matrix6::Identity()).norm(), 1e-3);
}

/// Texture in a part of the view says nothing of the noise in another: bars that run along y on one
/// side, and on the other nothing but noise, of which a mean over the view would be far too small.
TEST(SharedGradients, NoiseBesideTextureIsNoTexture) {
    std::mt19937_64 random(1);
    View model = viewOf(MeshRenderer(test::floorOf(uniformTexture(0.5))),
                        lookFrom({0., 0., 2.}, test::kDown));
    const unsigned half = tileCamera().width / 2;
    for (unsigned v = 0; v < tileCamera().height; ++v) {
        for (unsigned u = 0; u < half; ++u) {
            model.intensity[v][u] = 0.5F + 0.3F * std::sin(0.4F * static_cast<float>(u));
        }
    }
    const ImageF observed = test::noisy(model.intensity, kSigma, random);
    const ImageF strong = test::noisy(model.intensity, 0.04, random);
    for (unsigned v = 0; v < tileCamera().height; ++v) {
        for (unsigned u = half; u < tileCamera().width; ++u) model.intensity[v][u] = strong[v][u];
    }
    const Compared compared(model, observed);
    EXPECT_GT(compared.leftAlong(Vector6::Unit(0)), 0.8);
    EXPECT_LT(compared.leftAlong(Vector6::Unit(1)), 1e-2);
}

/// Maps of cells that are made of `images` noisy images, and alignments to them.
class MapOfFewImages : public ::testing::TestWithParam<int> {
  protected:
    static constexpr int kMaps = 12;

    struct Result {
        double nees = 0.;  ///< mean, per degree of freedom
        double open = 0.;  ///< directions, mean
        double millimetres = 0.;
    };

    Result alignIn(const Scene& scene, const AlignmentOptions& options) {
        const MeshRenderer world(scene);
        Result result;
        for (int i = 0; i < kMaps; ++i) {
            const Pose near = lookFrom({0.2 * i, 0., 1.4}, test::kOblique, 0.5 * i);
            const TexturedOcTree map = mapAround(world, near);
            const VoxelRenderer views(map, UnknownPolicy::free);
            const Pose truth = expSE3(drawn(0.3)) * near;
            const UncertainPose prior{expSE3(sigmas_.cwiseProduct(gauss())) * truth,
                                      sigmas_.cwiseAbs2().asDiagonal()};
            const ImageF image = test::noisy(viewOf(world, truth).intensity, kSigma, random_);
            const Alignment a = DenseAligner(views, tileCamera(), options).align(image, prior);
            const Vector6 e = test::errorOf(a, truth);
            result.nees += test::neesOf(a, truth) / kMaps;
            result.open += double(a.openDirections.size()) / kMaps;
            result.millimetres += 1e3 * e.head<3>().norm() / kMaps;
        }
        return result;
    }

  private:
    Vector6 gauss() {
        std::normal_distribution<double> normal;
        return Vector6::NullaryExpr([&] { return normal(random_); });
    }
    Vector6 drawn(double share) { return 10. * share * sigmas_.cwiseProduct(gauss()); }

    TexturedOcTree mapAround(const ViewSource& world, const Pose& near) {
        TexturedOcTree map(0.05);
        for (int k = 0; k < GetParam(); ++k) {
            const Pose T_c_w = expSE3(drawn(1.)) * near;
            fuse(map, withNoise(viewOf(world, T_c_w), kSigma, random_), tileCamera(), T_c_w);
        }
        return map;
    }

    Vector6 sigmas_{{0.01, 0.01, 0.01, 0.005, 0.005, 0.005}};
    std::mt19937_64 random_{5};
};

AlignmentOptions optionsInMap() {
    AlignmentOptions options;
    options.measureCovariance = true;
    options.modelNoise = ModelNoise::inPose;
    options.modelErrors.surface = 0.005;
    return options;
}

/// The noise that the first images left determines nothing.
TEST_P(MapOfFewImages, OfAUniformSurfaceIsDegenerate) {
    const Result result = alignIn(test::floorOf(uniformTexture(0.55)), optionsInMap());
    EXPECT_GT(result.open, 5.);
    EXPECT_GT(result.nees, 0.5);
    EXPECT_LT(result.nees, 2.);
}

/// As in replays. Their poses follow the noise, so that errors may be larger than without the
/// image.
TEST_P(MapOfFewImages, OfAUniformSurfaceIsDegenerateByTheCovarianceAlone) {
    AlignmentOptions options = optionsInMap();
    options.modelNoise = ModelNoise::inCovariance;
    const Result result = alignIn(test::floorOf(uniformTexture(0.55)), options);
    EXPECT_GT(result.open, 5.);
}

TEST_P(MapOfFewImages, OfFaintTextureIsConsistent) {
    const Texture faint = valueNoise({.size = {20., 20.},
                                      .cells = {0.5, 0.2},
                                      .amplitudes = {0.01, 0.008},
                                      .mean = 0.5,
                                      .seed = 3});
    const Result result = alignIn(test::floorOf(faint), optionsInMap());
    EXPECT_GT(result.nees, 0.5);
    EXPECT_LT(result.nees, 2.);
}

TEST_P(MapOfFewImages, OfTextureInformsAsMuchAsBefore) {
    const Scene rich = test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    AlignmentOptions believing = optionsInMap();
    believing.modelNoise = ModelNoise::none;
    const Result before = alignIn(rich, believing);
    const Result result = alignIn(rich, optionsInMap());
    EXPECT_LT(result.millimetres, 1.3 * before.millimetres);
    EXPECT_LT(result.nees, 2.);
    EXPECT_LT(result.open, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Images, MapOfFewImages, ::testing::Values(1, 4));

}  // namespace
}  // namespace photonav
