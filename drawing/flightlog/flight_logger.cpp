// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/flight_logger.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "geometry/se3.hpp"
#include "problem/tree_evolution.hpp"

namespace photonav {
namespace {

constexpr double kFlownApart = 0.1;        // points of the way [s]
constexpr double kInformationApart = 1.5;  // maps of information [s]
constexpr std::size_t kMostPlanPoints = 60;
constexpr int kJpegQuality = 85;

std::string encoded(const vpImage<unsigned char>& grey, const char* kind,
                    const std::vector<int>& settings) {
    const cv::Mat pixels(static_cast<int>(grey.getHeight()), static_cast<int>(grey.getWidth()),
                         CV_8UC1, grey.bitmap);
    std::vector<unsigned char> bytes;
    cv::imencode(kind, pixels, bytes, settings);
    return {bytes.begin(), bytes.end()};
}

std::string jpegOf(const ImageF& image) {
    vpImage<unsigned char> grey(image.getHeight(), image.getWidth());
    for (unsigned i = 0; i < image.getSize(); ++i) grey.bitmap[i] = greyLevel(image.bitmap[i]);
    return encoded(grey, ".jpg", {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
}

std::string pngOf(const vpImage<unsigned char>& grid) {
    return encoded(grid, ".png", {cv::IMWRITE_PNG_COMPRESSION, 9});
}

/// Not all points of a long plan; its waypoints matter less than where beliefs change.
std::vector<PathPoint> drawnPlan(const OnlinePlanner& planner) {
    const std::vector<BeliefPoint>& path = planner.path();
    const Pose T_b_c = planner.config().camera.T_b_c();
    const std::size_t step = path.size() / kMostPlanPoints + 1;
    std::vector<PathPoint> points;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const BeliefPoint& point = path[i];
        if (i % step != 0 && i + 1 < path.size() && !point.isWaypoint) continue;
        points.push_back(makePathPoint({(point.T_w_b * T_b_c).inverse(), point.covariance},
                                       point.trace, point.length, point.cost));
    }
    return points;
}

Eigen::AlignedBox2d areaAround(const Config& config) {
    Eigen::AlignedBox2d area(config.bounds.min().head<2>(), config.bounds.max().head<2>());
    area.min().array() -= config.robotRadius;
    area.max().array() += config.robotRadius;
    return area;
}

}  // namespace

FlightLogger::FlightLogger(const Config& config, const World& world, const TrialItem& item,
                           std::size_t mostPictures)
    : characteristicLength_(config.belief.characteristicLength),
      mostPictures_(mostPictures),
      T_c_b_(config.camera.T_b_c().inverse()),
      cells_(config.bounds, config.explore.cell()),
      seen_(areaAround(config)) {
    log_.planner = item.planner;
    log_.seed = item.seed;
    log_.box = config.bounds;
    log_.scene = world.extent();
    log_.area = areaAround(config);
    log_.cell = cells_.size();
}

void FlightLogger::add(const ExplorationMoment& moment) {
    LoggedMoment logged;
    logged.update = moment.soFar.updates.back();
    logged.length = moment.soFar.flown;
    logged.robot =
        makePathPoint(moment.T_c_w, logged.update.trace, logged.length, logged.update.cost);
    logged.flown = flownSince(moment.soFar.samples, false);
    logged.plan = drawnPlan(moment.planner);
    logged.cells = cells_.update(*moment.map.cells(), moment.change);
    seen_.update(moment.change, logged.robot.position.z());
    if (log_.moments.size() % stride_ == 0) logged.pictures = picturesOf(moment);
    log_.moments.push_back(std::move(logged));
    if ((log_.moments.size() - 1) / stride_ >= mostPictures_) thinOut();
}

MomentPictures FlightLogger::picturesOf(const ExplorationMoment& moment) {
    MomentPictures pictures;
    pictures.tree = drawnEdges(moment.planner.planner());
    pictures.observed = jpegOf(moment.image.intensity);
    pictures.predicted = jpegOf(moment.predicted.intensity);
    pictures.obstacles = pngOf(obstacleGrid(moment, seen_, log_.area));
    const double time = moment.soFar.updates.back().time;
    if (time >= lastInformation_ + kInformationApart) {
        lastInformation_ = time;
        pictures.information = pngOf(informationGrid(moment, seen_, log_.area));
    }
    return pictures;
}

/// Every second moment that has pictures loses them.
void FlightLogger::thinOut() {
    stride_ *= 2;
    for (std::size_t i = 0; i < log_.moments.size(); ++i) {
        if (i % stride_ != 0) log_.moments[i].pictures = {};
    }
}

std::vector<FlownPoint> FlightLogger::flownSince(const std::vector<FlightSample>& samples,
                                                 bool isEnd) {
    std::vector<FlownPoint> flown;
    for (; samples_ < samples.size(); ++samples_) {
        const FlightSample& sample = samples[samples_];
        const bool isLast = isEnd && samples_ + 1 == samples.size();
        if (sample.time < lastFlown_ + kFlownApart && !isLast) continue;
        lastFlown_ = sample.time;
        const auto place = [](const Pose& T_c_w) -> Eigen::Vector3f {
            return T_c_w.inverse().translation().cast<float>();
        };
        flown.push_back(
            {static_cast<float>(sample.time), static_cast<float>(sample.distance),
             place(sample.belief.mean), place(sample.T_c_w),
             static_cast<float>(weightedTrace(sample.belief.covariance, characteristicLength_)),
             static_cast<float>(yawOf(sample.belief.mean.inverse() * T_c_b_))});
    }
    return flown;
}

void FlightLogger::finish(const ExplorationResult& flight) {
    log_.rest = flownSince(flight.samples, true);
    log_.end = nameOf(flight.end);
    log_.reason = flight.reason;
}

}  // namespace photonav
