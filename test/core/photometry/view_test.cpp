// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/view.hpp"

#include <gtest/gtest.h>

#include <random>

namespace photonav {
namespace {

View makeView(unsigned width, unsigned height, float intensity) {
    View view;
    view.intensity.resize(height, width, intensity);
    view.depth.resize(height, width, 1.F);
    return view;
}

TEST(PointSpread, KeepsConstantImagesToTheBit) {
    View view = makeView(37, 21, 0.3F);
    applyPointSpread(view);
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
        ASSERT_EQ(view.intensity.bitmap[i], 0.3F);
    }
}

TEST(PointSpread, IsTheBinomialFilter) {
    View view = makeView(9, 7, 0.F);
    view.intensity[3][4] = 1.F;
    applyPointSpread(view);
    for (int dv = -3; dv <= 3; ++dv) {
        for (int du = -4; du <= 4; ++du) {
            const int a = std::max(0, 2 - std::abs(du)), b = std::max(0, 2 - std::abs(dv));
            EXPECT_FLOAT_EQ(view.intensity[3 + dv][4 + du], static_cast<float>(a * b) / 16.F);
        }
    }
}

TEST(PointSpread, KeepsLinearImagesUpToTheBorder) {
    View view = makeView(12, 8, 0.F);
    for (unsigned v = 0; v < 8; ++v) {
        for (unsigned u = 0; u < 12; ++u) {
            view.intensity[v][u] = 0.03F * static_cast<float>(u) + 0.05F * static_cast<float>(v);
        }
    }
    const ImageF before = view.intensity;
    applyPointSpread(view);
    for (unsigned i = 0; i < before.getSize(); ++i) {
        EXPECT_NEAR(view.intensity.bitmap[i], before.bitmap[i], 1e-6);
    }
}

TEST(PointSpread, LeavesPixelsNextToInvalidOnesAlone) {
    View view = makeView(9, 7, 0.F);
    std::mt19937 random(7);
    for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
        view.intensity.bitmap[i] = std::uniform_real_distribution<float>(0.F, 1.F)(random);
    }
    view.depth[3][4] = 0.F;
    view.depth[0][8] = 0.F;
    const ImageF before = view.intensity;
    applyPointSpread(view);
    for (int v = 0; v < 7; ++v) {
        for (int u = 0; u < 9; ++u) {
            const bool kept = (std::abs(v - 3) <= 1 && std::abs(u - 4) <= 1) || (v <= 1 && u >= 7);
            const bool corner = (v == 0 || v == 6) && (u == 0 || u == 8);
            EXPECT_EQ(view.intensity[v][u] == before[v][u], kept || corner) << u << ' ' << v;
        }
    }
}

TEST(PointSpread, AcceptsImagesOfOneRowOrColumn) {
    for (const auto& [width, height] : {std::pair{1U, 1U}, {1U, 5U}, {5U, 1U}, {2U, 2U}}) {
        View view = makeView(width, height, 0.7F);
        applyPointSpread(view);
        for (unsigned i = 0; i < view.intensity.getSize(); ++i) {
            ASSERT_EQ(view.intensity.bitmap[i], 0.7F);
        }
    }
}

TEST(GreyLevel, IsTheNearestOfThoseThatFilesHold) {
    for (int level = 0; level < 256; ++level) {
        const float grey = static_cast<float>(level) / 255.F;
        EXPECT_EQ(greyLevel(grey), level);
        EXPECT_EQ(greyLevel(grey + 0.4F / 255.F), level);
        EXPECT_EQ(greyLevel(grey - 0.4F / 255.F), level);
    }
    EXPECT_EQ(greyLevel(-1.F), 0);
    EXPECT_EQ(greyLevel(2.F), 255);
}

}  // namespace
}  // namespace photonav
