// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dataset/time_order.hpp"
#include "geometry/se3.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

constexpr double kFarthestPosition = 1e8;  // [m]; more than twice around the earth

StampedPose parsePose(const TextRow& row) {
    std::array<double, 8> v{};
    for (std::size_t i = 1; i < v.size(); ++i) v[i] = row.number(i);
    return poseOfRow(row, row.time(0), {v[1], v[2], v[3]}, {v[7], v[4], v[5], v[6]});
}

}  // namespace

StampedPose poseOfRow(const TextRow& row, double timestamp, const Eigen::Vector3d& position,
                      const Eigen::Quaterniond& rotation) {
    if (!(std::abs(rotation.norm() - 1.) <= 0.1)) {
        row.fail(fmt::format("quaternion of norm {:.3g}, expected 1", rotation.norm()));
    }
    if (!(position.norm() <= kFarthestPosition)) {
        row.fail(fmt::format("position {:.3g} m from the origin", position.stableNorm()));
    }
    StampedPose pose;
    pose.timestamp = timestamp;
    pose.T_w_c.linear() = rotation.normalized().toRotationMatrix();
    pose.T_w_c.translation() = position;
    return pose;
}

Trajectory readTrajectory(const std::string& file, std::vector<InputError>* badRows) {
    return trajectoryOf(file, readTable(file, 8, badRows), parsePose, badRows);
}

Trajectory trajectoryOf(const std::string& file, const std::vector<TextRow>& rows,
                        const std::function<StampedPose(const TextRow&)>& parse,
                        std::vector<InputError>* badRows) {
    Trajectory trajectory = parseInOrderOfTime(rows, parse, Repeats::kept, badRows);
    if (!trajectory.empty()) return trajectory;
    throw InputError(file, "", "no poses");
}

std::string toLine(const StampedPose& pose) {
    const Eigen::Vector3d& t = pose.T_w_c.translation();
    const Eigen::Quaterniond q(pose.T_w_c.linear());
    return fmt::format("{:.6f} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", pose.timestamp,
                       t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

void writeTrajectory(const std::string& file, const Trajectory& trajectory) {
    std::string text = "# timestamp tx ty tz qx qy qz qw (camera to world)\n";
    for (const StampedPose& pose : trajectory) text += toLine(pose);
    writeFileAtomically(file, text);
}

Trajectory readKittiTrajectory(const std::string& file) {
    Trajectory trajectory;
    for (const TextRow& row : readTable(file, 12)) {
        Eigen::Matrix<double, 3, 4> T_w_c;
        for (int i = 0; i < 12; ++i) T_w_c(i / 4, i % 4) = row.number(static_cast<std::size_t>(i));
        const Eigen::Matrix3d R = T_w_c.leftCols<3>();
        const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (!(off <= 0.01 && R.determinant() > 0.)) row.fail("the matrix is no rotation");
        trajectory.push_back(poseOfRow(row, static_cast<double>(trajectory.size()), T_w_c.col(3),
                                       Eigen::Quaterniond(R)));
    }
    if (trajectory.empty()) throw InputError(file, "", "no poses");
    return trajectory;
}

void writeKittiTrajectory(const std::string& file, const Trajectory& trajectory) {
    std::string text;
    for (const StampedPose& pose : trajectory) {
        for (int i = 0; i < 12; ++i) {
            text += fmt::format("{}{:.9g}", i > 0 ? " " : "", pose.T_w_c.matrix()(i / 4, i % 4));
        }
        text += '\n';
    }
    writeFileAtomically(file, text);
}

std::optional<Pose> poseAt(const Trajectory& trajectory, double timestamp, double tolerance,
                           double maxGap) {
    if (trajectory.empty()) return {};
    const auto after = std::lower_bound(
        trajectory.begin(), trajectory.end(), timestamp,
        [](const StampedPose& pose, double time) { return pose.timestamp < time; });
    if (after != trajectory.end() && after->timestamp == timestamp) return after->T_w_c;
    if (after != trajectory.begin() && after != trajectory.end()) {
        const auto before = after - 1;
        const double gap = after->timestamp - before->timestamp;
        if (gap <= maxGap) {
            return interpolate(before->T_w_c, after->T_w_c, (timestamp - before->timestamp) / gap);
        }
    }
    auto nearest = after;
    if (after == trajectory.end() ||
        (after != trajectory.begin() &&
         timestamp - (after - 1)->timestamp < after->timestamp - timestamp)) {
        nearest = after - 1;
    }
    if (std::abs(nearest->timestamp - timestamp) > tolerance) return {};
    return nearest->T_w_c;
}

InputError noPoseNear(const std::string& file, const Trajectory& trajectory, double tolerance,
                      double first, double last) {
    return {file, "",
            fmt::format("no pose within {} s of any image: poses from {:.3f} to {:.3f} s, images "
                        "from {:.3f} to {:.3f} s",
                        tolerance, trajectory.front().timestamp, trajectory.back().timestamp, first,
                        last)};
}

const std::vector<std::string>& axisNames() {
    static const std::vector<std::string> names = {"x", "y", "z", "-x", "-y", "-z"};
    return names;
}

Eigen::Matrix3d worldUpRotation(std::string_view upAxis) {
    Eigen::Matrix3d R;  // rows: the new axes in recorded coordinates
    if (upAxis == "z") {
        R.setIdentity();
    } else if (upAxis == "-z") {
        R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    } else if (upAxis == "y") {
        R << 0, 0, -1, -1, 0, 0, 0, 1, 0;
    } else if (upAxis == "-y") {
        R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    } else if (upAxis == "x") {
        R << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    } else if (upAxis == "-x") {
        R << 0, 1, 0, 0, 0, -1, -1, 0, 0;
    } else {
        throw std::invalid_argument(
            fmt::format("up axis '{}' is not one of {}", upAxis, fmt::join(axisNames(), ", ")));
    }
    return R;
}

Eigen::Matrix3d worldUpRotation(const Eigen::Vector3d& up) {
    Eigen::Index axis = 0;
    up.cwiseAbs().maxCoeff(&axis);
    const auto& names = axisNames();
    const Eigen::Matrix3d R = worldUpRotation(names[axis + (up[axis] < 0. ? 3 : 0)]);
    return Eigen::Quaterniond::FromTwoVectors(R * up, Eigen::Vector3d::UnitZ()) * R;
}

}  // namespace photonav
