// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "dataset/belief_trajectory.hpp"
#include "geometry/camera.hpp"
#include "geometry/se3.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

Pose at(const Vector3d& p, const Vector3d& axisAngle = Vector3d::Zero()) {
    Vector6 xi;
    xi << 0., 0., 0., axisAngle;
    Pose T = expSE3(xi);
    T.translation() = p;
    return T;
}

/// Poses on a helix, one every 0.1 s, and the same with an error.
std::vector<PosePair> helix(const std::function<Pose(const Pose&, int)>& estimate) {
    std::vector<PosePair> pairs;
    for (int i = 0; i < 50; ++i) {
        const double a = 0.1 * i;
        const Pose truth = at({std::cos(a), std::sin(a), 0.05 * i}, {0.3, 0.2, a});
        pairs.push_back({std::size_t(i), 0.1 * i, estimate(truth, i), truth});
    }
    return pairs;
}

TEST(Evaluation, SummaryOfAList) {
    const ErrorSummary s = summarise({3., 1., 4., 2.});
    EXPECT_EQ(s.count, 4U);
    EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
    EXPECT_DOUBLE_EQ(s.max, 4.);
    EXPECT_DOUBLE_EQ(summarise({1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11.}).median, 6.);
    EXPECT_DOUBLE_EQ(summarise({1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11.}).p90, 10.);
    EXPECT_EQ(summarise({}).rmse, 0.);
}

TEST(Evaluation, AlignmentFindsTheMotionBetweenTwoWorlds) {
    const Pose T_truth_estimate = at({4., -2., 1.}, {0.5, -1., 2.});
    const auto pairs =
        helix([&](const Pose& truth, int) { return T_truth_estimate.inverse() * truth; });
    EXPECT_TRUE(alignmentOf(pairs).isApprox(T_truth_estimate, 1e-9));
    const PoseErrors aligned = absoluteErrors(pairs, alignmentOf(pairs));
    EXPECT_LT(summarise(aligned.translation).max, 1e-9);
    EXPECT_LT(summarise(aligned.rotation).max, 1e-7);
    EXPECT_GT(summarise(absoluteErrors(pairs).translation).rmse, 1.);
}

TEST(Evaluation, AlignmentOfFewPoints) {
    EXPECT_TRUE(rigidAlignment({{1., 2., 3.}}, {{2., 2., 5.}}).isApprox(at({1., 0., 2.}), 1e-12));
    const Pose line = rigidAlignment({{0., 0., 0.}, {1., 0., 0.}, {2., 0., 0.}},
                                     {{0., 0., 1.}, {0., 1., 1.}, {0., 2., 1.}});
    EXPECT_NEAR(line.linear().determinant(), 1., 1e-9);
    EXPECT_TRUE((line * Vector3d(2., 0., 0.)).isApprox(Vector3d(0., 2., 1.), 1e-9));
    EXPECT_THROW(rigidAlignment({}, {}), std::invalid_argument);
    EXPECT_THROW(rigidAlignment({{0., 0., 0.}}, {}), std::invalid_argument);
}

/// A camera that hardly moves: the positions alone would turn its orientation anywhere.
TEST(Evaluation, AlignmentOfACameraThatHovers) {
    const Pose T_truth_estimate = at({4., -2., 1.}, {0.5, -1., 2.});
    std::mt19937_64 random(5);
    std::normal_distribution<double> millimetres(0., 1e-3);
    std::vector<PosePair> pairs;
    for (int i = 0; i < 30; ++i) {
        const auto jitter = [&] {
            return Vector3d(millimetres(random), millimetres(random), millimetres(random));
        };
        const Pose truth = at(Vector3d(1., 2., 3.) + jitter(), {0.1, 0.2, 0.3});
        const Pose seen = T_truth_estimate.inverse() * truth * at(jitter());
        pairs.push_back({std::size_t(i), 0.1 * i, seen, truth});
    }
    const PoseErrors errors = absoluteErrors(pairs, alignmentOf(pairs));
    EXPECT_LT(summarise(errors.translation).rmse, 3e-3);
    EXPECT_LT(summarise(errors.rotation).max, 1e-6);
    const PoseErrors byPositions = absoluteErrors(pairs, positionAlignment(pairs));
    EXPECT_LT(summarise(byPositions.translation).rmse, summarise(errors.translation).rmse);
    EXPECT_GT(summarise(byPositions.rotation).max, 1e-3);
}

TEST(Evaluation, AbsoluteErrorsByHand) {
    const std::vector<PosePair> pairs = {
        {0, 0., at({0., 0., 0.}), at({0., 0., 0.})},
        {1, 1., at({1., 3., 4.}), at({1., 0., 0.})},                  // 5 m off
        {2, 2., at({2., 0., 0.}, {0., 0., 0.5}), at({2., 0., 0.})}};  // 0.5 rad off
    const PoseErrors errors = absoluteErrors(pairs);
    EXPECT_NEAR(errors.translation[1], 5., 1e-12);
    EXPECT_NEAR(errors.translation[2], 0., 1e-12);
    EXPECT_NEAR(errors.rotation[2], 0.5, 1e-9);
    EXPECT_NEAR(summarise(errors.translation).rmse, 5. / std::sqrt(3.), 1e-9);
}

