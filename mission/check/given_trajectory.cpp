// SPDX-License-Identifier: BSD-3-Clause
#include "check/given_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>

#include "config/config.hpp"
#include "dataset/trajectory.hpp"
#include "geometry/se3.hpp"
#include "io/number.hpp"
#include "io/reading.hpp"
#include "io/text_table.hpp"

namespace photonav {
namespace {

constexpr double kFarthestPose = 1e5;  // of positions, as of the bounds of a config [m]
constexpr double kLongest = 1e5;       // of trajectories [m]
constexpr std::size_t kTumColumns = 8, kKittiColumns = 12;
constexpr double kLeastSlope = 1e-3;  // a steeper motion has no direction from above

constexpr double kNanosecond = 1e-9, kLeastNanoseconds = 1e16;  // [s], of times without a unit

enum Column { kTime, kX, kY, kZ, kYaw, kQx, kQy, kQz, kQw, kColumnCount };

/// The places of the columns in a row.
struct Columns : std::array<std::optional<std::size_t>, kColumnCount> {
    bool hasNanoseconds = false;  ///< as the name of the times says
    bool has(std::initializer_list<Column> columns) const {
        return std::ranges::all_of(columns, [&](Column c) { return (*this)[c].has_value(); });
    }
};

/// A comma at the end of a line ends its last field.
std::size_t fieldsOf(const std::string& line, bool hasCommas) {
    if (hasCommas) {
        const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
        const bool endsWithOne = line.find_last_not_of(" \t\r") == line.rfind(',');
        return commas + (endsWithOne ? 0 : 1);
    }
    std::istringstream fields(line);
    return static_cast<std::size_t>(std::distance(std::istream_iterator<std::string>(fields), {}));
}

/// The first line that is not blank, nor a comment: it decides what the file is.
struct FirstLine {
    std::string text;
    bool hasCommas;
    std::size_t fields;
    std::string comment;  ///< the last line before it, without its '#'; may be empty

