// SPDX-License-Identifier: BSD-3-Clause
// A planning problem without images: what a view is worth is a formula, so tests know the answer.
#pragma once

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>

#include <memory>
#include <numbers>

#include "geometry/se3.hpp"
#include "planners/audit.hpp"
#include "planners/belief_rrt_star.hpp"
#include "planners/perception_rrt_star.hpp"
#include "planners/planner_table.hpp"
#include "planners/rrbt.hpp"

namespace photonav::test {

namespace ob = ompl::base;

inline Vector6 vector6(double a, double b, double c, double d, double e, double f) {
    return (Vector6() << a, b, c, d, e, f).finished();
}

/// The camera observes x for 4 < x < 5 and everything for x > 6 (stripes, then texture). What it
/// observes lies in the world, however the camera is turned.
inline Matrix6 stripesThenTexture(const Pose& T_c_w) {
    const double x = T_c_w.inverse().translation().x();
    Matrix6 information = Matrix6::Zero();  // axes of the world
    if (x > 4. && x < 5.) {
        const Vector6 j = vector6(1., 0., 0., 0., 0.5, 0.2);
        information = 400. * j * j.transpose();
    } else if (x > 6.) {
        information = vector6(900., 900., 400., 3e3, 3e3, 2e3).asDiagonal();
    }
    return inRotatedAxes(information, T_c_w.linear());
}

inline Eigen::AlignedBox3d box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    return {low, high};
}

struct Problem {
    StateKind kind = StateKind::position;
    Eigen::AlignedBox3d bounds = box({0., 0., 2.}, {10., 10., 2.});
    Eigen::Vector3d start{3., 1., 2.};
    Eigen::Vector3d goal{3., 9., 2.};
    InformationFormula information = stripesThenTexture;
    Pose mount = cameraMount(std::numbers::pi / 2);
    Clearance clearance = [](const Eigen::Vector3d&) { return 1.; };
    BeliefOptions belief = defaultBelief();
    GrowthOptions growth{};

    static BeliefOptions defaultBelief() {
        BeliefOptions options;
        options.alpha = 0.05;
        options.initialCovariance = vector6(.02, .02, .01, 1e-5, 1e-5, 1e-4).asDiagonal();
        options.motionNoise = vector6(1e-2, 1e-2, 1e-2, 1e-5, 1e-5, 1e-4).asDiagonal();
        return options;
    }

    FlightSpace space() const { return {kind, bounds}; }
    ob::SpaceInformationPtr spaceInformation() const {
        return makeSpaceInformation(space(), clearance, 0.2);
    }
    std::shared_ptr<BeliefModel> model() const {
        return std::make_shared<BeliefModel>(
            space(),
            std::make_shared<InformationField>(information, mount, InformationField::Options{}),
            belief);
    }
    ob::ProblemDefinitionPtr definition(const ob::SpaceInformationPtr& si) const {
        ob::ScopedState<> from(si);
        ob::ScopedState<> to(si);
        space().setState(from.get(), start, 0.);
        space().setState(to.get(), goal, 0.);
        auto definition = std::make_shared<ob::ProblemDefinition>(si);
        definition->setStartAndGoalStates(from, to);
        return definition;
    }

    /// One of plannerNames(), set up on this problem.
    std::shared_ptr<BeliefPlanner> planner(const std::string& name, unsigned labels = 5) const {
        return planner(name, labels, model());
    }

    /// The same with a model of its own.
    std::shared_ptr<BeliefPlanner> planner(const std::string& name, unsigned labels,
                                           const std::shared_ptr<BeliefModel>& model) const {
        const auto si = spaceInformation();
        auto planner = makePlanner(name, si, model, {.labels = labels}, growth);
        planner->setProblemDefinition(definition(si));
        planner->setup();
        return planner;
    }
};

/// Vertices of a tree: half under the address sanitizer, which is after other errors than the
/// test's statement, made at full size by the ordinary build, and for which RRBT's n^2 is slow.
constexpr std::size_t treeOf(std::size_t vertices) {
#ifdef PHOTONAV_SANITIZED
    return vertices / 2;
#else
    return vertices;
#endif
}

/// Grows the planner until it has this many vertices.
inline ob::PlannerStatus grow(BeliefPlanner& planner, std::size_t vertices) {
    planner.params().setParam("max_vertices", std::to_string(vertices));
    return planner.solve(
        ob::PlannerTerminationCondition([&] { return planner.iterations() > 50 * vertices; }));
}

}  // namespace photonav::test
