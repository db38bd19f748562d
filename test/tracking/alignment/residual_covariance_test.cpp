// SPDX-License-Identifier: BSD-3-Clause
// Covariances of alignments to photographs, which the model did not make.
#include "alignment/residual_covariance.hpp"

#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "alignment/keyframe_model.hpp"
#include "alignment/keyframe_points.hpp"
#include "alignment/wide_aligner.hpp"
#include "estimation/calibration.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;
using test::kOblique;
using test::room;

AlignmentOptions forPhotographs() {
    AlignmentOptions options = photographOptions();
    options.modelErrors.displacement = 0.;
    return options;
}

/// What happens to an image besides the noise that the options know of.
using Disturbance = std::function<void(ImageF& image, std::mt19937_64& random)>;

/// NEES per degree of freedom, mean over alignments without a prior.
double neesWith(const AlignmentOptions& options, const Disturbance& disturb, const Camera& camera) {
    DenseAligner aligner(room(), camera, options);
    std::mt19937_64 random(7);
    constexpr int kCount = 50;
    double sum = 0.;
    for (int i = 0; i < kCount; ++i) {
        const Pose truth = lookFrom({1.5 + 0.01 * i, 2. + 0.03 * i, 1.5}, kOblique, 0.05 * i);
        ImageF image = test::photographed(room(), camera, truth).intensity;
        disturb(image, random);
        const Pose start = expSE3(test::randomTwist(0.02, 0.01, random)) * truth;
        const Alignment a = aligner.align(image, start);
        EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
        sum += test::neesOf(a, truth) / kCount;
    }
    return sum;
}

void addNoise(ImageF& image, std::mt19937_64& random) { image = test::noisy(image, 0.03, random); }

void addLightFromTheSide(ImageF& image, std::mt19937_64& random) {
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            image[v][u] *= 0.95F + 0.1F * static_cast<float>(u) / image.getWidth();
        }
    }
    addNoise(image, random);
}

/// Whatever the images suffer from; the noise that the options assume is another one.
TEST(ResidualCovariance, IsConsistentWithoutAnAssumedNoise) {
    for (const Camera& camera : {makeCamera(94, 60, 1.2), makeCamera(188, 120, 1.2)}) {
        const double noise = neesWith(forPhotographs(), addNoise, camera);
        const double exact = neesWith(
            forPhotographs(), [](ImageF&, auto&) {}, camera);
        const double light = neesWith(forPhotographs(), addLightFromTheSide, camera);
        std::cout << "NEES per dof: noise " << noise << ", exact " << exact << ", light " << light
                  << '\n';
        EXPECT_GT(noise, 0.6);
        EXPECT_LT(noise, 1.3);
        EXPECT_GT(exact, 0.1);  // a thousandth of white is assumed at least
        EXPECT_LT(exact, 1.3);
        EXPECT_GT(light, 0.2);
        EXPECT_LT(light, 1.3);
        AlignmentOptions assumed = forPhotographs();
        assumed.measureCovariance = false;
        EXPECT_GT(neesWith(assumed, addLightFromTheSide, camera), 5.);
    }
}

/// A lens whose distortion is known to a tenth of a pixel: the residuals hardly show what it does
/// to the pose.
TEST(ResidualCovariance, DistortionOfTheLensRepeats) {
    const Camera camera = makeCamera(188, 120, 1.2);
    const Camera longer{camera.width, camera.height,
                        vpCameraParameters(1.002 * camera.fx(), 1.001 * camera.fy(),
                                           camera.cx() + 0.1, camera.cy() - 0.1)};
    AlignmentOptions options = forPhotographs();
    const auto nees = [&] {
        DenseAligner aligner(room(), camera, options);
        double sum = 0.;
        constexpr int kCount = 20;
        for (int i = 0; i < kCount; ++i) {
            const Pose truth = lookFrom({1.5 + 0.02 * i, 2. + 0.05 * i, 1.5}, kOblique, 0.1 * i);
            const View view = test::photographed(room(), longer, truth);
            const Alignment a = aligner.align(view.intensity, truth);
            sum += test::neesOf(a, truth) / kCount;
        }
        return sum;
    };
    EXPECT_GT(nees(), 3.);
    options.modelErrors.displacement = 0.1;
    EXPECT_LT(nees(), 2.5);  // 2.0; 1.8 if slopes were measured
}

