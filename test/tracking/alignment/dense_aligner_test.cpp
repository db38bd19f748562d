// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/dense_aligner.hpp"

#include <gtest/gtest.h>

#include "tracking/alignment/room_images.hpp"

namespace photonav {
namespace {

using test::camera;
using test::errorOf;
using test::kDown;
using test::kOblique;
using test::kPose;
using test::observe;
using test::room;

TEST(DenseAligner, FindsTheExactPoseWithoutNoise) {
    DenseAligner aligner(room(), camera());
    std::mt19937_64 random(1);
    for (int i = 0; i < 5; ++i) {
        const Pose start = expSE3(test::randomTwist(0.06, 0.04, random)) * kPose;
        const Alignment a = aligner.align(observe(room(), kPose), start);
        EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
        EXPECT_LT(errorOf(a, kPose).norm(), 1e-4);
        EXPECT_LT(a.residual.rms, 1e-3);
        EXPECT_GT(a.overlap, 0.8);
        EXPECT_TRUE(a.openDirections.empty());
        EXPECT_LE(a.iterations, 60);
    }
}

/// But for the slope measured in the model.
TEST(DenseAligner, CovarianceIsThePlannersInverse) {
    AlignmentOptions options;
    options.measureSlope = false;
    DenseAligner aligner(room(), camera(), options);
    const Alignment a = aligner.align(observe(room(), kPose), kPose);
    View view;
    room().render(camera(), a.T_c_w, view);
    const Matrix6 planned = photometricInformation(view, camera(), {});
    EXPECT_LT((a.information - planned).norm(), 1e-5 * planned.norm());
    // Eigenvalues below one of the scaled information are raised to one: not so here.
    EXPECT_LT((a.covariance * planned - Matrix6::Identity()).norm(), 1e-4);
}

TEST(DenseAligner, PriorDecidesWhereTheImageDoesNotInform) {
    const MeshRenderer white(test::floorOf(uniformTexture(0.9)));
    const Pose truth = lookFrom({0., 0., 2.}, kDown);
    DenseAligner aligner(white, camera());
    UncertainPose prior{truth, 1e-4 * Matrix6::Identity()};
    const Alignment a = aligner.align(observe(white, truth, 0.02), prior);
    EXPECT_EQ(a.verdict, Verdict::degenerate);
    EXPECT_EQ(a.openDirections.size(), 6U);
    EXPECT_LT((a.covariance - prior.covariance).norm(), 1e-12);
    EXPECT_LT(errorOf(a, truth).norm(), 1e-9);
}

TEST(DenseAligner, NamesTheDirectionsThatStripesLeaveOpen) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 0.3})));
    const Pose truth = lookFrom({0., 0., 2.}, kDown);  // image x along world -y, y along -x
    DenseAligner aligner(bars, camera());
    const Pose start = expSE3(0.01 * Vector6::Unit(1)) * truth;
    const Alignment a = aligner.align(observe(bars, truth, 0.01), start);
    EXPECT_EQ(a.verdict, Verdict::degenerate) << describe(a);
    EXPECT_EQ(a.openDirections, std::vector<std::string>{"x"}) << describe(a);
    EXPECT_LT(std::abs(errorOf(a, truth)[1]), 0.005);
    EXPECT_GT(std::abs(a.directions(0, 0)), 0.7);
    EXPECT_GT(a.covariance(0, 0), 0.5);
    EXPECT_EQ(describe(a), "degenerate along x");
}

TEST(DenseAligner, OpenDirectionsStayWhereTheyWere) {
    const MeshRenderer white(test::floorOf(uniformTexture(0.9)));
    const Pose truth = lookFrom({0., 0., 2.}, kDown);
    DenseAligner aligner(white, camera());
    const Alignment a = aligner.align(observe(white, truth, 0.02), truth);
    EXPECT_LT(errorOf(a, truth).norm(), 1e-12);
}

/// The posterior is the minimum of image and prior: compared with the two on their own, which are
/// nearly linear at this distance.
TEST(DenseAligner, WeighsImageAgainstPrior) {
    AlignmentOptions options;
    options.photometric.sigma = 5.;  // as good as the prior
    options.trust.openSigma = 10.;
    options.fineStep = 1e-4;
    DenseAligner aligner(room(), camera(), options);
    std::mt19937_64 random(5);
    const Vector6 offset = test::randomTwist(0.01, 0.005, random);
    UncertainPose prior;
    prior.mean = expSE3(offset) * kPose;
    Vector6 sigmas;
    sigmas << 0.01, 0.02, 0.03, 0.005, 0.01, 0.02;
    prior.covariance = sigmas.cwiseAbs2().asDiagonal();
    const Alignment a = aligner.align(observe(room(), kPose), prior);
    const Matrix6 planned = a.information;
    const Matrix6 posterior = (planned + prior.covariance.inverse()).inverse();
    EXPECT_LT((a.covariance - posterior).norm(), 0.02 * posterior.norm());
    const Vector6 expected = posterior * (planned * -offset);  // from the prior's mean
    EXPECT_LT((logSE3(a.T_c_w * prior.mean.inverse()) - expected).norm(), 0.05 * offset.norm());
}

