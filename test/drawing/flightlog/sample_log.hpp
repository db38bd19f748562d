// SPDX-License-Identifier: BSD-3-Clause
// The log of a made-up flight: 3 m along x in three moments, over cells that come, change and go.
#pragma once

#include <opencv2/imgcodecs.hpp>

#include "flightlog/flight_log.hpp"

namespace photonav::test {

inline std::string encodedImage(const char* kind, int rows, int columns, std::uint8_t grey) {
    cv::Mat image(rows, columns, CV_8UC1, cv::Scalar(grey));
    image.colRange(0, columns / 2).setTo(255);
    std::vector<unsigned char> bytes;
    cv::imencode(kind, image, bytes);
    return {bytes.begin(), bytes.end()};
}

inline PathPoint pointAt(double x, double sigma) {
    PathPoint point;
    point.position = {x, 1., 1.5};
    point.T_w_c.translation() = point.position;
    point.T_w_c.linear() << 0., 0., 1., -1., 0., 0., 0., -1., 0.;  // looks along x
    point.positionCovariance = sigma * sigma * Eigen::Matrix3d::Identity();
    point.trace = 3. * sigma * sigma;
    point.distance = x;
    return point;
}

inline LoggedMoment momentAt(int i) {
    const double x = i;
    LoggedMoment moment;
    moment.update.time = 1.5 * i;
    moment.update.counts = {3, 2, 40, 5};
    moment.update.viewsRendered = 17;
    moment.update.planSeconds = 0.05;
    moment.update.length = 3. - x;
    moment.update.cost = 4. - x;
    moment.length = x;
    moment.robot = pointAt(x, 0.02);
    moment.update.trace = moment.robot.trace;
    for (int k = 0; k < 3; ++k) {
        const float t = static_cast<float>(1.5 * i - 1.5 + 0.5 * (k + 1)), at = t / 1.5F;
        if (i > 0) moment.flown.push_back({t, at, {at, 1.F, 1.5F}, {at, 1.01F, 1.5F}, 1e-3F, 0.1F});
    }
    for (double along = x; along <= 3.; along += 0.5) moment.plan.push_back(pointAt(along, 0.1));
    return moment;
}

inline FlightLog sampleLog() {
    FlightLog log;
    log.planner = "belief_rrt_star";
    log.seed = 7;
    log.box = {Eigen::Vector3d(0., 0., 1.), Eigen::Vector3d(4., 2., 2.)};
    log.scene = {Eigen::Vector3d(-0.5, -0.5, 0.), Eigen::Vector3d(4.5, 2.5, 2.5)};
    log.area = {Eigen::Vector2d(-0.2, -0.2), Eigen::Vector2d(4.2, 2.2)};
    log.cell = 0.25;
    for (int i = 0; i < 3; ++i) {
        LoggedMoment& moment = log.moments.emplace_back(momentAt(i));
        for (std::int16_t cell = 0; cell < 6; ++cell) {
            moment.cells.indices.insert(moment.cells.indices.end(),
                                        {static_cast<std::int16_t>(6 * i + cell), cell, 0});
            moment.cells.greys.push_back(static_cast<std::uint8_t>(40 * cell));
        }
        if (i == 1) continue;  // without pictures
        moment.pictures = {{{Eigen::Vector3f(0.F, 1.F, 1.5F), Eigen::Vector3f(3.F, 0.5F, 1.25F)}},
                           encodedImage(".jpg", 60, 94, 90),
                           encodedImage(".jpg", 60, 94, 60),
                           encodedImage(".png", 22, 44, 85),
                           encodedImage(".png", 11, 22, 120)};
    }
    log.moments[2].cells.indices.insert(log.moments[2].cells.indices.end(), {0, 0, 0, 1, 1, 0});
    log.moments[2].cells.greys.insert(log.moments[2].cells.greys.end(), {CellChanges::kGone, 200});
    log.rest = {{3.5F, 2.5F, {2.5F, 1.F, 1.5F}, {2.5F, 1.F, 1.5F}, 2e-3F, 0.2F}};
    log.end = "arrived";
    return log;
}

}  // namespace photonav::test
