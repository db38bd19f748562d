// SPDX-License-Identifier: BSD-3-Clause
#include "interchange/result_export.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "bag/mcap_writer.hpp"
#include "dataset/trajectory.hpp"
#include "flightlog/flight_log.hpp"
#include "geometry/se3.hpp"
#include "interchange/drawn_result.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Messages to channels by topic.
class Topics {
  public:
    explicit Topics(double start) : start_(start), last_(start) {}

    void add(const std::string& topic, const char* schema, double time, std::string message) {
        auto channel = channels_.find(topic);
        if (channel == channels_.end()) {
            channel =
                channels_.emplace(topic, writer_.addChannel(topic, schema, messageSchema(schema)))
                    .first;
        }
        writer_.add(channel->second, time, std::move(message));
        last_ = std::max(last_, time);
    }

    void pose(const std::string& topic, double time, const Pose& T_w_c) {
        add(topic, "foxglove.PoseInFrame", time, poseMessage(time, T_w_c));
    }
    void points(const std::string& topic, double time, const GreyPoints& points) {
        add(topic, "foxglove.PointCloud", time, pointCloudMessage(time, points));
    }
    void path(const std::string& topic, double time, const DrawnPath& path) {
        add(topic, "foxglove.SceneUpdate", time, pathMessage(time, path));
    }
    void image(const std::string& topic, double time, const std::string& bytes) {
        if (bytes.empty()) return;
        add(topic, "foxglove.CompressedImage", time, imageMessage(time, bytes, "jpeg"));
    }
    void belief(const std::string& topic, double time, const PathPoint& point) {
        add(topic, "photonav.Belief", time, beliefMessage(point));
    }

    McapExport finished() const { return {writer_.content(), writer_.messages(), last_ - start_}; }

  private:
    double start_, last_;
    McapWriter writer_;
    std::map<std::string, McapWriter::ChannelId> channels_;
};

/// "belief_rrt_star" of a name for legends.
std::string topicOf(const std::string& name) {
    std::string topic;
    for (const char c : name) {
        const bool isPlain = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (isPlain)
            topic += c;
        else if (!topic.empty() && topic.back() != '_')
            topic += '_';
    }
    while (topic.ends_with('_')) topic.pop_back();
    return topic;
}

/// Times of the points of a path: those of the trajectory beside the report where it has as many.
std::vector<double> timesOf(const DrawnPath& path, const Trajectory& trajectory) {
    std::vector<double> times(path.points.size());
    const bool isRecorded = trajectory.size() == path.points.size();
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        times[i] = isRecorded ? trajectory[i].timestamp : path.points[i].distance;
    }
    return times;
}

void addPaths(const std::vector<DrawnPath>& paths, const Trajectory& trajectory, double start,
              Topics& topics) {
    for (const DrawnPath& path : paths) {
        const std::string name = topicOf(path.name);
        topics.path("/path/" + name, start, path);
        const std::vector<double> times = timesOf(path, trajectory);
        for (std::size_t i = 0; i < times.size(); ++i) {
            topics.pose("/pose/" + name, times[i], path.points[i].T_w_c);
            topics.belief("/belief/" + name, times[i], path.points[i]);
        }
    }
}

/// The cells of a map that grows.
class GrowingCells {
  public:
    /// @returns whether they have become so many more that they are worth a message
    bool update(const CellChanges& changes) {
        for (std::size_t i = 0; i < changes.greys.size(); ++i) {
            const std::array<std::int16_t, 3> cell{
                changes.indices[3 * i], changes.indices[3 * i + 1], changes.indices[3 * i + 2]};
            if (changes.greys[i] == CellChanges::kGone) {
                cells_.erase(cell);
            } else {
                cells_[cell] = changes.greys[i];
            }
        }
        constexpr double kGrowth = 1.1;  // keeps the file a small multiple of the last map
        if (static_cast<double>(cells_.size()) < kGrowth * static_cast<double>(sent_)) return false;
        sent_ = cells_.size();
        return sent_ > 0;
    }

    GreyPoints points(double size) const {
        GreyPoints points;
        for (const auto& [cell, grey] : cells_) {
            const Eigen::Vector3f index(cell[0], cell[1], cell[2]);
            points.add(static_cast<float>(size) * (index.array() + 0.5F).matrix(), grey);
        }
        return points;
    }

  private:
    std::map<std::array<std::int16_t, 3>, std::uint8_t> cells_;
    std::size_t sent_ = 0;
};

void addFlown(const std::vector<FlownPoint>& flown, Topics& topics) {
    for (const FlownPoint& point : flown) {
        const Pose believed = levelPose(point.believed.cast<double>(), point.yaw);
        const Pose truth = levelPose(point.truth.cast<double>(), point.yaw);
        topics.pose("/flight/believed", point.time, believed);
        topics.pose("/flight/true", point.time, truth);
    }
}

void addFlight(const FlightLog& log, Topics& topics) {
    GrowingCells cells;
    for (const LoggedMoment& moment : log.moments) {
        const double time = moment.update.time;
        addFlown(moment.flown, topics);
        topics.path("/flight/plan", time, {"plan", plannerColor(log.planner), moment.plan});
        topics.belief("/flight/belief", time, moment.robot);
        topics.image("/camera/observed", time, moment.pictures.observed);
        topics.image("/camera/predicted", time, moment.pictures.predicted);
        if (cells.update(moment.cells)) topics.points("/flight/map", time, cells.points(log.cell));
    }
    addFlown(log.rest, topics);
    if (!log.moments.empty()) {
        topics.points("/flight/map", log.moments.back().update.time, cells.points(log.cell));
    }
}

Trajectory trajectoryIn(const fs::path& folder) {
    const fs::path file = folder / "trajectory.tum";
    return fs::exists(file) ? readTrajectory(file.string()) : Trajectory();
}

}  // namespace

McapExport exportMcap(const fs::path& folder, const std::string& content) {
    return reading((folder / "report.json").string(), [&] {
        const json report = json::parse(content);
        const std::vector<DrawnPath> paths = drawnPaths(report);
        const Trajectory trajectory = trajectoryIn(folder);
        const bool isRecorded = std::ranges::any_of(paths, [&](const DrawnPath& path) {
            return path.points.size() == trajectory.size() && !trajectory.empty();
        });
        const double start = isRecorded ? trajectory.front().timestamp : 0.;
        Topics topics(start);
        const GreyPoints surroundings = drawnSurroundings(report);
        if (!surroundings.grey.empty()) topics.points("/map", start, surroundings);
        addPaths(paths, trajectory, start, topics);
        if (report.contains("flight")) addFlight(flightLogFrom(report["flight"]), topics);
        return topics.finished();
    });
}

}  // namespace photonav