/// Bars along world y, 0.5 m wide with soft edges, seen askew.
TEST(DenseAligner, EdgesDoNotInformAlongThemselves) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 0.5, .softEdge = 0.05})));
    AlignmentOptions options;
    options.photometric.scale = 0.08;
    DenseAligner aligner(bars, makeCamera(188, 120, 1.2217), options);
    for (const double askew : {0., 0.01, 0.03, 0.1}) {
        const UncertainPose prior = test::aboveBars(askew);
        View view;
        bars.render(aligner.camera(), prior.mean, view);
        const Alignment a = aligner.align(view.intensity, prior);
        EXPECT_EQ(describe(a), "degenerate along y");
        const Eigen::Vector3d y_c = prior.mean.linear().col(1);
        const double along = y_c.dot(a.information.topLeftCorner<3, 3>() * y_c);
        EXPECT_LT(along, 0.15 / (0.5 * 0.5)) << askew;
    }
}

/// Faint information that is true is kept, whatever the exposure: bars, and beside them texture of
/// next to no contrast.
TEST(DenseAligner, FaintTextureStillCounts) {
    Scene scene;
    const auto bars = addTexture(scene, stripes({.width = 0.5, .softEdge = 0.05}));
    const auto faint = addTexture(
        scene, valueNoise({.size = {4., 4.}, .amplitudes = {0.003, 0.002, 0.001}, .seed = 3}));
    addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 10., 0.}, bars);
    addPlane(scene, {-10., 0., 0.}, {20., 0., 0.}, {0., 10., 0.}, faint);
    const MeshRenderer floor(std::move(scene));
    UncertainPose prior;
    prior.mean = lookFrom({0.13, 0., 2.}, kDown, kDown + 0.03);
    Vector6 sigmas;
    sigmas << 0.05, 0.5, 0.05, 0.005, 0.005, 0.01;
    prior.covariance = sigmas.cwiseAbs2().asDiagonal();
    std::mt19937_64 random(2);
    for (const double gain : {1., 1.8}) {
        AlignmentOptions options;
        options.exposure = ExposurePrior{};
        options.measureSlope = false;
        DenseAligner trusting(floor, makeCamera(188, 120, 1.2217), options);
        options.measureSlope = true;
        DenseAligner measuring(floor, makeCamera(188, 120, 1.2217), options);
        View view;
        floor.render(trusting.camera(), prior.mean, view);
        ImageF image = test::noisy(view.intensity, 0.02, random);
        for (unsigned i = 0; i < image.getSize(); ++i) {
            image.bitmap[i] = static_cast<float>(gain * image.bitmap[i]);
        }
        const Alignment a = trusting.align(image, prior);
        const Alignment b = measuring.align(image, prior);
        EXPECT_GT(b.iterations, a.iterations) << "nothing was tried out";
        EXPECT_LT(a.eigenvalues[0], 1e-3 * a.eigenvalues[5]);
        EXPECT_GT(b.eigenvalues[0], 0.8 * a.eigenvalues[0]);
        EXPECT_NEAR(b.residual.robustSigma, a.residual.robustSigma, 0.1 * a.residual.robustSigma);
    }
}

/// Half a metre along a known line stays along that line when the heading is corrected.
TEST(Alignment, PositionsOfAPriorKeepToTheMap) {
    const Pose T_prior_w = lookFrom({1., 2., 1.5}, kDown);
    const Vector6 turn = (Vector6() << 0., 0., 0., 0., 0., 0.2).finished();
    const Pose T_c_w = expSE3(turn) * T_prior_w;
    const auto lineIn = [](const Pose& T) { return Eigen::Vector3d(T.linear().col(1)); };
    Matrix6 P = 1e-8 * Matrix6::Identity();
    P.topLeftCorner<3, 3>() += 0.25 * lineIn(T_prior_w) * lineIn(T_prior_w).transpose();
    const Matrix6 moved = transported(P, deviation(T_c_w, T_prior_w));
    const Eigen::Vector3d across = T_c_w.linear().col(0);
    EXPECT_NEAR(across.dot(moved.topLeftCorner<3, 3>() * across), 1e-8, 1e-10);
    EXPECT_NEAR(lineIn(T_c_w).dot(moved.topLeftCorner<3, 3>() * lineIn(T_c_w)), 0.25, 1e-6);
}

