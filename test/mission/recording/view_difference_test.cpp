// SPDX-License-Identifier: BSD-3-Clause
#include "recording/view_difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

namespace photonav {
namespace {

View viewOf(std::initializer_list<float> intensity, std::initializer_list<float> depth) {
    View result;
    result.intensity.resize(1, static_cast<unsigned>(intensity.size()));
    result.depth.resize(1, static_cast<unsigned>(depth.size()));
    std::copy(intensity.begin(), intensity.end(), result.intensity.bitmap);
    std::copy(depth.begin(), depth.end(), result.depth.bitmap);
    return result;
}

TEST(ViewDifference, IsOverThePixelsThatThePredictionShows) {
    const View observed = viewOf({0.5F, 0.1F, 0.3F, 0.9F}, {2.F, 0.F, 2.5F, 1.F});
    const View predicted = viewOf({0.4F, 0.3F, 0.6F, 0.F}, {2.2F, 3.F, 2.F, 0.F});
    const ViewDifference d = compareViews(observed, predicted);
    EXPECT_EQ(d.predicted, 0.75);
    EXPECT_NEAR(d.meanIntensity.value(), 0.2, 1e-6);  // 0.1, 0.2, 0.3
    EXPECT_NEAR(d.medianIntensity.value(), 0.2, 1e-6);
    EXPECT_NEAR(d.contrast.value(), 0.4 / 3., 1e-6);  // 0.2, 0.2 and 0 from the median 0.3
    EXPECT_NEAR(d.meanDepth.value(), 0.35, 1e-6);     // where both have depth: 0.2, 0.5
}

TEST(ViewDifference, HasNoNumbersWhereNothingIsPredicted) {
    const View observed = viewOf({0.5F, 0.1F}, {2.F, 0.F});
    const ViewDifference nothing = compareViews(observed, viewOf({0.F, 0.F}, {0.F, 0.F}));
    EXPECT_EQ(nothing.predicted, 0.);
    EXPECT_FALSE(nothing.meanIntensity);
    const ViewDifference noDepth = compareViews(observed, viewOf({0.F, 0.2F}, {0.F, 3.F}));
    EXPECT_TRUE(noDepth.meanIntensity);
    EXPECT_FALSE(noDepth.meanDepth);
    EXPECT_THROW(compareViews(observed, viewOf({0.F}, {0.F})), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
