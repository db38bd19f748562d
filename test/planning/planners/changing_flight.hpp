// SPDX-License-Identifier: BSD-3-Clause
// A robot above a world whose walls and textures change.
#pragma once

#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include <random>

#include "planning/planners/changing_world.hpp"

namespace photonav::test {

/// A robot that flies through a world which changes around it.
class ChangingFlight {
  public:
    ChangingFlight(const std::string& name, SceneKind scene, std::uint32_t seed)
        : problem_(problemIn(scene)), world_(problem_.bounds), random_(seed) {
        if (name == "rrt_star") problem_.belief.alpha = 1.;
        problem_.growth.seed = seed;
        problem_.clearance = world_.clearance();
        if (scene == SceneKind::overTexture) {
            world_.paintFloor(kFloor, [] { return 0.5F; });
            isOverTexture_ = true;
        }
        field_ = makeField();
        planner_ = problem_.planner(name, 5, makeModel(field_));
        planner_->params().setParam("max_vertices", name == "rrbt" ? "120" : "250");
        if (name == "belief_rrt_star") planner_->params().setParam("shortcut", "200");
        position_ = problem_.start;
    }

    BeliefPlanner& planner() { return *planner_; }
    bool hasPath() const { return planner_->getProblemDefinition()->hasSolution(); }

    void plan() {
        const std::size_t last = planner_->iterations() + 800;
        planner_->solve(
            ob::PlannerTerminationCondition([&] { return planner_->iterations() >= last; }));
    }

    /// A wall appears, or one that has appeared vanishes, or the floor looks different.
    void changeTheMap() {
        if (isOverTexture_ && random(0., 1.) < 0.6) {
            const Eigen::Vector2d low(random(0., 6.), random(0., 6.));
            const Eigen::AlignedBox2d area(low, low + Eigen::Vector2d(2., 2.));
            paint(area, random(0., 1.) < 0.3 ? 0. : 0.8);
            return;
        }
        if (walls_.size() > 5 || (!walls_.empty() && random(0., 1.) < 0.4)) {
            const auto i = static_cast<std::ptrdiff_t>(random(0., 0.999) * walls_.size());
            const Eigen::AlignedBox3d wall = walls_[i];
            walls_.erase(walls_.begin() + i);
            follow(world_.fill(wall, false));
            return;
        }
        const int axis = random(0., 1.) < 0.5 ? 0 : 1;
        Eigen::Vector3d low(random(0., 6.), random(0., 6.), 0.);
        Eigen::Vector3d size(0.4, 0.4, 4.);
        size[axis] = random(2., 6.);
        const Eigen::AlignedBox3d wall(low, low + size);
        if (wall.exteriorDistance(position_) < 0.6) return;
        walls_.push_back(wall);
        follow(world_.fill(wall, true));
    }

    /// A wall appears around a place, or vanishes.
    void wallAround(const Eigen::Vector3d& p_w, bool isThere) {
        const Eigen::Vector3d half(0.3, 0.3, 4.);
        follow(world_.fill({p_w - half, p_w + half}, isThere));
    }
    const Eigen::Vector3d& position() const { return position_; }
    const Eigen::Vector3d& goal() const { return problem_.goal; }

    /// Gives a part of the floor random grey values.
    void paint(const Eigen::AlignedBox2d& area, double contrast) {
        follow(world_.paintFloor(
            area, [&] { return static_cast<float>(0.5 + contrast * random(-0.5, 0.5)); }));
    }

    /// Along the path, and somewhat off it.
    void move() {
        Eigen::Vector3d target = position_ + Eigen::Vector3d(random(-1., 1.), random(-1., 1.), 0.);
        if (hasPath()) {
            const auto& states = path().getStates();
            const Eigen::Vector3d next =
                problem_.space().position(states[std::min<std::size_t>(1, states.size() - 1)]);
            target = position_ + random(0.2, 1.) * (next - position_);
            if (random(0., 1.) < 0.5)
                target += Eigen::Vector3d(random(-.1, .1), random(-.1, .1), 0.);
        }
        const auto si = planner_->getSpaceInformation();
        ob::ScopedState<> state(si);
        problem_.space().setState(state.get(), target, 0.);
        if (!si->isValid(state.get())) return;
        position_ = target;
        root_ = Belief{random(0.5, 2.) * problem_.belief.initialCovariance, 0.};
        planner_->moveRoot(state.get(), *root_);
    }