/// Bars along world y, seen at an angle: they do not inform about y, however small the residuals
/// are.
TEST(ResidualCovariance, EdgesDoNotInformAlongThemselves) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 0.5, .softEdge = 0.05})));
    DenseAligner aligner(bars, makeCamera(188, 120, 1.2217), photographOptions());
    for (const double turned : {0., 0.01, 0.03, 0.1}) {
        const UncertainPose prior = test::aboveBars(turned);
        const View view = test::photographed(bars, aligner.camera(), prior.mean);
        const Alignment a = aligner.align(view.intensity, prior);
        EXPECT_EQ(describe(a), "degenerate along y");
        const Eigen::Vector3d y_c = prior.mean.linear().col(1);
        const double along = y_c.dot(a.information.topLeftCorner<3, 3>() * y_c);
        EXPECT_LT(along, 1. / (0.5 * 0.5)) << turned;  // that of the prior
    }
}

/// An edge that comes into view beside white, all that the image shows: how wide it is must not
/// tell how far away it is, since no model knows the blur of an image as exactly.
TEST(ResidualCovariance, TheWidthOfAnEdgeIsNoDistance) {
    const MeshRenderer floor(test::floorOf(stripes({.width = 10., .softEdge = 0.05})));
    const Camera camera = makeCamera(188, 120, 1.2217);
    Vector6 sigmas;
    sigmas << 0.45, 0.45, 0.3, 0.005, 0.005, 0.01;
    std::mt19937_64 random(1);
    const auto nees = [&](double blurError) {
        AlignmentOptions options = photographOptions();
        options.modelErrors.blur = blurError;
        WideAligner aligner(floor, camera, options);
        double most = 0.;
        for (int i = 0; i < 5; ++i) {
            const double z = 1.9 + 0.06 * i;
            const Pose truth = lookFrom({-0.65 * z - 0.004 * i, 0.2, z}, kDown, kDown);
            const ImageF exact = test::photographed(floor, camera, truth).intensity;
            const ImageF image = test::noisy(exact, 0.01, random);
            Vector6 off = Vector6::Zero();
            off << 0.2, -0.1, 0.1 * (i % 3 - 1), 0.001, -0.002, 0.;
            const UncertainPose prior{expSE3(off) * truth, sigmas.cwiseAbs2().asDiagonal()};
            const Alignment a = aligner.align(image, prior);
            most = std::max(most, test::neesOf(a, truth));
        }
        return most;
    };
    EXPECT_GT(nees(0.), 8.);
    EXPECT_LT(nees(photographOptions().modelErrors.blur), 2.);
}

/// A floor, and boxes of more contrast that stand elsewhere.
Scene boxesMovedBy(double moved) {
    Scene scene = test::floorOf(valueNoise(
        {.size = {20., 20.}, .cells = {0.6, 0.2}, .amplitudes = {0.04, 0.04}, .seed = 1}));
    const auto crates = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    for (int i = 0; i < 5; ++i) {
        const Eigen::Vector3d corner(0.9 * i + moved, 0.7 * (i * 3 % 5) - 1.5, 0.);
        addBox(scene, corner, corner + Eigen::Vector3d(0.4, 0.4, 0.4), crates);
    }
    return scene;
}

