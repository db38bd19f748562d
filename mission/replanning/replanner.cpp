// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/replanner.hpp"

#include "flight/flight_setup.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"

namespace photonav {
namespace {

/// Radius around the robot that a camera that looks ahead does not observe [m].
constexpr double kHidden = 0.3;
/// Share of half the angle of view that counts as in view.
constexpr double kInView = 0.8;

/// How far ahead the view becomes as wide as the body [m].
double asWideAsBody(const Camera& camera, double radius) {
    const double tangent =
        std::min(0.5 * camera.width / camera.fx(), 0.5 * camera.height / camera.fy());
    return radius / tangent;
}

SpaceAhead spaceIn(const OnlineMap& map, const Config& config, const ExplorePlanner& kind) {
    const bool isAhead = looksAhead(config.camera.T_b_c());
    SpaceAhead space{.clearance = {},  // see flyableWay()
                     .isSeen = [&map](const Eigen::Vector3d& p_w) { return map.isSeen(p_w); },
                     .radius = config.robotRadius,
                     .hidden = isAhead ? kHidden : 0.,
                     .canLook = isAhead && config.space != StateKind::position &&
                                kind.headings != Headings::fixed,
                     .inView = {},
                     .turnPerMetre = config.fly.turnRate / config.fly.speed};
    // Headings along the motion stay so.
    if (config.explore.look == LookAhead::flying && kind.headings != Headings::forward) {
        space.inView = kInView * 0.5 * config.camera.hfov * kDegree;
    }
    return space;
}

std::vector<Eigen::Vector2d> waypointsFromAbove(const std::vector<BeliefPoint>& path) {
    std::vector<Eigen::Vector2d> places;
    for (const BeliefPoint& point : path) {
        if (point.isWaypoint) places.emplace_back(point.T_w_b.translation().head<2>());
    }
    return places;
}

}  // namespace

double clearanceInView(const ObstaclesInView& inView, const Eigen::Vector3d& p_w, double radius,
                       double tube) {
    return inView.clearance(p_w) + radius - tube;
}

Replanner::Replanner(const Config& config, const TexturedOcTree* known, const ExplorePlanner& kind,
                     std::uint32_t seed, double tube)
    : config_(config),
      camera_(config.camera.camera()),
      map_(config_, known),
      planner_(config_, map_, kind, seed),
      space_(spaceIn(map_, config_, kind)),
      tube_(tube) {}

Replanned Replanner::replan(ReplanRequest request, const PlanningLimits& limits) {
    Replanned replanned{std::move(request), {}};
    fuse(replanned, limits);
    throwIfStopped(limits.interrupted);
    planner_.update(replanned.change, replanned.request.T_c_w, replanned.update, limits);
    if (isFirst_) replanned.change.join(map_.whole());  // for those who saw no earlier change
    isFirst_ = false;
    replanned.views = planner_.views();
    if (planner_.reachesGoal()) replanned.toGoal = waypointsFromAbove(planner_.path());
    replanned.way = flyableWay(replanned.request);
    return replanned;
}

void Replanner::fuse(Replanned& replanned, const PlanningLimits& limits) {
    const Stopwatch watch;
    MapChange& change = replanned.change;
    for (const MapInput& image : replanned.request.images) {
        change.join(map_.add(image, camera_, [&] { return limits.interrupted.load(); }));
    }
    replanned.hasMapGrown = !change.occupancy.empty();
    replanned.cells = CellStates::bricksOf(*map_.cells(), change.occupancy);
    const Pose& T_c_w = replanned.request.T_c_w.mean;
    const Eigen::Vector3d body_w = (config_.camera.T_b_c() * T_c_w).inverse().translation();
    const Eigen::Vector3d ahead_w = T_c_w.linear().row(2);
    change.join(map_.addBody(body_w, body_w + asWideAsBody(camera_, space_.radius) * ahead_w));
    replanned.update.fuseSeconds = watch.seconds();
}

/// Above the robot's radius, clearances are those of the map. The last image shows obstacles before
/// the map does; from them the body keeps away as far as it must to stop.
std::optional<FlyablePart> Replanner::flyableWay(const ReplanRequest& request) const {
    if (planner_.path().empty()) return {};
    SpaceAhead space = space_;
    space.clearance = [&](const Eigen::Vector3d& p_w) {
        return std::min(planner_.clearance(p_w),
                        clearanceInView(request.inView, p_w, space_.radius, tube_));
    };
    FlyablePart way = flyablePart(plannedViews(planner_.path()), space);
    way.isWhole = way.isWhole && planner_.reachesGoal();
    return way;
}

}  // namespace photonav
