// SPDX-License-Identifier: BSD-3-Clause
#include "pose_filter.hpp"

#include <gtest/gtest.h>

#include "rooms.hpp"
#include "simulated_mav.hpp"

namespace photonav {
namespace {

using test::cameraAt;
using test::kOblique;

const Camera& filterCamera() {
    static const Camera small = makeCamera(94, 60, 1.2);
    return small;
}

/// Motion forward of 10 cm with a turn, and its noise.
UncertainPose motion() {
    Vector6 xi;
    xi << 0.02, 0., -0.1, 0., 0.03, 0.;
    Vector6 sigmas;
    sigmas << 0.01, 0.01, 0.01, 0.005, 0.005, 0.005;
    return {expSE3(xi), sigmas.cwiseAbs2().asDiagonal()};
}

TEST(PoseFilter, PropagatesAsThePlannerDoes) {
    UncertainPose start{cameraAt({2., 3., 1.5}, kOblique), 1e-3 * Matrix6::Identity()};
    PoseFilter filter(start);
    filter.propagate(motion());
    const UncertainPose planned = compound(motion(), start);
    EXPECT_EQ(filter.belief().mean.matrix(), planned.mean.matrix());
    EXPECT_EQ(filter.belief().covariance, planned.covariance);
}

TEST(PoseFilter, LostImagesChangeNothing) {
    const MeshRenderer room(test::texturedRoom());
    DenseAligner aligner(room, filterCamera());
    PoseFilter filter({cameraAt({2., 3., 1.5}, kOblique), 1e-4 * Matrix6::Identity()});
    const UncertainPose before = filter.belief();
    const ImageF black(filterCamera().height, filterCamera().width, 0.F);
    EXPECT_TRUE(isLost(filter.update(aligner, black).verdict));
    EXPECT_EQ(filter.belief().mean.matrix(), before.mean.matrix());
    EXPECT_EQ(filter.belief().covariance, before.covariance);
}

/// Flights of five steps: the final NEES per degree of freedom must be one. On a floor of faint
/// texture odometry and images count about equally, so an error in either would show.
TEST(PoseFilter, IsHonestAlongFlights) {
    const MeshRenderer floor(
        test::floorOf(valueNoise({.amplitudes = {0.004, 0.003, 0.002}, .seed = 4})));
    AlignmentOptions options;
    options.trust.openSigma = 0.5;
    DenseAligner aligner(floor, filterCamera(), options);
    std::mt19937_64 random(11);
    const Matrix6 startCovariance = motion().covariance;
    double sum = 0., odometry = 0., final = 0.;
    const int flights = 60;
    for (int flight = 0; flight < flights; ++flight) {
        Pose truth = cameraAt({0.1 * flight - 3., 1., 1.5}, 1.1, 0.2 * flight);
        PoseFilter filter({expSE3(draw(rootOf(startCovariance), random)) * truth, startCovariance});
        for (int step = 0; step < 5; ++step) {
            truth = expSE3(draw(rootOf(motion().covariance), random)) * motion().mean * truth;
            filter.propagate(motion());
            odometry += filter.belief().covariance.trace();
            View view;
            floor.render(filterCamera(), truth, view);
            const Alignment a = filter.update(aligner, test::noisy(view.intensity, 0.02, random));
            ASSERT_FALSE(isLost(a.verdict)) << describe(a);
            final += filter.belief().covariance.trace();
        }
        const Vector6 xi = logSE3(truth * filter.belief().mean.inverse());
        sum += xi.dot(filter.belief().covariance.ldlt().solve(xi)) / 6.;
    }
    const double sigma = std::sqrt(2. / (6. * flights));
    std::cout << "NEES per dof " << sum / flights << ", chi-square 95 % [" << 1. - 1.96 * sigma
              << ", " << 1. + 1.96 * sigma << "], images keep " << final / odometry
              << " of the trace\n";
    EXPECT_NEAR(sum / flights, 1., 3. * sigma);
    EXPECT_LT(final, 0.9 * odometry);
    EXPECT_GT(final, 0.1 * odometry);
}

/// Hovering over bars along y: neither what central differences say along an edge that is askew,
/// nor a prior turned by half of a correction may ever tell y.
TEST(PoseFilter, BarsNeverTellTheWayAlongThem) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 0.5, .softEdge = 0.05})));
    AlignmentOptions options;
    options.photometric.scale = 0.1;
    DenseAligner aligner(bars, filterCamera(), options);
    std::mt19937_64 random(5);
    Vector6 sigmas;
    sigmas << 0.02, 0.5, 0.02, 0.005, 0.005, 0.03;
    const Matrix6 before = sigmas.cwiseAbs2().asDiagonal();
    sigmas << 0.002, 0.002, 0.002, 0.002, 0.002, 0.01;
    const UncertainPose hover{Pose::Identity(), sigmas.cwiseAbs2().asDiagonal()};
    Pose truth = cameraAt({0.1, 0., 2.}, test::kDown, test::kDown);
    PoseFilter filter({expSE3(draw(rootOf(before), random)) * truth, before});
    for (int image = 0; image < 40; ++image) {
        truth = expSE3(draw(rootOf(hover.covariance), random)) * truth;
        filter.propagate(hover);
        View view;
        bars.render(filterCamera(), truth, view);
        filter.update(aligner, test::noisy(view.intensity, 0.02, random));
    }
    const auto sigmaAlong = [&](int axis) {
        const Eigen::Vector3d axis_c = filter.belief().mean.linear().col(axis);
        const Matrix6& covariance = filter.belief().covariance;
        return std::sqrt(axis_c.dot(covariance.topLeftCorner<3, 3>() * axis_c));
    };
    EXPECT_LT(sigmaAlong(0), 0.02);
    EXPECT_GT(sigmaAlong(1), 0.3);  // without the one 0.005 m are left, without the other 0.12 m
}

}  // namespace
}  // namespace photonav
