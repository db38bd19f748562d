// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "estimation/tracker.hpp"
#include "geometry/gaussian.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kOblique;

const Camera& filterCamera() {
    static const Camera small = makeCamera(94, 60, 1.2);
    return small;
}

/// Motion forward of 10 cm with a turn, and its noise.
UncertainPose motion() {
    Vector6 xi;
    xi << 0.02, 0., -0.1, 0., 0.03, 0.;
    Vector6 sigmas;
    sigmas << 0.01, 0.01, 0.01, 0.005, 0.005, 0.005;
    return {expSE3(xi), sigmas.cwiseAbs2().asDiagonal()};
}

/// Odometry between images, an image at each.
class Filter {
  public:
    Filter(const ViewSource& map, const UncertainPose& start, const AlignmentOptions& options)
        : tracker_({std::shared_ptr<void>(), &map}, filterCamera(), start, {.map = options}) {}

    TrackedFrame update(const UncertainPose& T_next_now, const ImageF& image) {
        Observation observation;
        observation.time = ++time_;
        observation.T_next_now = T_next_now;
        observation.frames.push_back({time_, {image, {}}});
        return tracker_.update(observation).front();
    }
    const UncertainPose& belief() const { return tracker_.beliefAtLastImage(); }

  private:
    double time_ = 0.;
    Tracker tracker_;
};

/// A lost image leaves what the planner predicts.
TEST(Filter, PropagatesAsThePlannerDoes) {
    const MeshRenderer room(test::texturedRoom());
    const UncertainPose start{lookFrom({2., 3., 1.5}, kOblique), 1e-3 * Matrix6::Identity()};
    Filter filter(room, start, {});
    const ImageF black(filterCamera().height, filterCamera().width, 0.F);
    EXPECT_TRUE(filter.update(motion(), black).rejected);
    const UncertainPose planned = compound(motion(), start);
    EXPECT_TRUE(filter.belief().mean.isApprox(planned.mean, 1e-12));
    EXPECT_TRUE(filter.belief().covariance.isApprox(planned.covariance, 1e-9));
}

/// Flights of five steps: the final NEES per degree of freedom must be one. On a floor of faint
/// texture odometry and images count about equally, so an error in either would show.
TEST(Filter, IsConsistentAlongFlights) {
    const MeshRenderer floor(
        test::floorOf(valueNoise({.amplitudes = {0.004, 0.003, 0.002}, .seed = 4})));
    AlignmentOptions options;
    options.trust.openSigma = 0.5;
    std::mt19937_64 random(11);
    const Matrix6 startCovariance = motion().covariance;
    double sum = 0., odometry = 0., final = 0.;
    const int flights = 60;
    for (int flight = 0; flight < flights; ++flight) {
        Pose truth = lookFrom({0.1 * flight - 3., 1., 1.5}, 1.1, 0.2 * flight);
        Filter filter(floor,
                      {expSE3(draw(rootOf(startCovariance), random)) * truth, startCovariance},
                      options);
        for (int step = 0; step < 5; ++step) {
            truth = expSE3(draw(rootOf(motion().covariance), random)) * motion().mean * truth;
            odometry += compound(motion(), filter.belief()).covariance.trace();
            View view;
            floor.render(filterCamera(), truth, view);
            const TrackedFrame frame =
                filter.update(motion(), test::noisy(view.intensity, 0.02, random));
            ASSERT_FALSE(frame.rejected) << describe(frame.alignment);
            final += filter.belief().covariance.trace();
        }
        const Vector6 xi = logSE3(truth * filter.belief().mean.inverse());
        sum += xi.dot(filter.belief().covariance.ldlt().solve(xi)) / 6.;
    }
    const double sigma = std::sqrt(2. / (6. * flights));
    std::cout << "NEES per dof " << sum / flights << ", chi-square 95 % [" << 1. - 1.96 * sigma
              << ", " << 1. + 1.96 * sigma << "], images keep " << final / odometry
              << " of the trace\n";
    EXPECT_NEAR(sum / flights, 1., 3. * sigma);
    EXPECT_LT(final, 0.9 * odometry);
    EXPECT_GT(final, 0.1 * odometry);
}

/// Hovering over bars along y: neither what central differences say along an edge that is askew,
/// nor a prior turned by half of a correction may ever inform of y.
TEST(Filter, BarsDoNotInformAlongThem) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 0.5, .softEdge = 0.05})));
    AlignmentOptions options;
    options.photometric.scale = 0.1;
    std::mt19937_64 random(5);
    Vector6 sigmas;
    sigmas << 0.02, 0.5, 0.02, 0.005, 0.005, 0.03;
    const Matrix6 before = sigmas.cwiseAbs2().asDiagonal();
    sigmas << 0.002, 0.002, 0.002, 0.002, 0.002, 0.01;
    const UncertainPose hover{Pose::Identity(), sigmas.cwiseAbs2().asDiagonal()};
    Pose truth = lookFrom({0.1, 0., 2.}, test::kDown, test::kDown);
    Filter filter(bars, {expSE3(draw(rootOf(before), random)) * truth, before}, options);
    for (int image = 0; image < 40; ++image) {
        truth = expSE3(draw(rootOf(hover.covariance), random)) * truth;
        View view;
        bars.render(filterCamera(), truth, view);
        filter.update(hover, test::noisy(view.intensity, 0.02, random));
    }
    const auto sigmaAlong = [&](int axis) {
        const Eigen::Vector3d axis_c = filter.belief().mean.linear().col(axis);
        const Matrix6& covariance = filter.belief().covariance;
        return std::sqrt(axis_c.dot(covariance.topLeftCorner<3, 3>() * axis_c));
    };
    EXPECT_LT(sigmaAlong(0), 0.02);
    EXPECT_GT(sigmaAlong(1), 0.3);  // without the one 0.005 m are left, without the other 0.12 m
}

}  // namespace
}  // namespace photonav
