// SPDX-License-Identifier: BSD-3-Clause
#include "planners/path_headings.hpp"

#include <cmath>
#include <stdexcept>

#include "geometry/se3.hpp"

namespace photonav {
namespace ob = ompl::base;

std::vector<std::shared_ptr<ob::State>> replaceHeadings(const ob::SpaceInformationPtr& si,
                                                        const FlightSpace& space,
                                                        const std::vector<const ob::State*>& path,
                                                        Headings headings) {
    // A leg with a shorter way from above has no heading [m]. Else a robot whose plan is updated
    // while it flies would turn for centimetres, again and again.
    constexpr double kShort = 0.1;
    if (space.kind() != StateKind::positionYaw) {
        throw std::invalid_argument("headings: the space has none that is free");
    }
    std::vector<std::shared_ptr<ob::State>> states;
    const auto add = [&](const Eigen::Vector3d& p_w, double yaw) {
        states.emplace_back(si->allocState(), [si](ob::State* state) { si->freeState(state); });
        space.setState(states.back().get(), p_w, yaw);
    };
    double yaw = yawOf(space.bodyPose(path.front()));
    add(space.position(path.front()), yaw);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Eigen::Vector3d from = space.position(path[i - 1]);
        const Eigen::Vector3d to = space.position(path[i]);
        const Eigen::Vector2d leg = (to - from).head<2>();
        if (headings == Headings::forward && leg.norm() > kShort) {
            const double along = std::atan2(leg.y(), leg.x());
            if (along != yaw) add(from, along);
            yaw = along;
        }
        if (from != to) add(to, yaw);
    }
    return states;
}

}  // namespace photonav