/// Boxes and floor disagree on the pose by more than the scatter of the residuals.
TEST(ResidualCovariance, ObjectsThatHaveMovedMakeThePoseUncertain) {
    const MeshRenderer model(boxesMovedBy(0.));
    const Camera camera = makeCamera(188, 120, 1.2);
    DenseAligner aligner(model, camera, forPhotographs());
    const auto middle = [&](double moved) {  // median NEES, and standard deviation
        const MeshRenderer world(boxesMovedBy(moved));
        std::mt19937_64 random(3);
        std::vector<double> nees, sigmas;
        for (int i = 0; i < 20; ++i) {
            const Pose truth = lookFrom({-0.6 + 0.1 * i, -1. + 0.1 * i, 1.6}, 0.8, 0.1 * i);
            const ImageF image =
                test::noisy(test::photographed(world, camera, truth).intensity, 0.01, random);
            const UncertainPose prior{
                expSE3(test::randomTwist(0.05, 0.02, random)) * truth,
                Vector6{{0.05, 0.05, 0.05, 0.02, 0.02, 0.02}}.cwiseAbs2().asDiagonal()};
            const Alignment a = aligner.align(image, prior);
            if (isLost(a.verdict)) continue;
            nees.push_back(test::neesOf(a, truth));
            sigmas.push_back(std::sqrt(a.covariance.topLeftCorner<3, 3>().trace()));
        }
        EXPECT_GT(nees.size(), 14U);
        std::sort(nees.begin(), nees.end());
        std::sort(sigmas.begin(), sigmas.end());
        return Eigen::Vector2d(nees[nees.size() / 2], sigmas[sigmas.size() / 2]);
    };
    const Eigen::Vector2d same = middle(0.), moved = middle(0.04);
    std::cout << "NEES per dof, sigma [m]: " << same.transpose() << ", moved " << moved.transpose()
              << '\n';
    EXPECT_GT(same[0], 0.2);
    EXPECT_LT(same[0], 1.5);
    EXPECT_LT(moved[0], 15.);  // 24 if only d d^T is added
    EXPECT_GT(moved[1], 5. * same[1]);
}

/// The blocks of an image add up to the whole.
TEST(ResidualCovariance, BlocksAddUp) {
    const Camera camera = makeCamera(188, 120, 1.2);
    const Pose pose = lookFrom({1.6, 3., 1.6}, kOblique, 0.1);
    const View view = test::photographed(room(), camera, pose);
    std::mt19937_64 random(3);
    const ImageF image = test::noisy(view.intensity, 0.02, random);
    const Exposure exposure{1.1, -0.02};
    const Loss loss{RobustWeight::huber, 0.02};
    const auto expectSum = [](const std::vector<ImageBlock>& blocks, const NormalEquations& all) {
        EXPECT_GT(blocks.size(), 200U);
        Matrix8 AtA = Matrix8::Zero();
        Vector8 Atr = Vector8::Zero();
        for (const ImageBlock& block : blocks) {
            AtA += block.AtA;
            Atr += block.Atr;
        }
        EXPECT_LT((AtA - all.AtA).norm(), 1e-5 * all.AtA.norm());
        EXPECT_LT((Atr - all.Atr).norm(), 1e-4 * all.Atr.norm());
    };
    ViewComparison compare(camera, {});
    const NormalEquations all = compare(view, image, exposure, loss);
    expectSum(compare.blocks(exposure, loss), all);
    KeyframeOptions options;
    options.minGradient = 0.;
    PointSet points(view, camera, options);
    const Pose moved = expSE3(0.01 * Vector6::Ones());
    const NormalEquations ofPoints = points.compare(image, moved, exposure, loss);
    expectSum(points.blocks(image, moved, exposure, loss), ofPoints);
}

/// How far a displacement of the content reaches is a matter of the image, not of the part in use:
/// a block without a pixel changes nothing.
TEST(ResidualCovariance, AnUnusedHalfOfTheImageLeavesTheFieldsAsTheyAre) {
    const Camera camera = makeCamera(188, 120, 1.2);
    const View view = test::photographed(room(), camera, lookFrom({1.6, 3., 1.6}, kOblique, 0.1));
    std::mt19937_64 random(3);
    ViewComparison compare(camera, {});
    compare(view, test::noisy(view.intensity, 0.02, random), {}, {});
    std::vector<ImageBlock> blocks = compare.blocks({}, {});
    std::erase_if(blocks, [](const ImageBlock& block) { return (block.index > 8).any(); });
    const auto repeating = [&] {
        return measuredInformation({blocks, camera, {}}, {}, {}, {}, Pose::Identity()).repeating;
    };
    const Matrix6 withoutCorner = repeating();
    blocks.emplace_back().index = {23, 14};
    EXPECT_LT((repeating() - withoutCorner).norm(), 1e-6 * withoutCorner.norm());
}

