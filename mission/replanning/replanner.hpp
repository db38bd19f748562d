// SPDX-License-Identifier: BSD-3-Clause
// From new images to the next part of the way: everything of an exploration that takes long.
#pragma once

#include "replanning/flyable_part.hpp"
#include "replanning/online_planner.hpp"

namespace photonav {

/// The images and the belief for an update of map and plan. It holds copies, which no other thread
/// changes.
struct ReplanRequest {
    /// Images since the last request, at least one. If none changes the map, only the plan is
    /// updated.
    std::vector<MapInput> images;
    ObstaclesInView inView;  ///< in the last image
    UncertainPose T_c_w;     ///< the robot's present belief
    double imageTime = 0.;   ///< time of the last image [s]
};

/// Map and plan after an update. Nothing in it changes with the next update.
struct Replanned {
    ReplanRequest request;
    MapChange change;                              ///< of the map since the last update
    bool hasMapGrown = false;                      ///< the images changed the state of a cell
    std::vector<CellStates::Brick> cells = {};     ///< the bricks whose cells changed
    std::shared_ptr<const ViewSource> views = {};  ///< of the new map
    std::vector<Eigen::Vector2d> toGoal = {};  ///< waypoints of the plan; empty: it ends elsewhere
    /// The part of the plan that may be flown, from request.T_c_w on; none: there is no plan.
    std::optional<FlyablePart> way = {};
    PlanUpdate update = {};  ///< without the time
};

/// The robot's map and the planner in it.
///
///     replan(request):
///         for every image: remove what it contradicts, fuse its depth       (OnlineMap::add)
///         free the space of the robot's body, and right ahead of it     (OnlineMap::addBody)
///         update clearance and views, repair the plan                        (OnlinePlanner)
///         keep the part of the plan that was seen and is free                 (flyablePart)
///
/// One thread at a time may call replan() and the accessors. Another thread may call
/// clearanceBeside() at any time.
class Replanner {
  public:
    /// @param known what the robot knows at take-off; null: nothing
    /// @param kind planner, headings and replanning policy
    /// @param tube radius around the way that must be free of the obstacles of the last image [m]
    Replanner(const Config& config, const TexturedOcTree* known, const ExplorePlanner& kind,
              std::uint32_t seed, double tube);
    Replanner(const Replanner&) = delete;
    Replanner& operator=(const Replanner&) = delete;

    /// @throws Interrupted when it is interrupted
    Replanned replan(ReplanRequest request, const PlanningLimits& limits);

    const OnlineMap& map() const { return map_; }
    const OnlinePlanner& planner() const { return planner_; }

    /// Clearance in the map of the last update, for another thread than replan()'s [m].
    double clearanceBeside(const Eigen::Vector3d& p_w) const {
        return planner_.clearanceBeside(p_w);
    }

  private:
    void fuse(Replanned& replanned, const PlanningLimits& limits);
    std::optional<FlyablePart> flyableWay(const ReplanRequest& request) const;

    Config config_;
    Camera camera_;
    OnlineMap map_;
    OnlinePlanner planner_;
    SpaceAhead space_;
    double tube_;
    bool isFirst_ = true;  // the next update
};

/// The clearance of SpaceAhead in a single image: obstacles are kept at the distance `tube`, which
/// counts as the robot's radius.
double clearanceInView(const ObstaclesInView& inView, const Eigen::Vector3d& p_w, double radius,
                       double tube);

}  // namespace photonav
