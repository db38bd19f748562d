// SPDX-License-Identifier: BSD-3-Clause
// The scene or map of a config, ready to be looked at and flown in.
#pragma once

#include <memory>

#include "config.hpp"
#include "distance_map.hpp"
#include "report.hpp"
#include "view.hpp"

namespace photonav {

class World {
  public:
    /// Loads the scene or map of the config.
    /// @throws InputError when it cannot be read, or is too large for the resolution asked for
    explicit World(const Config& config);

    const ViewSource& views() const { return *views_; }
    /// Whether anything here can tell a camera where it is: false for a map of occupancy only.
    bool hasTexture() const { return hasTexture_; }
    double clearance(const Eigen::Vector3d& p_w) const { return distances_.clearance(p_w); }

    /// Box of everything that can be seen [m].
    const Eigen::AlignedBox3d& extent() const { return extent_; }

    /// Puts what there is to see into the report's 3-D view.
    void describe(ReportData& report) const { describe_(report); }

    /// The grey values below height z, from above, nearly orthographic: first row at the largest y.
    ImageF pictureFromAbove(const Eigen::AlignedBox2d& area, double z, double pixelSize) const;

  private:
    void loadScene(const Config& config);
    void loadMap(const Config& config);

    std::unique_ptr<ViewSource> views_;
    bool hasTexture_ = true;
    DistanceMap distances_;
    Eigen::AlignedBox3d extent_;
    std::function<void(ReportData&)> describe_;
};

}  // namespace photonav
