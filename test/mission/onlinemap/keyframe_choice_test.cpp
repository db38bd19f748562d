// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/keyframe_choice.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

/// An image of a wall at 2 m that the map shows as well, after a first keyframe.
class Keyframes : public testing::Test {
  protected:
    Keyframes() {
        image.intensity.resize(40, 40, 0.5F);
        image.depth.resize(40, 40, 2.F);
        shown = image;
        tracked.alignment.verdict = Verdict::converged;
        choice.add(0, image, Pose::Identity());
        choice.setFused(0);
    }
    bool isKeyframe() const { return choice.isKeyframe(tracked, image, shown); }
    /// Depth of the upper rows.
    static void setDepth(View& view, unsigned rows, float depth) {
        for (unsigned i = 0; i < rows * view.depth.getWidth(); ++i) view.depth.bitmap[i] = depth;
    }

    ExploreConfig config;
    Camera camera = makeCamera(40, 40, 1.);
    KeyframeChoice choice{config, camera};
    TrackedFrame tracked;
    View image, shown;
};

TEST_F(Keyframes, BeginWithTheFirstImage) {
    EXPECT_TRUE(KeyframeChoice(config, camera).isKeyframe(tracked, image, shown));
    EXPECT_FALSE(isKeyframe());
}

TEST_F(Keyframes, ComeAtADistanceFromTheLastOne) {
    tracked.T_c_w.mean.translation().x() = config.keyframeDistance - 0.01;
    EXPECT_FALSE(isKeyframe());
    tracked.T_c_w.mean.translation().x() = config.keyframeDistance + 0.01;
    EXPECT_TRUE(isKeyframe());
    choice.add(1, image, tracked.T_c_w.mean);
    EXPECT_FALSE(isKeyframe());
}

TEST_F(Keyframes, ComeAfterATurn) {
    const auto turn = [&](double angle) {
        tracked.T_c_w.mean = Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
    };
    turn(config.keyframeAngle - 0.01);
    EXPECT_FALSE(isKeyframe());
    turn(config.keyframeAngle + 0.01);
    EXPECT_TRUE(isKeyframe());
}

TEST_F(Keyframes, ComeWhereMuchIsNew) {
    setDepth(shown, 8, 0.F);  // a fifth
    EXPECT_FALSE(isKeyframe());
    setDepth(shown, 16, 0.F);
    EXPECT_TRUE(isKeyframe());
    // Of a surface that is out of range nothing would be mapped, and of none, nothing can be.
    setDepth(image, 16, static_cast<float>(config.range) + 0.1F);
    EXPECT_FALSE(isKeyframe());
    setDepth(image, 40, 0.F);
    EXPECT_FALSE(isKeyframe());
}

TEST_F(Keyframes, AreNotChosenForWhatTheMapIsStillToShow) {
    config.keyframeDistance = 2.;  // the choice is by new surfaces alone
    KeyframeChoice busy(config, camera);
    const auto isKeyframe = [&](double x) {
        tracked.T_c_w.mean.translation().x() = x;
        return busy.isKeyframe(tracked, image, shown);
    };
    busy.add(0, image, Pose::Identity());
    setDepth(shown, 40, 0.F);
    EXPECT_FALSE(isKeyframe(0.));
    EXPECT_FALSE(isKeyframe(0.4));  // a fifth of the image is beside the keyframe
    EXPECT_TRUE(isKeyframe(0.8));
    setDepth(image, 40, 1.8F);  // a surface in front of that of the keyframe
    EXPECT_TRUE(isKeyframe(0.));
    setDepth(image, 40, 2.F);
    busy.setFused(0);
    EXPECT_TRUE(isKeyframe(0.));  // the map does not show what was fused
}

TEST_F(Keyframes, AreNotBlackOrContradictedByTheMap) {
    tracked.T_c_w.mean.translation().x() = 1.;
    EXPECT_TRUE(choice.isUsable(tracked, image));
    tracked.rejected = true;
    for (const Verdict verdict :
         {Verdict::lostResidual, Verdict::lostTexture, Verdict::lostDivergence,
          Verdict::lostImplausible, Verdict::lostExposure}) {
        tracked.alignment.verdict = verdict;
        EXPECT_FALSE(choice.isUsable(tracked, image));
        EXPECT_FALSE(isKeyframe());
    }
    tracked.isMapInconsistent = true;  // the map has to be made again
    EXPECT_TRUE(choice.isUsable(tracked, image));
    tracked.isMapInconsistent = false;
    tracked.alignment.verdict = Verdict::lostOverlap;  // the map shows too little: it has to grow
    EXPECT_TRUE(isKeyframe());
    image.intensity = 0.F;
    EXPECT_FALSE(isKeyframe());
    EXPECT_FALSE(choice.isUsable(tracked, image));
}

}  // namespace
}  // namespace photonav