TEST(Evaluation, RelativeErrorsByHand) {
    // One metre and one second a frame; the estimate goes 10 cm too far in frames 1 to 2 only.
    std::vector<PosePair> pairs;
    for (int i = 0; i < 5; ++i) {
        pairs.push_back({std::size_t(i), double(i), at({i + (i >= 2 ? 0.1 : 0.), 7., 0.}),
                         at({double(i), 0., 0.})});
    }
    const PoseErrors frame = relativeErrors(pairs, Spacing::frames, 1.);
    ASSERT_EQ(frame.translation.size(), 4U);
    EXPECT_NEAR(frame.translation[0], 0., 1e-12);
    EXPECT_NEAR(frame.translation[1], 0.1, 1e-12);
    const PoseErrors two = relativeErrors(pairs, Spacing::seconds, 2.);
    ASSERT_EQ(two.translation.size(), 3U);
    EXPECT_NEAR(two.translation[0], 0.1, 1e-12);
    EXPECT_NEAR(two.translation[2], 0., 1e-12);
    EXPECT_EQ(relativeErrors(pairs, Spacing::metres, 3.).translation.size(), 2U);
    EXPECT_TRUE(relativeErrors(pairs, Spacing::metres, 0.5).translation.empty());
    EXPECT_TRUE(relativeErrors(pairs, Spacing::seconds, 100.).translation.empty());
    pairs.erase(pairs.begin() + 1);  // a lost frame: its motions are not judged
    EXPECT_EQ(relativeErrors(pairs, Spacing::frames, 1.).translation.size(), 2U);
}

TEST(Evaluation, RelativeErrorsTakeTheNearestOfUnevenSpacings) {
    std::vector<PosePair> pairs;
    for (const double t : {0., 0.95, 1.04, 1.9}) {
        pairs.push_back({pairs.size(), t, at({t > 1. ? 1. : 0., 0., 0.}), Pose::Identity()});
    }
    const PoseErrors errors = relativeErrors(pairs, Spacing::seconds, 1.);
    ASSERT_EQ(errors.translation.size(), 2U);  // 0 to 1.04, 0.95 to 1.9
    EXPECT_NEAR(errors.translation[0], 1., 1e-12);
}

TEST(Evaluation, RelativeErrorsDoNotDependOnTheWorld) {
    const auto drifting = [](const Pose& truth, int i) { return truth * at({1e-3 * i, 0., 0.}); };
    const Pose other = at({3., 1., 2.}, {1., 1., 1.});
    const auto a = relativeErrors(helix(drifting), Spacing::seconds, 1.);
    const auto b =
        relativeErrors(helix([&](const Pose& truth, int i) { return other * drifting(truth, i); }),
                       Spacing::seconds, 1.);
    ASSERT_GE(a.translation.size(), 40U);
    EXPECT_NEAR(a.translation[17], b.translation[17], 1e-12);
    EXPECT_NEAR(a.rotation[17], b.rotation[17], 1e-7);
}

TEST(Evaluation, NormalisedErrorIsSixOnAverageWhenTheCovarianceIsRight) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    Matrix6 root = Matrix6::Zero();
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j <= i; ++j) root(i, j) = 0.02 * normal(random);
    }
    const UncertainPose belief{at({1., 2., 3.}, {0.4, 0.5, 0.6}), root * root.transpose()};
    double sum = 0.;
    constexpr int kSamples = 3000;
    for (int k = 0; k < kSamples; ++k) {
        Vector6 z;
        for (int i = 0; i < 6; ++i) z[i] = normal(random);
        sum += squaredNormalisedError(belief, expSE3(root * z) * belief.mean).value();
    }
    EXPECT_NEAR(sum / kSamples, 6., 0.25);  // standard error 0.063
    EXPECT_FALSE(squaredNormalisedError({belief.mean, Matrix6::Zero()}, belief.mean));
}

TEST(BeliefTrajectory, FilesHoldWhatTheirHeadersSay) {
    const test::TemporaryFolder folder;
    Matrix6 covariance = Matrix6::Zero();
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j)
            covariance(i, j) = 10. * (std::min(i, j) + 1) + std::max(i, j) + 1;
    }
    // The camera looks along world x; its z axis is the world's x axis.
    Pose T_w_c = cameraMount(0.);
    T_w_c.translation() = Vector3d(1., 2., 3.);
    const std::vector<StampedBelief> beliefs = {{12.5, {T_w_c.inverse(), covariance}}};
    writeCovariances(folder.file("t.cov"), beliefs);
    writeOpenVinsTrajectory(folder.file("t.ov"), beliefs);
    const auto lastLine = [&](const std::string& name) {
        std::ifstream in(folder.file(name));
        std::string line, last;
        while (std::getline(in, line)) last = line;
        return last;
    };
    EXPECT_EQ(lastLine("t.cov"),
              "12.500000 11 12 13 14 15 16 22 23 24 25 26 33 34 35 36 44 45 46 55 56 66");
    // x_w = z_c, y_w = -x_c, z_w = -y_c
    EXPECT_EQ(lastLine("t.ov"),
              "12.500000 1 2 3 0.5 -0.5 0.5 -0.5 44 45 46 55 56 66 33 -13 -23 11 12 22");
    std::ifstream in(folder.file("t.ov"));
    std::string header;
    std::getline(in, header);
    EXPECT_EQ(header[0], '#');
}

}  // namespace
}  // namespace photonav
