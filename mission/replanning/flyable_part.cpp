// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/flyable_part.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "geometry/segment.hpp"

namespace photonav {
namespace {

constexpr double kStep = 0.05;       // between places that are checked [m]
constexpr double kShort = 0.1;       // a way as short is none [m]
constexpr double kBlindStep = 0.15;  // [m]
constexpr double kFacing = 0.3;      // [rad]
constexpr double kSlack = 0.02;      // of clearances, which are interpolated [m]
constexpr double kRetreat = 0.002;   // nearer to an obstacle [m]
constexpr double kSide = 0.8;        // of the radius must be seen: a wall may be beyond

/// Length of a path up to the first place where a condition holds [m].
template <typename Condition>
double lengthUntil(const std::vector<PlannedView>& plan, const Condition& holds) {
    for (std::size_t i = 1; i < plan.size(); ++i) {
        const Eigen::Vector3d from = plan[i - 1].T_w_b.translation();
        const Eigen::Vector3d leg = plan[i].T_w_b.translation() - from;
        const int steps = 1 + static_cast<int>(leg.norm() / kStep);
        for (int k = 1; k <= steps; ++k) {
            const double share = static_cast<double>(k) / steps;
            const double length = plan[i - 1].distance + share * leg.norm();
            if (holds(from + share * leg, leg)) return length;
        }
    }
    return kInfinity;
}

/// The first `length` metres of a plan.
std::vector<PlannedView> cut(const std::vector<PlannedView>& plan, double length) {
    std::vector<PlannedView> begin;
    for (const PlannedView& view : plan) {
        if (view.distance <= length) {
            begin.push_back(view);
            continue;
        }
        PlannedView last = view;
        const PlannedView& before = begin.back();
        const double share = (length - before.distance) / (view.distance - before.distance);
        last.T_w_b = interpolate(before.T_w_b, view.T_w_b, share);
        last.distance = length;
        begin.push_back(last);
        break;
    }
    begin.back().isWaypoint = true;
    return begin;
}

/// The turn from a heading to the direction of a place [rad]; nothing for a place above or below.
std::optional<double> turnToward(const Eigen::Vector3d& p_w, const Eigen::Vector3d& from_w,
                                 double yaw) {
    const Eigen::Vector2d way = (p_w - from_w).head<2>();
    if (way.norm() < kStep) return {};
    return std::remainder(std::atan2(way.y(), way.x()) - yaw, 2. * std::numbers::pi);
}

/// A turn on the spot toward a place; nothing where the robot faces it already.
std::optional<std::vector<PlannedView>> lookAt(const Eigen::Vector3d& p_w,
                                               const PlannedView& here) {
    const auto turn = turnToward(p_w, here.T_w_b.translation(), yawOf(here.T_w_b));
    if (!turn || std::abs(*turn) < kFacing) return {};
    auto plan = hovering(here.T_w_b, here.covariance);
    plan.back().T_w_b.rotate(Eigen::AngleAxisd(*turn, Eigen::Vector3d::UnitZ()));
    return plan;
}

/// Turns the headings of a plan on the way, so that at its end a place is in view and the robot
/// need not stop there to look. A heading may differ from the direction of that place by as much as
/// the robot turns on the rest of the plan.
/// @param inView, turnPerMetre as SpaceAhead has them
void turnOnTheWay(std::vector<PlannedView>& plan, const Eigen::Vector3d& p_w, double inView,
                  double turnPerMetre) {
    const PlannedView end = plan.back();
    const auto apart = [](double a, double b) {
        return std::abs(std::remainder(a - b, 2. * std::numbers::pi));
    };
    // Headings from the direction of the place [rad]: once the robot has begun to turn by one side,
    // it goes on by that side.
    double before = 0., side = 0.;
    for (PlannedView& view : plan) {
        const auto turn = turnToward(p_w, end.T_w_b.translation(), yawOf(view.T_w_b));
        if (!turn) return;
        const double planned = -*turn;
        const double most = inView + (end.distance - view.distance) * turnPerMetre;
        if (std::abs(planned) <= most || view.distance == plan.front().distance) {
            before = planned;
            side = 0.;
            continue;
        }
        const auto change = [&](double to) { return apart(to, before) + apart(to, planned); };
        if (side == 0.) side = change(most) < change(-most) ? 1. : -1.;
        before = side * most;
        view.T_w_b.rotate(Eigen::AngleAxisd(before - planned, Eigen::Vector3d::UnitZ()));
        view.isWaypoint = view.distance == end.distance;  // the plan relied on another image
    }
}

}  // namespace

std::vector<PlannedView> hovering(const Pose& T_w_b, const Matrix6& covariance) {
    const PlannedView here{.T_w_b = T_w_b, .covariance = covariance, .isWaypoint = true};
    return {here, here};
}

std::vector<PlannedView> continuedFrom(const Pose& T_w_b, const std::vector<PlannedView>& plan) {
    constexpr double kSame = 1e-3;  // [m]
    const Eigen::Vector3d here = T_w_b.translation();
    const double flown = (here - plan.front().T_w_b.translation()).norm();
    std::vector<PlannedView> rest = plan;
    if (flown < kSame) return rest;
    if (plan.back().distance < kSame) {
        for (PlannedView& view : rest) view.T_w_b.translation() = here;
        return rest;
    }
    PlannedView nearest = plan.front();
    std::size_t next = 1;
    for (std::size_t i = 1; i < plan.size() && plan[i - 1].distance <= 2. * flown; ++i) {
        const PlannedView &from = plan[i - 1], &to = plan[i];
        const double share =
            nearestOnSegment(here, from.T_w_b.translation(), to.T_w_b.translation());
        PlannedView view = from;
        view.T_w_b = interpolate(from.T_w_b, to.T_w_b, share);
        view.distance += share * (to.distance - from.distance);
        if ((view.T_w_b.translation() - here).norm() >
            (nearest.T_w_b.translation() - here).norm()) {
            continue;
        }
        nearest = view;
        next = i;
    }
    nearest.isWaypoint = false;
    PlannedView begin = plan.front();
    begin.T_w_b = T_w_b;
    begin.distance = nearest.distance - (nearest.T_w_b.translation() - here).norm();
    rest.assign({begin, nearest});
    rest.insert(rest.end(), plan.begin() + static_cast<std::ptrdiff_t>(next), plan.end());
    for (PlannedView& view : rest) view.distance -= begin.distance;
    return rest;
}

FlyablePart flyablePart(const std::vector<PlannedView>& plan, const SpaceAhead& space) {
    const Eigen::Vector3d here = plan.front().T_w_b.translation();
    // A robot that is nearer to an obstacle than plans are first flies away from it. It is given no
    // slack: from update to update it would come nearer and nearer.
    double least = std::min(space.radius - kSlack, space.clearance(here) - kRetreat);
    const double obstacle =
        lengthUntil(plan, [&](const Eigen::Vector3d& p_w, const Eigen::Vector3d&) {
            const double now = space.clearance(p_w);
            least = std::max(least, std::min(space.radius, now) - kSlack);
            return now < least;
        });
    // What a camera that can be turned there does not see of its own surroundings, it looks at.
    const double near = space.radius + (space.canLook ? 0. : space.hidden);
    Eigen::Vector3d newPlace = here;  // the first one, on the path or beside it
    const auto findsNew = [&](const Eigen::Vector3d& p_w) {
        if ((p_w - here).norm() <= near || space.isSeen(p_w)) return false;
        newPlace = p_w;
        return true;
    };
    const double unseen =
        lengthUntil(plan, [&](const Eigen::Vector3d& p_w, const Eigen::Vector3d& leg) {
            const Eigen::Vector3d side =
                kSide * space.radius * leg.cross(Eigen::Vector3d::UnitZ()).normalized();
            return findsNew(p_w) || findsNew(p_w + side) || findsNew(p_w - side);
        });
    FlyablePart way;
    const double whole = plan.back().distance;
    const double seen = unseen - space.radius;
    const double free = obstacle - space.radius;
    const bool isToLook = space.canLook && seen < std::min(space.hidden + kStep, free);
    if (std::min(seen, free) > whole) {
        way.plan = plan;
        way.isWhole = true;
    } else if (free < kShort) {
        way.isStopped = true;
        way.plan = hovering(plan.front().T_w_b, plan.front().covariance);
    } else if (auto look = isToLook ? lookAt(newPlace, plan.front()) : std::nullopt) {
        way.isLook = true;
        way.plan = std::move(*look);
    } else if (std::min(seen, free) >= kShort) {
        // Not even what lies beyond the hidden places was seen.
        way.isBlind = space.hidden > 0. && seen < space.hidden + kStep && seen <= free;
        way.plan = cut(plan, std::min({seen, free, whole}));
        if (space.canLook && space.inView && seen <= free) {
            turnOnTheWay(way.plan, newPlace, *space.inView, space.turnPerMetre);
        }
    } else {
        way.isBlind = true;
        way.plan = cut(plan, std::min({kBlindStep, free, whole}));
    }
    return way;
}

}  // namespace photonav
