// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/flight_log.hpp"

#include <gtest/gtest.h>

#include "drawing/flightlog/sample_log.hpp"

namespace photonav {
namespace {

using nlohmann::json;

TEST(FlightLog, IsTheSameAfterJson) {
    const FlightLog log = test::sampleLog();
    const json written = flightLogJson(log);
    const FlightLog read = flightLogFrom(json::parse(written.dump()));
    EXPECT_EQ(flightLogJson(read), written);
    ASSERT_EQ(read.moments.size(), 3U);
    const LoggedMoment& moment = read.moments[2];
    EXPECT_EQ(moment.cells.indices, log.moments[2].cells.indices);
    EXPECT_EQ(moment.cells.greys, log.moments[2].cells.greys);
    EXPECT_EQ(moment.pictures.observed, log.moments[2].pictures.observed);
    EXPECT_EQ(moment.flown[1].truth, log.moments[2].flown[1].truth);
    EXPECT_EQ(moment.flown[1].yaw, 0.1F);
    EXPECT_EQ(moment.update.counts.verticesAdded, 40U);
    EXPECT_NEAR(moment.plan[1].positionCovariance(2, 2), 0.01, 1e-8);
    // Edges keep their place to the 65535th part of the box.
    const Edge &edge = moment.pictures.tree[0], &before = log.moments[2].pictures.tree[0];
    EXPECT_LT((edge[1] - before[1]).norm(), 4. / 65535.);
    EXPECT_TRUE(read.moments[1].pictures.empty());
    EXPECT_EQ(read.rest.size(), 1U);
    EXPECT_EQ(read.end, "arrived");
}

TEST(FlightLog, RefusesWhatIsNoLog) {
    const json good = flightLogJson(test::sampleLog());
    const auto refuses = [&](const char* pointer, const json& value) {
        json bad = good;
        bad[json::json_pointer(pointer)] = value;
        EXPECT_ANY_THROW(flightLogFrom(bad)) << pointer;
    };
    EXPECT_NO_THROW(flightLogFrom(good));
    refuses("/moments/0/greys", "AAAA");  // fewer greys than cells
    refuses("/moments/0/cells", "AAAA");  // no whole cell
    refuses("/moments/0/plan", "not base64!!");
    refuses("/moments/0/update/vertices_added", -1);
    refuses("/moments/0/robot/position_covariance", json::array({1., 2.}));
    refuses("/header/cell", 0.);
    refuses("/header/box", json::array({{0., 0., 0.}, {-1., 1., 1.}}));
    refuses("/header/seed", "seven");
    EXPECT_ANY_THROW(flightLogFrom(json::object()));
}

TEST(FlightLog, LevelsOfInformationAreLogarithmic) {
    EXPECT_EQ(informationLevel(0.), 0);
    EXPECT_EQ(informationLevel(1.), 0);
    EXPECT_EQ(informationLevel(1e4) - informationLevel(1e3), kLevelsPerDecade);
    EXPECT_EQ(informationLevel(1e300), kNoInformation - 1);
    EXPECT_EQ(informationLevel(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace photonav
