// SPDX-License-Identifier: BSD-3-Clause
// The best paths known for a problem, by alpha, in two CSV files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

struct ReferencePath {
    double alpha = 0.;
    double cost = 0.;  ///< J with this alpha
    double length = 0., meanTrace = 0., goalTrace = 0.;
    std::string planner = {};  ///< that found the path from which the descent started
    unsigned vertices = 0, labels = 0;
    std::uint32_t seed = 0;
    std::vector<Pose> waypoints = {};  ///< body poses T_w_b, start and goal included
};

/// FILE.csv holds the numbers, after lines that begin with # and describe the search, a row
/// per alpha in rising order; FILE_paths.csv beside it the waypoints (alpha, x, y, z, yaw), so that
/// the costs can be checked. Roll and pitch are not kept.
class ReferenceTable {
  public:
    /// Reads what is there; empty if nothing is.
    /// @throws InputError naming file and line
    explicit ReferenceTable(std::filesystem::path file);

    void read();
    void write() const;

    /// Adds a line to the file about the search that was done, unless the line is already there.
    void addNote(const std::string& text);

    /// Stores a path if there is none with its alpha yet, or only a costlier one.
    bool offer(const ReferencePath& path);
    const ReferencePath* at(double alpha) const;
    void drop(double alpha);
    std::vector<double> alphas() const;

  private:
    std::filesystem::path pathsFile() const;
    void readFiles();

    std::filesystem::path file_;
    std::vector<std::string> notes_;
    std::map<long, ReferencePath> rows_;  // by alpha in millionths
};

}  // namespace photonav
