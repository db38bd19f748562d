// SPDX-License-Identifier: BSD-3-Clause
// The map that a robot makes on its flight.
#pragma once

#include <optional>

#include "config/config.hpp"
#include "estimation/map_errors.hpp"
#include "exploration/doubted_columns.hpp"
#include "exploration/map_noise.hpp"
#include "exploration/obstacle_map.hpp"
#include "exploration/obstacles_in_view.hpp"
#include "exploration/unseen_information.hpp"
#include "map/map_fusion.hpp"

namespace photonav {

/// Whether a camera looks ahead of its robot, rather than at the place below.
bool looksAhead(const Pose& T_b_c);

/// Standard deviation of the depths of a config's sensor at 1 m, growing with depth squared [m]; of
/// stereo and monocular depth that of 0.2 pixels of disparity.
double depthSigmaAtOneMetre(const Config& config);

/// Map, obstacles in it, and how wrong it is, all from the images fused.
class OwnMap {
  public:
    /// @param config its section explore, bounds and radius
    explicit OwnMap(const Config& config);

    /// Measures how much information of the map's views is noise, by one that an image can be
    /// compared with.
    /// @param shown view of the map from where the image was taken
    void compare(const View& shown, const ImageF& image, const Camera& camera);

    /// A pose whose image is fused, now or later. @return its number
    int addPose(const UncertainPose& T_c_w) { return errors_->addPose(T_c_w); }
    /// Fuses an image at the believed pose of its camera.
    /// @param number of this pose
    /// @return what changed in the map and in the obstacles
    MapChange fuse(const View& image, const Camera& camera, const Pose& T_c_w, int number);
    /// Forgets the surfaces that a view of the map shows. @return what changed
    MapChange forget(const View& shown, const Camera& camera, const Pose& T_c_w);
    /// The body's own place is free. @return what changed
    MapChange addBody(const Eigen::Vector3d& p_w) {
        return obstacles_.addBody(*cells_, p_w, radius_);
    }

    /// What an image shows that is not fused yet, near enough to matter.
    /// @param distance from the camera [m]
    ObstaclesInView obstaclesIn(const ImageF& depth, const Camera& camera, const Pose& T_c_w,
                                double distance) const;

    /// Whether a surface or free space was seen at a place or below it, within the sensor's range,
    /// and no new obstacle near by has made this doubtful since.
    bool isSeen(const Eigen::Vector3d& p_w) const;

    const std::shared_ptr<TexturedOcTree>& cells() const { return cells_; }
    const std::shared_ptr<TexturedOcTree>& obstacles() const { return obstacles_.cells(); }
    const std::shared_ptr<MapErrors>& errors() const { return errors_; }

    /// Of views of this map, for planning: without the information that its noise pretends, and
    /// with what is expected of unknown space if the config says so.
    InformationModel information(const Camera& camera, const PhotometricOptions& options) const;

  private:
    std::shared_ptr<TexturedOcTree> cells_;
    ObstacleMap obstacles_;
    DoubtedColumns doubted_;
    std::shared_ptr<MapErrors> errors_;
    MapNoise noise_;
    std::optional<UnseenInformation> unseen_;
    PhotometricOptions photometric_;
    FusionOptions fusion_;
    double precise_;           // depth at which three standard deviations are a cell [m]
    double lowest_, highest_;  // that obstacles matter at [m]
    double radius_;            // of the robot [m]
    bool looksDown_;
};

}  // namespace photonav
