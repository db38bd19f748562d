// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/unseen_information.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

constexpr unsigned kRows = 12;  // bands of 3 rows
constexpr unsigned kWidth = 8;

/// A view with surfaces in its first rows.
View viewWith(unsigned rows) {
    View view;
    view.intensity.resize(kRows, kWidth, 0.5F);
    view.depth.resize(kRows, kWidth, 0.F);
    for (unsigned i = 0; i < kWidth * rows; ++i) view.depth.bitmap[i] = 2.F;
    return view;
}

/// The pixels of a row inform by `perPixel(row)` each.
template <class PerPixel>
InformationModel pixelsInform(const PerPixel& perPixel) {
    return [perPixel](const View& view) -> Matrix6 {
        double sum = 0.;
        for (unsigned v = 0; v < view.depth.getHeight(); ++v) {
            for (unsigned u = 0; u < kWidth; ++u) sum += view.depth[v][u] > 0.F ? perPixel(v) : 0.;
        }
        return sum * Matrix6::Identity();
    };
}
InformationModel pixelsInformBy(double each) {
    return pixelsInform([each](unsigned) { return each; });
}

double predicted(const UnseenInformation& unseen, const InformationModel& model, const View& view) {
    return (unseen.complete(model)(view) - model(view))(5, 5);
}

TEST(UnseenInformation, ExpectsNothingBeforeAnythingWasSeen) {
    const UnseenInformation unseen;
    EXPECT_EQ(predicted(unseen, pixelsInformBy(1.), viewWith(0)), 0.);
}

TEST(UnseenInformation, IsThatOfTheFlightWhereAViewShowsNothing) {
    UnseenInformation unseen;
    unseen.observe(viewWith(kRows), pixelsInformBy(1.));
    EXPECT_NEAR(predicted(unseen, pixelsInformBy(3.), viewWith(0)), kRows * kWidth, 1e-9);
    EXPECT_EQ(predicted(unseen, pixelsInformBy(3.), viewWith(kRows)), 0.);
    EXPECT_EQ(predicted(unseen, pixelsInformBy(3.), View()), 0.) << "no depth: nothing lacks";
}

/// Two rows of the last band show three times what the flight has seen.
TEST(UnseenInformation, IsRatherThatOfTheSameView) {
    UnseenInformation unseen;
    unseen.observe(viewWith(kRows), pixelsInformBy(1.));
    const double inLastRow = predicted(unseen, pixelsInformBy(3.), viewWith(kRows - 1)) / kWidth;
    EXPECT_GT(inLastRow, 2.);
    EXPECT_LT(inLastRow, 3.);
    EXPECT_NEAR(predicted(unseen, pixelsInformBy(3.), viewWith(9)) / kWidth, 3. * 1., 1e-9)
        << "another band says nothing of the last one";
}

/// Walls with texture, a floor without.
TEST(UnseenInformation, DependsOnTheAngleToTheHorizon) {
    UnseenInformation unseen;
    const InformationModel walls = pixelsInform([](unsigned row) { return row < 6 ? 2. : 0.; });
    unseen.observe(viewWith(kRows), walls);
    EXPECT_NEAR(predicted(unseen, walls, viewWith(0)), 2. * 6 * kWidth, 1e-9);
    EXPECT_NEAR(predicted(unseen, walls, viewWith(6)), 0., 1e-9);
}

TEST(UnseenInformation, BandsThatShowLittleDoNotStandForTheirSurroundings) {
    UnseenInformation unseen;
    unseen.observe(viewWith(1), pixelsInformBy(4.));
    EXPECT_EQ(unseen.average(0)(0, 0), 0.);
    unseen.observe(viewWith(2), pixelsInformBy(4.));
    EXPECT_NEAR(unseen.average(0)(0, 0), 4., 1e-9);
    EXPECT_EQ(unseen.average(1)(0, 0), 0.);
}

TEST(UnseenInformation, AveragesTheLastViews) {
    UnseenInformation unseen;
    unseen.observe(viewWith(kRows), pixelsInformBy(10.));
    unseen.observe(viewWith(kRows), pixelsInformBy(20.));
    EXPECT_NEAR(unseen.average(2)(0, 0), 15., 1e-9);
    for (int i = 0; i < 100; ++i) unseen.observe(viewWith(kRows), pixelsInformBy(0.));
    for (int i = 0; i < 60; ++i) unseen.observe(viewWith(kRows), pixelsInformBy(10.));
    EXPECT_GT(unseen.average(2)(0, 0), 9.);
}

}  // namespace
}  // namespace photonav
