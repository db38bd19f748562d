// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/unseen_information.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

constexpr unsigned kRows = 10;

/// A view with surfaces in some of its ten rows.
View viewWith(unsigned rows) {
    View view;
    view.intensity.resize(kRows, 8, 0.5F);
    view.depth.resize(kRows, 8, 0.F);
    for (unsigned i = 0; i < 8 * rows; ++i) view.depth.bitmap[i] = 2.F;
    return view;
}

Matrix6 isotropic(double factor) { return factor * Matrix6::Identity(); }

/// Of what a view shows, nothing.
const InformationModel kNothing = [](const View&) -> Matrix6 { return Matrix6::Zero(); };

double expectedOf(const UnseenInformation& unseen) { return unseen.expected()(0, 0); }

TEST(UnseenInformation, ExpectsNothingBeforeAnythingWasSeen) {
    const UnseenInformation unseen;
    EXPECT_EQ(unseen.complete(kNothing)(viewWith(0)), Matrix6::Zero());
}

TEST(UnseenInformation, IsAsMuchAsTheRestOfTheViewWouldHave) {
    UnseenInformation unseen;
    const InformationModel model =
        unseen.complete([](const View&) -> Matrix6 { return isotropic(7.); });
    unseen.observe(viewWith(8), isotropic(80.));
    EXPECT_NEAR(expectedOf(unseen), 100., 1e-9);
    EXPECT_NEAR(model(viewWith(kRows))(0, 0), 7., 1e-9);
    EXPECT_NEAR(model(viewWith(7))(0, 0), 7. + 30., 1e-9);
    EXPECT_NEAR(model(viewWith(0))(5, 5), 107., 1e-9);
    EXPECT_EQ(model(View()), isotropic(7.));  // without a depth image nothing is known to lack
}

TEST(UnseenInformation, ViewsThatShowLittleDoNotStandForTheirSurroundings) {
    UnseenInformation unseen;
    unseen.observe(viewWith(4), isotropic(40.));
    EXPECT_EQ(expectedOf(unseen), 0.);
    unseen.observe(viewWith(5), isotropic(40.));
    EXPECT_NEAR(expectedOf(unseen), 80., 1e-9);
}

TEST(UnseenInformation, IsTheMeanOfTheLastViews) {
    UnseenInformation unseen;
    unseen.observe(viewWith(kRows), isotropic(10.));
    unseen.observe(viewWith(kRows), isotropic(20.));
    EXPECT_NEAR(expectedOf(unseen), 15., 1e-9);
    for (int i = 0; i < 100; ++i) unseen.observe(viewWith(kRows), isotropic(0.));
    for (int i = 0; i < 60; ++i) unseen.observe(viewWith(kRows), isotropic(10.));
    EXPECT_GT(expectedOf(unseen), 9.);
}

}  // namespace
}  // namespace photonav