TEST(DenseAligner, NoPriorVarianceNoMotion) {
    DenseAligner aligner(room(), camera());
    std::mt19937_64 random(5);
    UncertainPose prior{expSE3(test::randomTwist(0.01, 0., random)) * kPose, {}};
    prior.covariance.setZero();
    prior.covariance(0, 0) = 1e-3;
    const Alignment a = aligner.align(observe(room(), kPose), prior);
    const Vector6 moved = logSE3(a.T_c_w * prior.mean.inverse());
    EXPECT_GT(std::abs(moved[0]), 1e-4);
    EXPECT_LT(moved.tail<5>().norm(), 1e-12);
}

TEST(DenseAligner, RobustWeightsSurviveAnOccluder) {
    ImageF image = observe(room(), kPose, 0.01);
    for (unsigned v = 30; v < 80; ++v) {
        for (unsigned u = 60; u < 130; ++u) image[v][u] = u % 8 < 4 ? 0.95F : 0.05F;
    }
    const auto errorWith = [&](RobustWeight robust) {
        AlignmentOptions options;
        options.robust = robust;
        DenseAligner aligner(room(), camera(), options);
        const Vector6 offset = 0.02 * Vector6::Unit(0);
        return errorOf(aligner.align(image, expSE3(offset) * kPose), kPose).norm();
    };
    EXPECT_GT(errorWith(RobustWeight::none), 4e-3);
    EXPECT_LT(errorWith(RobustWeight::huber), 4e-3);
    EXPECT_LT(errorWith(RobustWeight::tukey), 1.5e-3);
}

TEST(DenseAligner, ReportsThatItIsLost) {
    DenseAligner aligner(room(), camera());
    const ImageF image = observe(room(), kPose, 0.02);
    // Looking away from everything.
    const MeshRenderer patch(test::floorOf(valueNoise()));
    DenseAligner overFloor(patch, camera());
    const Alignment sky = overFloor.align(image, lookFrom({0., 0., 1.}, -kOblique));
    EXPECT_EQ(sky.verdict, Verdict::lostOverlap);
    EXPECT_EQ(describe(sky), "lost: overlap 0.00 below 0.20");
    // A picture of another place, and a black one.
    const ImageF elsewhere = observe(room(), lookFrom({4.5, 1., 1.2}, 0.2, 2.5), 0.02);
    EXPECT_TRUE(isLost(aligner.align(elsewhere, kPose).verdict));
    const ImageF black(camera().height, camera().width, 0.F);
    EXPECT_TRUE(isLost(aligner.align(black, kPose).verdict));
    // A prior that excludes the truth.
    const UncertainPose confident{expSE3(0.05 * Vector6::Unit(0)) * kPose,
                                  1e-6 * Matrix6::Identity()};
    EXPECT_EQ(aligner.align(image, confident).verdict, Verdict::lostImplausible);
}

/// A floor of faint texture, and a box of strong contrast with its corner at x.
Scene boxOnFaintFloor(double x) {
    Scene scene = test::floorOf(valueNoise({.size = {20., 20.},
                                            .cells = {0.12, 0.05},
                                            .amplitudes = {0.03, 0.03},
                                            .mean = 0.5,
                                            .seed = 4}));
    addBox(scene, {x, -0.2, 0.}, {x + 0.4, 0.2, 0.4},
           addTexture(scene, checker({.cell = 0.17, .dark = 0.2, .light = 0.8})));
    return scene;
}

/// Its contrast is most of the image's variance, and where it is now explains all of this.
TEST(DenseAligner, AMovedObjectDoesNotMoveTheCamera) {
    const MeshRenderer before(boxOnFaintFloor(1.)), now(boxOnFaintFloor(1.15));
    AlignmentOptions options;
    options.measureCovariance = true;
    DenseAligner aligner(before, camera(), options);
    AlignmentOptions trusting = options;
    trusting.trust.minTexture = -1.;
    DenseAligner deceived(before, camera(), trusting);
    const Matrix6 prior = Vector6{{0.1, 0.1, 0.1, 0.03, 0.03, 0.03}}.cwiseAbs2().asDiagonal();
    int wrong = 0, elsewhere = 0;
    for (int k = 0; k < 8; ++k) {
        const Pose truth = lookFrom({-0.4, -0.4 + 0.1 * k, 1.4}, 0.7, 0.05 * k);
        const ImageF image = observe(now, truth, 0.02, k);
        const UncertainPose belief{expSE3(0.05 * Vector6::Unit(0)) * truth, prior};
        const Alignment a = aligner.align(image, belief);
        EXPECT_TRUE(isLost(a.verdict) || test::neesOf(a, truth) < 5.) << k << " " << describe(a);
        elsewhere += a.verdict == Verdict::lostTexture ? 1 : 0;
        wrong += test::neesOf(deceived.align(image, belief), truth) > 25. ? 1 : 0;
        EXPECT_EQ(aligner.align(observe(before, truth, 0.02, k), belief).verdict,
                  Verdict::converged);
    }
    EXPECT_GT(wrong, 2) << "the case that this is about";
    EXPECT_GT(elsewhere, 2);
}