/// A poster of 20 cm on white: the residuals of its few blocks span less than six dimensions.
TEST(ResidualCovariance, FewBlocksDoNotMakeItSingular) {
    const Camera camera = makeCamera(94, 60, 1.2);
    const Pose truth = lookFrom({0., 0., 1.5}, kDown, 0.1);
    AlignmentOptions options = forPhotographs();
    options.trust.minOverlap = 0.;
    for (const double corner : {-0.1, 0.}) {
        Scene scene = test::floorOf(uniformTexture(0.9F));
        const auto poster = addTexture(
            scene, valueNoise({.size = {0.2, 0.2}, .amplitudes = {0.2, 0.2, 0.1}, .seed = 3}));
        addPlane(scene, {corner, corner, 0.01}, {0.2, 0., 0.}, {0., 0.2, 0.}, poster);
        const MeshRenderer world(std::move(scene));
        DenseAligner aligner(world, camera, options);
        const ImageF image = test::photographed(world, camera, truth).intensity;
        std::mt19937_64 random(7);
        double nees = 0.;
        for (int i = 0; i < 20; ++i) {
            const UncertainPose prior{truth, 0.01 * Matrix6::Identity()};
            const Alignment a = aligner.align(test::noisy(image, 0.03, random), prior);
            nees += test::neesOf(a, truth) / 20.;
        }
        EXPECT_LT(nees, 2.) << corner;
    }
}

/// A prior of standard deviations `sigma` whose mean is wrong by a share of them.
UncertainPose priorBeside(const Pose& truth, const Vector6& sigma, double share,
                          std::normal_distribution<double>& normal, std::mt19937_64& random) {
    const Vector6 error = sigma.unaryExpr([&](double s) { return share * s * normal(random); });
    return {expSE3(error) * truth, Matrix6(sigma.cwiseAbs2().asDiagonal())};
}

/// A white wall fills the view. Beyond its end, just outside of the view, the corner of a grey
/// floor may be seen from poses within the prior: a few pixels that fit exactly once they are out
/// of view.
TEST(ResidualCovariance, ACornerAtTheBorderDoesNotDetermineThePose) {
    Scene scene = test::floorOf(uniformTexture(0.6F));
    const auto white = addTexture(scene, uniformTexture(0.85F));
    addBox(scene, {2.5, 1.5, 0.}, {3.3, 4.5, 2.8}, white);
    addPlane(scene, {0., 6., 0.}, {7., 0., 0.}, {0., 0., 5.}, white);
    const MeshRenderer world(std::move(scene));
    const Camera camera = makeCamera(160, 120, 1.22);
    WideAligner aligner(world, camera, forPhotographs());
    Vector6 sigma;
    sigma << 0.05, 0.03, 0.05, 0.01, 0.04, 0.01;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (const double yaw : {0.52, 0.55, 0.58}) {
        const Pose truth = lookFrom({1.5, 1.7, 1.1}, 0., yaw);
        const ImageF image = test::photographed(world, camera, truth).intensity;
        double nees = 0.;
        for (int i = 0; i < 30; ++i) {
            const UncertainPose prior = priorBeside(truth, sigma, 1., normal, random);
            const Alignment a = aligner.align(test::noisy(image, 0.03, random), prior);
            nees += test::neesOf(a, truth) / 30.;
        }
        std::cout << "NEES per dof, yaw " << yaw << ": " << nees << '\n';
        EXPECT_LT(nees, 2.) << yaw;
    }
}

