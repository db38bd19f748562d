// SPDX-License-Identifier: BSD-3-Clause
// The map that a robot makes during its flight.
#pragma once

#include <optional>

#include "config/config.hpp"
#include "map/map_fusion.hpp"
#include "onlinemap/doubted_columns.hpp"
#include "onlinemap/map_noise.hpp"
#include "onlinemap/obstacle_map.hpp"
#include "onlinemap/obstacles_in_view.hpp"
#include "onlinemap/unseen_information.hpp"

namespace photonav {

/// Whether a camera looks ahead rather than down: its axis is more than about 15 degrees from the
/// vertical.
bool looksAhead(const Pose& T_b_c);

/// Standard deviation of measured depth at 1 m, which grows with depth squared [m]: depth_sigma of
/// a depth sensor; for stereo and monocular depth it follows from 0.25 pixels of disparity.
double depthSigmaAtOneMetre(const Config& config);

/// The region in which obstacles of a depth image matter: the heights that the robot may reach.
/// @param distance largest horizontal distance from the camera [m]
ObstacleRange obstacleRange(const Config& config, double distance);

/// A tracked image, and how it changes the map.
struct MapInput {
    View image;
    View shown;           ///< view of the map from the believed pose, before the image is fused
    UncertainPose T_c_w;  ///< the belief at the image
    bool isMapInconsistent = false;  ///< the surfaces of `shown` are to be removed

    /// Depth that is fused: of the image or, with a single camera, of an earlier one.
    struct Keyframe {
        View view;
        Pose T_c_w = Pose::Identity();
        int number = 0;  ///< from MapErrors::addPose()
    };
    std::optional<Keyframe> keyframe = {};  ///< none: nothing is fused
};

/// The map with its obstacles and its noise, all made from the fused images.
class OnlineMap {
  public:
    /// @param config uses camera, section `explore`, bounds and robot.radius
    /// @param known what the robot knows at take-off, with cells of explore.cell(); null:
    ///        nothing. It is corrected by what is fused.
    explicit OnlineMap(const Config& config, const TexturedOcTree* known = nullptr);

    /// All that is in the map, as a change from an empty one.
    MapChange whole() const;

    /// Applies compare(), fuse() and forget() as an image requires.
    /// @return the change of map and obstacles
    /// @throws Interrupted when `isStopped` says so; what has changed until then is not told
    MapChange add(const MapInput& input, const Camera& camera, const IsStopped& isStopped = {});

    /// Updates the estimate of the map's noise (MapNoise), and of the information expected of
    /// unknown space (UnseenInformation) if the config asks for it.
    /// @param shown view of the map from the pose of the image, before the image is fused
    void compare(const View& shown, const ImageF& image, const Camera& camera);

    /// Fuses an image.
    /// @param T_c_w believed pose of the camera
    /// @return the change of map and obstacles
    /// @throws Interrupted when `isStopped` says so
    MapChange fuse(const View& image, const Camera& camera, const Pose& T_c_w,
                   const IsStopped& isStopped = {});
    /// Removes the surfaces that a view of the map shows. Their cells are unknown until they are
    /// observed again. @return the change of map and obstacles
    MapChange forget(const View& shown, const Camera& camera, const Pose& T_c_w);
    /// Marks the space of the body as free, see ObstacleMap::addBody(). @return the change of
    /// obstacles
    MapChange addBody(const Eigen::Vector3d& body_w, const Eigen::Vector3d& ahead_w) {
        return obstacles_.addBody(*cells_, body_w, ahead_w, radius_);
    }

    /// Whether surfaces or free space were observed at a place, or below it within explore.range in
    /// as many cells as a wall there needs to be noticed (wallCells()), the nearest of them free.
    /// The column of the place must not be doubted (DoubtedColumns).
    bool isSeen(const Eigen::Vector3d& p_w) const;

    const std::shared_ptr<TexturedOcTree>& cells() const { return cells_; }
    const std::shared_ptr<TexturedOcTree>& obstacles() const { return obstacles_.cells(); }

    /// The information model for planning with views of this map: without the information of its
    /// noise (MapNoise), and with the information expected of unknown space (UnseenInformation) if
    /// the config asks for it.
    InformationModel information(const Camera& camera, const PhotometricOptions& options) const;

  private:
    void addKnown();
    void updateKnown(const MapChange& change);

    std::shared_ptr<TexturedOcTree> cells_;
    CellStates states_;  // of cells_
    ObstacleMap obstacles_;
    DoubtedColumns doubted_;
    MapNoise noise_;
    std::optional<UnseenInformation> unseen_;
    PhotometricOptions photometric_;
    FusionOptions fusion_;
    ObstacleRange range_;  // of images that are fused
    double radius_;        // radius of the robot [m]
    bool looksDown_;
};

}  // namespace photonav
