// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/reference_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/durable_file.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "io/reading.hpp"
#include "io/text_table.hpp"
#include "space/flight_space.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr const char* kColumns =
    "alpha,cost,length,mean_trace,goal_trace,planner,vertices,labels,seed";
constexpr const char* kPathColumns = "alpha,x,y,z,yaw";

constexpr double kLeastCost = 1e-300;  // of a path: not 0

double inRange(double value, double least, double most) {
    if (!(value >= least && value <= most)) throw std::out_of_range("a number");
    return value;
}

long keyOf(double alpha) { return std::lround(alpha * 1e6); }

/// Calls `row` with the fields of every line after `header`.
/// @return the lines before it, which begin with #
template <typename Row>
std::vector<std::string> readCsv(const fs::path& file, const std::string& header,
                                 std::size_t columns, Row row) {
    std::ifstream stream = openText(file.string());
    std::vector<std::string> notes;
    std::string line;
    while (std::getline(stream, line) && line.starts_with('#')) notes.push_back(line);
    int number = static_cast<int>(notes.size()) + 1;
    if (line != header) {
        throw InputError(file.string(), fmt::format("line {}", number), "expected " + header);
    }
    while (std::getline(stream, line)) {
        ++number;
        std::vector<std::string> fields;
        std::istringstream text(line);
        for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
        try {
            if (fields.size() != columns) throw std::invalid_argument("columns");
            row(fields);
        } catch (const std::bad_alloc&) {
            throw InputError(file.string(), "", "needs more memory than there is");
        } catch (const std::exception&) {
            throw InputError(file.string(), fmt::format("line {}", number),
                             "expected numbers for " + header);
        }
    }
    return notes;
}

}  // namespace

ReferenceTable::ReferenceTable(fs::path file) : file_(std::move(file)) {
    if (file_.extension() != ".csv") throw InputError(file_.string(), "", "is not named *.csv");
}

fs::path ReferenceTable::pathsFile() const {
    return file_.parent_path() / (file_.stem().string() + "_paths.csv");
}

void ReferenceTable::read() {
    reading(file_.string(), [&] { readFiles(); });
}

void ReferenceTable::readFiles() {
    rows_.clear();
    notes_.clear();
    if (!fs::exists(file_)) {
        if (fs::exists(pathsFile())) readCsv(pathsFile(), kPathColumns, 5, [](const auto&) {});
        return;
    }
    notes_ = readCsv(file_, kColumns, 9, [&](const std::vector<std::string>& f) {
        const double alpha = inRange(toNumber(f[0]), 0., 1.);
        rows_[keyOf(alpha)] = {.alpha = alpha,
                               .cost = inRange(toNumber(f[1]), kLeastCost, kInfinity),
                               .length = inRange(toNumber(f[2]), 0., kInfinity),
                               .meanTrace = inRange(toNumber(f[3]), 0., kInfinity),
                               .goalTrace = inRange(toNumber(f[4]), 0., kInfinity),
                               .planner = f[5],
                               .vertices = toNumber<unsigned>(f[6]),
                               .labels = toNumber<unsigned>(f[7]),
                               .seed = toNumber<std::uint32_t>(f[8]),
                               .waypoints = {}};
    });
    readCsv(pathsFile(), kPathColumns, 5, [&](const std::vector<std::string>& f) {
        const Eigen::Vector3d p_w(toNumber(f[1]), toNumber(f[2]), toNumber(f[3]));
        // A path that came to the disk alone, before its row could be written, is none.
        const auto row = rows_.find(keyOf(toNumber(f[0])));
        if (row != rows_.end()) row->second.waypoints.push_back(levelPose(p_w, toNumber(f[4])));
    });
}

void ReferenceTable::write() const {
    std::string table;
    for (const std::string& note : notes_) table += note + "\n";
    table += std::string(kColumns) + "\n";
    std::string paths = std::string(kPathColumns) + "\n";
    for (const auto& [key, r] : best()) {
        table += fmt::format("{:.6g},{:.9g},{:.6g},{:.6g},{:.6g},{},{},{},{}\n", r.alpha, r.cost,
                             r.length, r.meanTrace, r.goalTrace, r.planner, r.vertices, r.labels,
                             r.seed);
        for (const Pose& T_w_b : r.waypoints) {
            const Eigen::Vector3d p = T_w_b.translation();
            paths +=
                fmt::format("{:.6g},{},{},{},{}\n", r.alpha, p.x(), p.y(), p.z(), yawOf(T_w_b));
        }
    }
    replaceFile(pathsFile(), paths);
    replaceFile(file_, table);
}

/// The rows, and those of an earlier search that are cheaper, until its alpha is searched to the
/// end.
std::map<long, ReferencePath> ReferenceTable::best() const {
    std::map<long, ReferencePath> all = rows_;
    for (const auto& [key, aside] : aside_) {
        const auto [row, isAlone] = all.emplace(key, aside);
        if (!isAlone && aside.cost < row->second.cost) row->second = aside;
    }
    return all;
}

void ReferenceTable::addNote(const std::string& text) {
    const std::string note = "# " + text;
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
}

bool ReferenceTable::offer(const ReferencePath& path) {
    const ReferencePath* known = at(path.alpha);
    if (known != nullptr && known->cost <= path.cost) return false;
    rows_[keyOf(path.alpha)] = path;
    return true;
}

const ReferencePath* ReferenceTable::at(double alpha) const {
    const auto it = rows_.find(keyOf(alpha));
    return it == rows_.end() ? nullptr : &it->second;
}

void ReferenceTable::drop(double alpha) { rows_.erase(keyOf(alpha)); }

void ReferenceTable::setAside(double alpha) {
    const auto row = rows_.extract(keyOf(alpha));
    if (!row.empty()) aside_[row.key()] = row.mapped();
}

void ReferenceTable::dropAside(double alpha) {
    if (at(alpha) != nullptr) aside_.erase(keyOf(alpha));
}

std::vector<double> ReferenceTable::alphas() const {
    std::vector<double> alphas;
    for (const auto& [key, row] : rows_) alphas.push_back(row.alpha);
    return alphas;
}

}  // namespace photonav
