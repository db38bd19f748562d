// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/loss_of_tracking.hpp"

#include <gtest/gtest.h>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

TEST(LossOfTracking, IsResolvedByWhatTheLossHasMadeWide) {
    const Matrix6 before = 1e-4 * Matrix6::Identity();
    const Matrix6 prior = 0.09 * Matrix6::Identity();
    EXPECT_TRUE(resolvesLoss(before, prior, before));
    EXPECT_TRUE(resolvesLoss(before, prior, 0.2 * prior));
    EXPECT_FALSE(resolvesLoss(before, prior, prior));
    Matrix6 after = before;
    after(1, 1) = prior(1, 1);
    EXPECT_FALSE(resolvesLoss(before, prior, after));
    EXPECT_TRUE(resolvesLoss(after, prior, after)) << "it was as wide before";
    EXPECT_FALSE(resolvesLoss(prior, prior, prior)) << "it did not inform";
}

TEST(LossOfTracking, BeginsAfterSeveralRejectedImagesInARow) {
    LossOfTracking loss({.rejectedImages = 3});
    loss.onRejected(1., true);
    loss.onRejected(2., true);
    loss.onTracked(3.);
    loss.onRejected(4., true);
    loss.onRejected(5., true);
    EXPECT_FALSE(loss.isLost());
    loss.onRejected(6., true);
    ASSERT_TRUE(loss.isLost());
    EXPECT_EQ(loss.since(), 6.);
    loss.onRejected(7., true);
    EXPECT_EQ(loss.since(), 6.) << "one loss, which goes on";
    EXPECT_EQ(loss.timesLost(), 1);
}

TEST(LossOfTracking, BeginsWithTheFirstRejectedImageWithoutOdometry) {
    LossOfTracking loss({.rejectedImages = 3});
    loss.onRejected(1., false);
    EXPECT_TRUE(loss.isLost());
}

TEST(LossOfTracking, EndsInAFreshStartAfterManyRejectedImagesInARow) {
    LossOfTracking loss({.freshStartAfter = 3});
    loss.onRejected(1., true);
    loss.onRejected(2., true);
    loss.onTracked(3.);
    loss.onRejected(4., true);
    loss.onRejected(5., true);
    EXPECT_FALSE(loss.wantsFreshStart());
    loss.onRejected(6., true);
    EXPECT_TRUE(loss.wantsFreshStart());
    loss.onTracked(7.);
    EXPECT_FALSE(loss.wantsFreshStart());
}

TEST(LossOfTracking, AStartIsWrongWhereNothingWasEverTracked) {
    LossOfTracking never({.wrongStartAfter = 2}), once = never;
    once.onTracked(0.);
    for (LossOfTracking* loss : {&never, &once}) {
        loss->onRejected(1., false);
        loss->onRejected(2., false, true);
        loss->onUnmapped(3.);
        EXPECT_FALSE(loss->isStartWrong()) << "one has shown something";
        loss->onRejected(4., false);
    }
    EXPECT_TRUE(never.isStartWrong());
    EXPECT_FALSE(once.isStartWrong());
}

TEST(LossOfTracking, BeginsWhereNoImageArrivesForLong) {
    LossOfTracking loss({.blindTime = 1.5});
    loss.onTracked(1.);
    loss.onTime(2.4);
    EXPECT_FALSE(loss.isLost());
    loss.onUnmapped(2.5);  // an image all the same
    loss.onTime(3.9);
    EXPECT_FALSE(loss.isLost());
    loss.onTime(4.1);
    EXPECT_TRUE(loss.isLost());
}

TEST(LossOfTracking, LostTimeIsTheSumOfAllLosses) {
    LossOfTracking loss({.rejectedImages = 1});
    EXPECT_EQ(loss.lostTime(5.), 0.);
    loss.onRejected(1., true);
    EXPECT_EQ(loss.lostTime(1.5), 0.5) << "of a loss that goes on";
    loss.onTracked(2.);
    EXPECT_EQ(loss.lostTime(5.), 1.);
    loss.onRejected(6., true);
    loss.onTracked(6.5);
    EXPECT_EQ(loss.lostTime(9.), 1.5);
    EXPECT_EQ(loss.timesLost(), 2);
}

TEST(LossOfTracking, SearchesFartherWithEveryRejectedImage) {
    const LossOptions options{
        .rejectedImages = 1, .searchRadius = 0.3, .searchGrowth = 0.5, .searchTurn = 0.1};
    LossOfTracking loss(options);
    // A camera that looks down: the vertical is its optical axis.
    Pose T_c_w = Pose::Identity();
    T_c_w.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
    const UncertainPose belief{T_c_w, 0.01 * Matrix6::Identity()};
    const auto widthAfterRejected = [&](double time) {
        loss.onRejected(time, true);
        return loss.widened(belief).covariance.diagonal().eval();
    };
    Vector6 expected = Vector6::Constant(0.01);
    expected.head<3>().array() += 0.09;
    expected[5] += 0.01;
    EXPECT_LT((widthAfterRejected(1.) - expected).norm(), 1e-12);
    expected.head<3>().array() += 1.25 * 0.09;  // 1.5^2 - 1
    EXPECT_LT((widthAfterRejected(2.) - expected).norm(), 1e-12);
    loss.onTracked(3.);
    expected.head<3>().array() -= 1.25 * 0.09;
    EXPECT_LT((widthAfterRejected(4.) - expected).norm(), 1e-12) << "the next loss begins anew";
}

TEST(LossOfTracking, EndsByImagesThatExplainEnough) {
    const LossOfTracking loss({.maxUnexplainedShare = 0.5});
    const TrustOptions trust{.maxUnexplained = 0.4, .residualSigmas = 3.};
    Alignment alignment;
    alignment.residual.rms = 0.1;
    alignment.residual.unexplained = 0.19;
    EXPECT_TRUE(loss.isExplained(alignment, trust, 0.01));
    alignment.residual.unexplained = 0.3;  // enough to be tracked
    EXPECT_FALSE(loss.isExplained(alignment, trust, 0.01));
    alignment.residual.rms = 0.02;  // noise
    EXPECT_TRUE(loss.isExplained(alignment, trust, 0.01));
    alignment.residual.texture = {.share = 0.9, .sigma = 0.1};
    EXPECT_TRUE(loss.isExplained(alignment, trust, 0.01));
    alignment.residual.texture->sigma = 0.3;  // this may be chance
    EXPECT_FALSE(loss.isExplained(alignment, trust, 0.01));
}

}  // namespace
}  // namespace photonav
