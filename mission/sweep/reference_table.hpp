// SPDX-License-Identifier: BSD-3-Clause
// The best known path of a problem for each alpha, stored in two CSV files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

struct ReferencePath {
    double alpha = 0.;
    double cost = 0.;                                    ///< J with this alpha
    double length = 0., meanTrace = 0., goalTrace = 0.;  ///< as in EvaluatedPath [m], [m^2], [m^2]
    std::string planner = {};           ///< planner of the path from which the descent started
    unsigned vertices = 0, labels = 0;  ///< effort of this planner
    std::uint32_t seed = 0;
    std::vector<Pose> waypoints = {};  ///< body poses T_w_b, start and goal included
};

/// Two CSV files. FILE.csv begins with lines that start with # and describe the search, followed by
/// a row of numbers per alpha in rising order. FILE_paths.csv in the same folder holds the
/// waypoints (alpha, x, y, z, yaw [m, rad]), so that the costs can be checked. Roll and pitch are
/// not stored.
class ReferenceTable {
  public:
    /// An empty table of a file. Nothing is read yet.
    /// @throws InputError for a name that does not end in .csv: two tables could share their paths
    explicit ReferenceTable(std::filesystem::path file);

    /// Reads both files; the table is empty afterwards if FILE.csv does not exist.
    /// @throws InputError naming file and line, also for a FILE_paths.csv that is another file
    void read();
    /// Writes both files. @throws InputError if that is not possible
    void write() const;

    /// Adds a comment line to the file that describes a search, unless the line is already there.
    void addNote(const std::string& text);

    /// Stores a path if the table has no path with its alpha yet, or one of higher cost.
    /// @return whether it was stored
    bool offer(const ReferencePath& path);
    /// The path for an alpha (to 1e-6); null if there is none.
    const ReferencePath* at(double alpha) const;
    /// Removes the path for an alpha, if there is one.
    void drop(double alpha);
    /// As drop(), but write() stores it in place of a path that costs more, until dropAside().
    void setAside(double alpha);
    /// Forgets what was set aside for an alpha that has another path now.
    void dropAside(double alpha);
    std::vector<double> alphas() const;

  private:
    std::filesystem::path pathsFile() const;
    void readFiles();
    std::map<long, ReferencePath> best() const;

    std::filesystem::path file_;
    std::vector<std::string> notes_;
    std::map<long, ReferencePath> rows_;   // by alpha in millionths
    std::map<long, ReferencePath> aside_;  // of an earlier search
};

}  // namespace photonav
