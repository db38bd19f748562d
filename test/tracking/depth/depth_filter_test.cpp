// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "depth/monocular_depth.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using namespace test;

/// A camera that slides past a floor and crates, looking down at 45 degrees.
class DepthFilterTest : public ::testing::Test {
  protected:
    static Pose pose(int i) {
        return lookFrom({2.2 + 0.01 * i, 2.6 - 0.03 * i, 1.4}, kOblique, 0.01 * i);
    }

    View seen(int i) {
        View view;
        room().render(camera, pose(i), view);
        view.intensity = noisy(view.intensity, 0.01, random);
        return view;
    }

    static double shareConverged(const DepthFilter& filter) {
        const View view = filter.view();
        const float* depths = view.depth.bitmap;
        const auto count = std::count_if(depths, depths + view.depth.getSize(),
                                         [](float depth) { return depth > 0.F; });
        return double(count) / view.depth.getSize();
    }

    /// Share of the view's depths that are within `share` of the truth.
    static double shareRight(const View& view, const View& truth, double share) {
        int known = 0;
        int right = 0;
        for (unsigned i = 0; i < view.depth.getSize(); ++i) {
            const float z = view.depth.bitmap[i];
            if (!(z > 0.F)) continue;
            ++known;
            right += std::abs(z - truth.depth.bitmap[i]) < share * truth.depth.bitmap[i] ? 1 : 0;
        }
        return known > 0 ? double(right) / known : 0.;
    }

    Camera camera = makeCamera(160, 100, 1.2);
    std::mt19937_64 random{1};
};

TEST_F(DepthFilterTest, FindsTheDepthOfWhatHasTexture) {
    const View reference = seen(0);
    DepthFilter filter(reference.intensity, camera, pose(0));
    EXPECT_EQ(shareConverged(filter), 0.);
    EXPECT_FALSE(filter.medianDepth());
    double before = 0.;
    for (int i = 1; i <= 12; ++i) {
        filter.observe(seen(i).intensity, pose(i));
        EXPECT_GE(shareConverged(filter), before);  // what is known stays known
        before = shareConverged(filter);
    }
    EXPECT_GT(shareConverged(filter), 0.3);
    const View view = filter.view();
    EXPECT_GT(shareRight(view, reference, 0.1), 0.95);
    EXPECT_NEAR(*filter.medianDepth(), 1.9, 0.4);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            EXPECT_EQ(filter.state(v, u) == DepthState::converged, view.depth[v][u] > 0.F);
        }
    }
}

TEST_F(DepthFilterTest, BrightnessDoesNotMatter) {
    DepthFilter filter(seen(0).intensity, camera, pose(0));
    for (int i = 1; i <= 12; ++i) {
        ImageF image = seen(i).intensity;
        for (unsigned k = 0; k < image.getSize(); ++k) {
            image.bitmap[k] = (0.7F + 0.04F * float(i % 5)) * image.bitmap[k] + 0.1F;
        }
        filter.observe(image, pose(i));
    }
    EXPECT_GT(shareConverged(filter), 0.25);
    EXPECT_GT(shareRight(filter.view(), seen(0), 0.1), 0.95);
}

/// No place in the image for the patches that are compared.
TEST_F(DepthFilterTest, ImagesTooSmallGiveNoDepth) {
    camera = makeCamera(40, 16, 1.2);
    DepthFilter filter(seen(0).intensity, camera, pose(0));
    for (int i = 1; i <= 12; ++i) {
        const Pose forward =
            lookFrom(pose(0).inverse() * Eigen::Vector3d(0., 0., 0.05 * i), kOblique, 0.);
        View view;
        room().render(camera, forward, view);
        filter.observe(view.intensity, forward);
    }
    EXPECT_EQ(shareConverged(filter), 0.);
}

TEST_F(DepthFilterTest, ImagesOfAnotherPlaceGiveHardlyAnyDepth) {
    DepthFilter filter(seen(0).intensity, camera, pose(0));
    for (int i = 1; i <= 12; ++i) {
        View other;
        room().render(camera, lookFrom({4.5, 4.6, 1.4}, kOblique, 2.), other);
        filter.observe(noisy(other.intensity, 0.01, random), pose(i));
    }
    EXPECT_LT(shareConverged(filter), 0.05);
}

TEST_F(DepthFilterTest, NoDepthWithoutMotionOrTexture) {
    DepthFilter still(seen(0).intensity, camera, pose(0));
    DepthFilter bland(ImageF(camera.height, camera.width, 0.5F), camera, pose(0));
    for (int i = 1; i <= 6; ++i) {
        still.observe(seen(0).intensity, pose(0));
        bland.observe(ImageF(camera.height, camera.width, 0.5F), pose(i));
    }
    EXPECT_EQ(shareConverged(still), 0.);
    EXPECT_EQ(shareConverged(bland), 0.);
}

TEST_F(DepthFilterTest, ImagesMustFitTheCamera) {
    EXPECT_THROW(DepthFilter(ImageF(3, 4), camera, pose(0)), std::invalid_argument);
    DepthFilter filter(seen(0).intensity, camera, pose(0));
    EXPECT_THROW(filter.observe(ImageF(3, 4), pose(1)), std::invalid_argument);
}

TEST_F(DepthFilterTest, ReferencesFollowTheFlight) {
    MonocularDepth depth(camera);
    std::vector<DepthFilter> finished;
    for (int i = 0; i < 40; ++i) {
        if (auto filter = depth.add(seen(i).intensity, pose(i))) finished.push_back(*filter);
    }
    ASSERT_GE(finished.size(), 1U);
    EXPECT_TRUE(finished[0].pose().isApprox(pose(0)));
    for (const DepthFilter& filter : finished) EXPECT_GT(shareConverged(filter), 0.2);
    EXPECT_TRUE(depth.finish());
    EXPECT_FALSE(depth.finish());
    EXPECT_EQ(depth.givenUp(), 0);
}

TEST_F(DepthFilterTest, AReferenceWithoutTextureOrMotionIsGivenUp) {
    const MonocularOptions options;
    MonocularDepth depth(camera, options);
    EXPECT_FALSE(depth.add(ImageF(camera.height, camera.width, 0.F), pose(0)));
    for (int i = 0; i < options.minImages; ++i) {
        EXPECT_FALSE(depth.add(seen(0).intensity, pose(0)));
    }
    EXPECT_TRUE(depth.isAtReference());
    EXPECT_EQ(depth.givenUp(), 1);
    for (int i = 0; i < options.minImages; ++i) {
        EXPECT_FALSE(depth.add(seen(0).intensity, pose(0)));
    }
    EXPECT_EQ(depth.givenUp(), 2);  // it did not move
    for (int i = 1; i < 15; ++i) {
        EXPECT_FALSE(depth.isAtReference() && i > 1);
        depth.add(seen(i).intensity, pose(i));
    }
    EXPECT_EQ(depth.givenUp(), 2);
    const auto last = depth.finish();
    ASSERT_TRUE(last);
    EXPECT_GT(shareConverged(*last), 0.2);
}

}  // namespace
}  // namespace photonav