    /// Cost of the best path that a new planner with as many vertices finds for the problem as it
    /// is now.
    double costFromScratch(const std::string& name, unsigned shortcut) {
        Problem now = problem_;
        now.start = position_;
        const auto planner = now.planner(name, 5, makeModel(makeField()));
        planner->params().setParam("max_vertices", "250");
        planner->params().setParam("shortcut", std::to_string(shortcut));
        ob::ScopedState<> state(planner->getSpaceInformation());
        now.space().setState(state.get(), position_, 0.);
        if (root_) planner->moveRoot(state.get(), *root_);
        planner->solve(
            ob::PlannerTerminationCondition([&] { return planner->iterations() >= 5000; }));
        return planner->bestCost();
    }

    /// The solution is free in the map as it is now and costs what its beliefs say; so do all
    /// beliefs of the tree.
    void check() {
        const Audit audit = auditTree(*planner_);
        EXPECT_LT(audit.maxCostError, 1e-9);
        EXPECT_LT(audit.maxCovarianceError, 1e-9);
        EXPECT_EQ(hasPath(), planner_->bestCost() < kInfinity);
        if (!hasPath()) return;
        const DistanceMap clearance = world_.freshClearance();
        Problem now = problem_;
        now.clearance = [&](const Eigen::Vector3d& p) { return clearance.clearance(p); };
        const auto si = now.spaceInformation();
        const auto& states = path().getStates();
        for (std::size_t i = 1; i < states.size(); ++i) {
            EXPECT_TRUE(si->checkMotion(states[i - 1], states[i])) << "motion " << i;
        }
        EXPECT_TRUE(problem_.space().position(states.front()).isApprox(position_));
        EXPECT_TRUE(planner_->getProblemDefinition()->getGoal()->isSatisfied(states.back()));
        EXPECT_NEAR(planner_->bestCost(), replayedCost(states), 1e-9);
    }

  private:
    void follow(const MapChange& change) {
        if (isOverTexture_) field_->update(world_.freshViews(), change);
        planner_->mapChanged(change);
    }
    std::shared_ptr<InformationField> makeField() const {
        const InformationField::Options options{.positionPitch = 0.25};
        if (!isOverTexture_) {
            return std::make_shared<InformationField>(problem_.information, problem_.mount,
                                                      options);
        }
        const Camera camera = makeCamera(24, 16, 1.2);
        return std::make_shared<InformationField>(
            world_.freshViews(), camera, photometricModel(camera, {}), problem_.mount, options);
    }
    std::shared_ptr<BeliefModel> makeModel(std::shared_ptr<InformationField> field) const {
        return std::make_shared<BeliefModel>(problem_.space(), std::move(field), problem_.belief);
    }
    double random(double low, double high) {
        return low + (high - low) * std::generate_canonical<double, 32>(random_);
    }
    ompl::geometric::PathGeometric& path() const {
        return *planner_->getProblemDefinition()
                    ->getSolutionPath()
                    ->as<ompl::geometric::PathGeometric>();
    }
    /// With an information field of its own.
    double replayedCost(const std::vector<ob::State*>& states) const {
        const auto model = makeModel(makeField());
        return model->evaluate({states.begin(), states.end()}, root_).back().cost;
    }

    Problem problem_;
    ChangingWorld world_;
    bool isOverTexture_ = false;
    std::shared_ptr<InformationField> field_;
    std::mt19937 random_;
    std::shared_ptr<BeliefPlanner> planner_;
    std::vector<Eigen::AlignedBox3d> walls_;
    Eigen::Vector3d position_;
    std::optional<Belief> root_;  // once it was moved
};

}  // namespace photonav::test
