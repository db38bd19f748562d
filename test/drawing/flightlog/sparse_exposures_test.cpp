// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/sparse_exposures.hpp"

#include <gtest/gtest.h>

#include "recording/halved_view.hpp"

namespace photonav {
namespace {

Exposed exposedAt(double time, unsigned width = 8) {
    Exposed exposed;
    exposed.time = time;
    exposed.image = ImageF(width / 2, width, 0.5F);
    exposed.depth = ImageF(width / 2, width, 1.F);
    return exposed;
}

TEST(SparseExposures, KeepsAllWhileTheyAreFew) {
    SparseExposures exposures(4);
    for (int i = 0; i < 4; ++i) exposures.add(exposedAt(i));
    ASSERT_EQ(exposures.kept().size(), 4U);
    EXPECT_EQ(exposures.kept().back().time, 3.);
}

TEST(SparseExposures, AreEvenlyApartAndNeverMoreThanWanted) {
    SparseExposures exposures(4);
    for (int i = 0; i < 1000; ++i) {
        exposures.add(exposedAt(i));
        ASSERT_LE(exposures.kept().size(), 4U);
        const double apart = exposures.kept().size() > 1 ? exposures.kept()[1].time : 1.;
        for (std::size_t k = 0; k < exposures.kept().size(); ++k) {
            ASSERT_EQ(exposures.kept()[k].time, static_cast<double>(k) * apart);
        }
    }
    EXPECT_GE(exposures.kept().size(), 2U);
}

TEST(SparseExposures, AreSmallEnoughToBeLookedAt) {
    SparseExposures exposures;
    exposures.add(exposedAt(0., 2 * kShownWidth + 2));
    const View& view = exposures.kept().front().view;
    EXPECT_LE(view.intensity.getWidth(), kShownWidth);
    EXPECT_EQ(view.depth.getWidth(), view.intensity.getWidth());
}

}  // namespace
}  // namespace photonav