/// Texture on a small carpet only: in some direction one block says more than all others together,
/// but its residuals still contain its error.
TEST(ResidualCovariance, ASmallObjectDeterminesThePose) {
    Scene scene = test::floorOf(uniformTexture(0.6F));
    addPlane(scene, {-0.15, -0.1, 0.01}, {0.3, 0., 0.}, {0., 0.3, 0.},
             addTexture(scene, valueNoise({.size = {0.3, 0.3},
                                           .cells = {0.1, 0.05},
                                           .amplitudes = {0.2, 0.2},
                                           .seed = 4})));
    const MeshRenderer world(std::move(scene));
    const Camera camera = makeCamera(188, 120, 1.22);
    DenseAligner aligner(world, camera, forPhotographs());
    Vector6 sigma;
    sigma << 0.05, 0.05, 0.05, 0.03, 0.03, 0.03;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    double nees = 0., within = 0.;
    constexpr int kImages = 40;
    for (int i = 0; i < kImages; ++i) {
        const double x = 0.2 * normal(random), y = 0.2 * normal(random), yaw = normal(random);
        const Pose truth = lookFrom({x, y, 1.4}, test::kDown, yaw);
        const ImageF image = test::photographed(world, camera, truth).intensity;
        // The object is 20 pixels wide: farther off, the alignment would not find it.
        const UncertainPose prior = priorBeside(truth, sigma, 0.3, normal, random);
        const Alignment a = aligner.align(test::noisy(image, 0.01, random), prior);
        nees += test::neesOf(a, truth) / kImages;
        const Matrix6 unit = sigma.cwiseInverse().asDiagonal();
        const auto ratios = Eigen::SelfAdjointEigenSolver<Matrix6>(unit * a.covariance * unit);
        within += std::sqrt(ratios.eigenvalues().maxCoeff()) / kImages;
    }
    std::cout << "NEES per dof " << nees << ", largest sigma " << within << " of the prior's\n";
    EXPECT_LT(nees, 1.);
    EXPECT_LT(within, 0.6);
}

TEST(ResidualCovariance, RepeatingErrorsDoNotAverageOut) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    Matrix6 root;
    for (double& value : root.reshaped()) value = 0.01 * normal(random);
    const Matrix6 repeating = root * root.transpose();
    const Matrix6 information = (repeating + 1e-6 * Matrix6::Identity()).inverse();
    Matrix6 belief = 0.01 * Matrix6::Identity();
    for (int image = 0; image < 50; ++image) {
        belief = posteriorCovariance(belief, information, repeating);
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(
        belief, repeating + 1e-9 * Matrix6::Identity());
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0.9);
    EXPECT_LT(solver.eigenvalues().maxCoeff(), 1.5);
    // A belief that is narrower already stays so.
    const Matrix6 narrow = 1e-8 * Matrix6::Identity();
    const Matrix6 after = posteriorCovariance(narrow, information, repeating);
    EXPECT_LT((after - narrow).norm(), 0.1 * narrow.norm());
    // Without such errors it is the filter's update.
    const Matrix6 prior = 0.01 * Matrix6::Identity();
    EXPECT_TRUE(posteriorCovariance(prior, information, Matrix6::Zero())
                    .isApprox(updateCovariance(prior, information)));
}

TEST(ResidualCovariance, TakesTheSmallerOrLargerVarianceAlongSharedAxes) {
    const Vector6 a = (Vector6() << 1., 2., 3., 4., 5., 6.).finished();
    const Vector6 b = Vector6::Constant(3.5);
    EXPECT_TRUE(
        smaller(a.asDiagonal(), b.asDiagonal()).isApprox(Matrix6(a.cwiseMin(b).asDiagonal())));
    EXPECT_TRUE(
        larger(a.asDiagonal(), b.asDiagonal()).isApprox(Matrix6(a.cwiseMax(b).asDiagonal())));
}

/// A surface that is off by 2 cm along its normal moves the pose by as much.
TEST(ResidualCovariance, ErrorsOfSurfacesAreErrorsOfThePose) {
    const MeshRenderer floor(test::floorOf(valueNoise({.seed = 4})));
    AlignmentOptions options = forPhotographs();
    const Pose truth = lookFrom({0., 0., 2.}, kDown);
    const Camera camera = makeCamera(94, 60, 1.2);
    const ImageF image = test::photographed(floor, camera, truth).intensity;
    const auto height = [&] {
        DenseAligner aligner(floor, camera, options);
        return std::sqrt(aligner.align(image, truth).covariance(2, 2));
    };
    EXPECT_LT(height(), 0.002);
    options.modelErrors.surface = 0.02;
    EXPECT_NEAR(height(), 0.02, 0.002);
}

}  // namespace
}  // namespace photonav