TEST(DenseAligner, IsLostInTheDarkOverWhite) {
    const MeshRenderer white(test::floorOf(uniformTexture(0.9)));
    const Pose truth = lookFrom({0., 0., 2.}, kDown);
    DenseAligner aligner(white, camera());
    const ImageF black(aligner.camera().height, aligner.camera().width, 0.F);
    EXPECT_EQ(aligner.align(black, {truth, 1e-2 * Matrix6::Identity()}).verdict,
              Verdict::lostResidual);
}

TEST(DenseAligner, LeastSigmasBoundTheCovarianceFromBelow) {
    AlignmentOptions options;
    options.trust.leastSigma = 0.01;
    options.trust.leastSigmaRotation = 0.005;
    DenseAligner aligner(room(), camera(), options);
    const Alignment a = aligner.align(observe(room(), kPose), kPose);
    Vector6 sigmas;
    sigmas << 0.01, 0.01, 0.01, 0.005, 0.005, 0.005;
    const Matrix6 least = sigmas.cwiseAbs2().asDiagonal();
    EXPECT_LT((a.covariance - least).norm(), 1e-9);
    const Matrix6 large = 2. * least;
    EXPECT_LT((withLeastSigma(large, 0.01, 0.005) - large).norm(), 1e-12);
    const Matrix6 raised = withLeastSigma(least, 0.02, 0.);  // of positions alone
    EXPECT_NEAR(raised(0, 0), 0.02 * 0.02, 1e-12);
    EXPECT_NEAR(raised(4, 4), least(4, 4), 1e-12);
}

TEST(DenseAligner, ResidualStatisticsAreThoseOfTheNoise) {
    DenseAligner aligner(room(), camera());
    const Alignment a = aligner.align(observe(room(), kPose, 0.03), kPose);
    EXPECT_NEAR(a.residual.rms, 0.03, 0.001);
    EXPECT_NEAR(a.residual.robustSigma, 0.03, 0.001);
    EXPECT_NEAR(a.residual.mean, 0., 0.001);
    EXPECT_LT(a.residual.unexplained, 0.2);
}

TEST(DenseAligner, RefusesImagesOfAnotherSize) {
    DenseAligner aligner(room(), camera());
    EXPECT_THROW(aligner.align(ImageF(10, 10), kPose), std::invalid_argument);
}

// --- Consistency
// --------------------------------------------------------------------------------------

/// NEES per degree of freedom over simulated alignments with independent noise. The chi-square
/// bounds of 60 x 6 degrees of freedom at three sigma are 1 +- 0.22; consistency_bench runs
/// hundreds.
TEST(DenseAligner, CovarianceIsConsistentOnTexture) {
    const Camera small = makeCamera(94, 60, 1.2);
    DenseAligner aligner(room(), small);
    std::mt19937_64 random(7);
    double sum = 0.;
    const int n = 60;
    for (int i = 0; i < n; ++i) {
        const Pose truth = lookFrom({1.5 + 0.01 * i, 2. + 0.03 * i, 1.5}, kOblique, 0.05 * i);
        const ImageF image = observe(room(), truth, 0.02, 100 + i, small);
        const Pose start = expSE3(test::randomTwist(0.02, 0.01, random)) * truth;
        const Alignment a = aligner.align(image, start);
        ASSERT_EQ(a.verdict, Verdict::converged) << describe(a);
        sum += test::neesOf(a, truth);
    }
    const double sigma = std::sqrt(2. / (6. * n));
    std::cout << "NEES per dof " << sum / n << ", chi-square 95 % [" << 1. - 1.96 * sigma << ", "
              << 1. + 1.96 * sigma << "]\n";
    EXPECT_NEAR(sum / n, 1., 3. * sigma);
}

}  // namespace
}  // namespace photonav