    /// Whether it is one of a table of as many columns, with blanks between them.
    bool isOf(std::size_t columns) const { return !hasCommas && fields == columns; }
    bool beginsWithNumber() const {
        return numberIn(text.substr(0, text.find_first_of(" \t"))).has_value();
    }
};

FirstLine firstLineOf(const std::string& file) {
    std::ifstream in = openText(file);
    std::string comment;
    for (std::string line; std::getline(in, line);) {
        const std::size_t begin = line.find_first_not_of(" \t\r");
        if (begin == std::string::npos) continue;
        line.erase(0, begin);
        if (line[0] == '#') {
            comment = line.substr(1);
            continue;
        }
        const bool hasCommas = line.find(',') != std::string::npos;
        return {line, hasCommas, fieldsOf(line, hasCommas), comment};
    }
    throw InputError(file, "", "no poses");
}

TrajectoryFormat formatOf(const FirstLine& first) {
    if (!first.beginsWithNumber()) return TrajectoryFormat::table;
    if (first.isOf(kTumColumns)) return TrajectoryFormat::tum;
    return first.isOf(kKittiColumns) ? TrajectoryFormat::kitti : TrajectoryFormat::table;
}

std::optional<Column> columnNamed(const std::string& name) {
    static const std::array<std::vector<std::string>, kColumnCount> kNames{
        {{"t", "time", "timestamp"},
         {"x", "tx", "px", "p_x", "p_rs_r_x"},
         {"y", "ty", "py", "p_y", "p_rs_r_y"},
         {"z", "tz", "pz", "p_z", "p_rs_r_z"},
         {"yaw", "heading"},
         {"qx", "q_x", "q_rs_x"},
         {"qy", "q_y", "q_rs_y"},
         {"qz", "q_z", "q_rs_z"},
         {"qw", "q_w", "q_rs_w"}}};
    std::string lower = name.substr(0, name.find_first_of(" ["));  // without its unit
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (std::find(kNames[i].begin(), kNames[i].end(), lower) != kNames[i].end()) {
            return static_cast<Column>(i);
        }
    }
    return {};
}

/// The columns by names. Nothing where there is a number in place of a name.
std::optional<Columns> columnsNamedBy(const TextRow& row, std::size_t count) {
    Columns columns;
    bool isNamed = false;
    for (std::size_t i = 0; i < count; ++i) {
        const auto column = columnNamed(row.text(i));
        if (!column) continue;
        if (columns[*column]) row.fail(fmt::format("two columns '{}'", row.text(i)));
        columns[*column] = i;
        isNamed = true;
        if (*column == kTime)
            columns.hasNanoseconds = row.text(i).find("[ns]") != std::string::npos;
    }
    if (!isNamed) return {};
    if (!columns.has({kX, kY, kZ})) row.fail("the names of the columns must include x, y and z");
    const bool hasRotation = columns[kQx] || columns[kQy] || columns[kQz] || columns[kQw];
    if (hasRotation && !columns.has({kQx, kQy, kQz, kQw})) {
        row.fail("the names of the columns must include qx, qy, qz and qw, or none of them");
    }
    return columns;
}

/// The columns by a comment before the rows; nothing if it does not name them.
std::optional<Columns> columnsOfComment(const std::string& file, const FirstLine& first) {
    if (!first.hasCommas || fieldsOf(first.comment, true) != first.fields) return {};
    try {
        return columnsNamedBy(TextRow(file, 0, splitAtCommas(first.comment)), first.fields);
    } catch (const InputError&) {
        return {};
    }
}

/// The columns of a table without names.
Columns columnsOf(const TextRow& row, std::size_t count) {
    if (count == 3) return {{std::nullopt, 0, 1, 2}};
    if (count == 5) return {{0, 1, 2, 3, 4}};
    if (count == 4) {
        row.fail("four columns may be t,x,y,z or x,y,z,yaw: name them in a first line");
    }
    row.fail(
        fmt::format("{} columns; expected x,y,z, t,x,y,z,yaw or a first line with their names, "
                    "such as t,tx,ty,tz,qx,qy,qz,qw",
                    count));
}

struct Row {
    std::optional<double> time, yaw;
    Eigen::Vector3d position;
    std::optional<Pose> T_w_c = {};  ///< of a row with a quaternion
};

double timeOf(const TextRow& row, const Columns& columns) {
    const std::size_t place = *columns[kTime];
    const bool isLarge = std::abs(row.number(place)) >= kLeastNanoseconds;
    return row.time(place, columns.hasNanoseconds || isLarge ? kNanosecond : 1.);
}

Row rowOf(const TextRow& row, const Columns& columns) {
    const auto number = [&](Column column) { return row.number(*columns[column]); };
    Row read;
    if (columns[kTime]) read.time = timeOf(row, columns);
    if (columns[kYaw]) read.yaw = number(kYaw);
    if (read.yaw && std::abs(*read.yaw) > kLargestHeading) {
        row.fail(fmt::format("a heading beyond {} rad", kLargestHeading));
    }
    read.position = {number(kX), number(kY), number(kZ)};
    if (read.position.cwiseAbs().maxCoeff() > kFarthestPose) {
        row.fail(fmt::format("farther than {} m from the origin", kFarthestPose));
    }
    if (columns[kQw]) {
        const Eigen::Quaterniond q(number(kQw), number(kQx), number(kQy), number(kQz));
        read.T_w_c = poseOfRow(row, 0., read.position, q).T_w_c;
    }
    return read;
}

std::vector<Row> readRows(const std::string& file, const FirstLine& first) {
    const std::vector<TextRow> table =
        first.hasCommas ? readCsv(file, first.fields) : readTable(file, first.fields);
    if (table.empty()) throw InputError(file, "", "no poses");
    const auto named = columnsNamedBy(table.front(), first.fields);
    const auto comment = columnsOfComment(file, first);
    const Columns columns = named     ? *named
                            : comment ? *comment
                                      : columnsOf(table.front(), first.fields);
    std::vector<Row> rows;
    for (std::size_t i = named ? 1 : 0; i < table.size(); ++i) {
        rows.push_back(rowOf(table[i], columns));
        if (rows.size() < 2 || !columns[kTime]) continue;
        const double before = *rows[rows.size() - 2].time, now = *rows.back().time;
        if (now < before) {
            table[i].fail(fmt::format("time {} after {}: times must not decrease", now, before));
        }
    }
    return rows;
}

/// The heading of every row: its own, or else the one that is wanted, or where it flies to.
std::vector<double> headingsOf(const std::vector<Row>& rows, const GivenHeading& wanted) {
    std::vector<double> headings(rows.size(), wanted.value_or(0.));
    std::optional<double> last;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].yaw) {
            headings[i] = *rows[i].yaw;
            continue;
        }
        if (wanted) continue;
        if (i + 1 < rows.size()) {
            const Eigen::Vector3d way = rows[i + 1].position - rows[i].position;
            if (way.head<2>().norm() > kLeastSlope * way.norm())
                last = std::atan2(way.y(), way.x());
        }
        headings[i] = last.value_or(0.);
    }
    return headings;
}

GivenTrajectory readPoses(const std::string& file, const Pose& T_b_c, TrajectoryFormat format) {
    GivenTrajectory trajectory{format, true, {}};
    const bool isKitti = format == TrajectoryFormat::kitti;
    for (const auto& [timestamp, T_w_c] :
         isKitti ? readKittiTrajectory(file) : readTrajectory(file)) {
        if (T_w_c.translation().cwiseAbs().maxCoeff() > kFarthestPose) {
            throw InputError(file,
                             isKitti ? fmt::format("pose {}", 1. + timestamp)
                                     : fmt::format("pose at time {}", timestamp),
                             fmt::format("farther than {} m from the origin", kFarthestPose));
        }
        const std::optional<double> time = isKitti ? std::nullopt : std::optional(timestamp);
        trajectory.poses.push_back({time, T_w_c * T_b_c.inverse()});
    }
    return trajectory;
}

GivenTrajectory readTableOf(const std::string& file, const FirstLine& first, const Pose& T_b_c,
                            const GivenHeading& heading) {
    const std::vector<Row> rows = readRows(file, first);
    GivenTrajectory trajectory;
    if (!rows.empty() && rows.front().T_w_c) {
        trajectory = {TrajectoryFormat::csv, true, {}};
        for (const Row& row : rows) {
            trajectory.poses.push_back({row.time, *row.T_w_c * T_b_c.inverse()});
        }
        return trajectory;
    }
    trajectory.hasHeading = !rows.empty() && rows.front().yaw.has_value();
    const std::vector<double> headings = headingsOf(rows, heading);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        trajectory.poses.push_back({rows[i].time, levelPose(rows[i].position, headings[i])});
    }
    return trajectory;
}

void check(const GivenTrajectory& trajectory, const std::string& file) {
    const std::vector<GivenPose>& poses = trajectory.poses;
    if (poses.size() < 2) {
        throw InputError(file, "", fmt::format("{} pose; at least two are needed", poses.size()));
    }
    const bool isStill = std::all_of(poses.begin(), poses.end(), [&](const GivenPose& pose) {
        return (pose.T_w_b.matrix() - poses.front().T_w_b.matrix()).cwiseAbs().maxCoeff() < 1e-6;
    });
    if (isStill) throw InputError(file, "", "all poses are the same");
    const double length = lengthOf(trajectory);
    if (length > kLongest) {
        throw InputError(file, "", fmt::format("{:.3g} m long; at most {} m", length, kLongest));
    }
}

}  // namespace

GivenTrajectory readGivenTrajectory(const std::string& file, const Pose& T_b_c,
                                    const GivenHeading& heading) {
    return reading(file, [&] {
        const FirstLine first = firstLineOf(file);
        const TrajectoryFormat format = formatOf(first);
        GivenTrajectory trajectory = format == TrajectoryFormat::table
                                         ? readTableOf(file, first, T_b_c, heading)
                                         : readPoses(file, T_b_c, format);
        check(trajectory, file);
        return trajectory;
    });
}

double lengthOf(const GivenTrajectory& trajectory) {
    const std::vector<GivenPose>& poses = trajectory.poses;
    double length = 0.;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        length += (poses[i].T_w_b.translation() - poses[i - 1].T_w_b.translation()).norm();
    }
    return length;
}

Eigen::AlignedBox3d boxAround(const GivenTrajectory& trajectory) {
    Eigen::AlignedBox3d box;
    for (const GivenPose& pose : trajectory.poses) box.extend(pose.T_w_b.translation());
    return box;
}

}  // namespace photonav
