// SPDX-License-Identifier: BSD-3-Clause
// Planning for something else than the photometric pose uncertainty, where the answer is known.
#include <gtest/gtest.h>
#include <ompl/geometric/PathGeometric.h>

#include <map>

#include "belief/view_model_table.hpp"
#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// A model whose views are charged by a penalty.
std::shared_ptr<BeliefModel> penalised(const Problem& problem, const PenaltyFormula& penalty) {
    return std::make_shared<BeliefModel>(
        problem.space(),
        std::make_shared<InformationField>(penalty, cameraMount(std::numbers::pi / 2),
                                           InformationField::Options{}),
        problem.belief);
}

double costOf(BeliefModel& model, const Vector3d& from, const Vector3d& to) {
    ob::ScopedState<> a(model.space().space());
    ob::ScopedState<> b(model.space().space());
    model.space().setState(a.get(), from, 0.);
    model.space().setState(b.get(), to, 0.);
    Motion motion = model.motion(a.get(), b.get());
    return model.propagate(model.root(a.get()), motion).cost;
}

/// Few corners where x < 5, many beyond.
ViewPenalty manyCornersBeyondFive(const Pose& T_c_w) {
    return {.base = T_c_w.inverse().translation().x() > 5. ? 0.01 : 1.};
}

class EveryKindOfPenalty : public testing::TestWithParam<std::tuple<StateKind, CostRule>> {};
INSTANTIATE_TEST_SUITE_P(
    Penalty, EveryKindOfPenalty,
    testing::Combine(testing::Values(StateKind::position, StateKind::positionYaw, StateKind::se3),
                     testing::Values(CostRule::integral, CostRule::perVertex)));

TEST_P(EveryKindOfPenalty, PropagationEqualsReplay) {
    Problem problem;
    problem.bounds = box({0, 0, 1}, {10, 10, 3});
    std::tie(problem.kind, problem.belief.cost) = GetParam();
    const auto model = penalised(problem, [](const Pose& T_c_w) -> ViewPenalty {
        const Vector3d p = T_c_w.inverse().translation();
        return {1. + p.x(), {0.7, Vector3d(0.1 * p.y(), 3., 2.).asDiagonal()}};
    });
    const auto& space = model->space();
    const auto sampler = space.sampler(4);
    ob::ScopedState<> a(space.space());
    ob::ScopedState<> b(space.space());
    for (int i = 0; i < 20; ++i) {
        sampler->sampleUniform(a.get());
        sampler->sampleUniform(b.get());
        Motion there = model->motion(a.get(), b.get());
        EXPECT_NEAR(model->propagate(model->root(a.get()), there).cost,
                    model->evaluate({a.get(), b.get()}).back().cost, 1e-10);
        EXPECT_NEAR(model->propagate(model->root(b.get()), there, true).cost,
                    model->evaluate({b.get(), a.get()}).back().cost, 1e-10);
    }
}

TEST(Penalty, IsChargedByTheMetreInPlaceOfTheTrace) {
    Problem problem;
    problem.belief.alpha = 0.2;
    const auto model = penalised(problem, [](const Pose&) -> ViewPenalty { return {.base = 0.5}; });
    EXPECT_NEAR(costOf(*model, {1, 1, 2}, {4, 5, 2}), 5. * (0.2 + 0.8 * 2.5 * 0.5), 1e-12);
}

TEST(Penalty, LessForMotionsThatSeeParallax) {
    // A downward camera at heading 0: image right is world -y, image up is world x.
    Problem problem;
    problem.belief.alpha = 0.;
    problem.belief.kappa = 1.;
    const auto model = penalised(problem, [](const Pose&) -> ViewPenalty {
        return {1., {0.8, Vector3d(3., 0., 0.).asDiagonal()}};
    });
    EXPECT_NEAR(costOf(*model, {1, 1, 2}, {1, 5, 2}), 4. * (1. - 0.8 * 0.75),
                1e-12);                                            // image right
    EXPECT_NEAR(costOf(*model, {1, 1, 2}, {5, 1, 2}), 4., 1e-12);  // image up
    EXPECT_NEAR(costOf(*model, {1, 1, 2}, {4, 5, 2}), 5. * (1. - 0.8 * 1.92 / 2.92), 1e-12);
}

TEST(Penalty, TurningOnTheSpotSeesNoParallax) {
    Problem problem;
    problem.kind = StateKind::positionYaw;
    problem.belief.alpha = 0.;
    problem.belief.kappa = 1.;
    const auto model = penalised(problem, [](const Pose&) -> ViewPenalty {
        return {1., {1., 9. * Eigen::Matrix3d::Identity()}};
    });
    ob::ScopedState<> a(problem.space().space());
    ob::ScopedState<> b(problem.space().space());
    problem.space().setState(a.get(), {1, 1, 2}, 0.);
    problem.space().setState(b.get(), {1, 1, 2}, 1.);
    EXPECT_NEAR(model->evaluate({a.get(), b.get()}).back().cost, 0.25, 1e-12);  // 0.25 m per radian
}

TEST(Penalty, EveryPlannerFliesWhereTheCornersAre) {
    for (const std::string name : {"pa_rrt_star", "rrbt", "belief_rrt_star"}) {
        Problem problem;  // from (3, 1) to (3, 9): 8 m straight, about 9 m through the corners
        const auto planner = problem.planner(name, 5, penalised(problem, manyCornersBeyondFive));
        grow(*planner, 500);
        EXPECT_LT(planner->bestCost(), 0.8 * 8. * (0.05 + 0.95 * 2.5)) << name;
        const auto path = planner->getProblemDefinition()->getSolutionPath();
        double farthest = 0.;
        for (const auto* s : path->as<ompl::geometric::PathGeometric>()->getStates()) {
            farthest = std::max(farthest, problem.space().position(s).x());
        }
        EXPECT_GT(farthest, 5.) << name;
        const Audit audit = auditTree(*planner);
        EXPECT_LT(audit.maxCostError, 1e-9) << name;
        EXPECT_LT(audit.maxCovarianceError, 1e-9) << name;
    }
}

TEST(Penalty, LeavesOneBeliefPerVertex) {
    // All beliefs are alike but for their cost, so the cheapest is the only one worth keeping.
    Problem problem;
    const auto model = penalised(problem, manyCornersBeyondFive);
    const auto planner = std::dynamic_pointer_cast<RRBT>(problem.planner("rrbt", 0, model));
    grow(*planner, 200);
    EXPECT_EQ(planner->beliefs(), planner->vertices());
}

TEST(NoInformation, IsTheShortestPathWithoutViews) {
    Problem problem;
    problem.information = {};
    const auto planner = problem.planner("belief_rrt_star");
    grow(*planner, 800);
    EXPECT_EQ(planner->model().field().views(), 0U);
    double length = planner->getProblemDefinition()->getSolutionPath()->length();
    EXPECT_LT(length, 8.1);  // the trace only grows, so the way straight on is best
    EXPECT_LT(auditTree(*planner).maxCostError, 1e-9);
}

/// A grey floor 2 m below with one bright dot straight under the origin of the world.
class DotOnTheFloor : public ViewSource {
  public:
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        view.intensity.resize(camera.height, camera.width);
        view.depth.resize(camera.height, camera.width);
        view.intensity = 0.5F;
        view.depth = 2.F;
        const Vector3d p = T_c_w * Vector3d::Zero();
        const int u = static_cast<int>(std::lround(camera.fx() * p.x() / p.z() + camera.cx()));
        const int v = static_cast<int>(std::lround(camera.fy() * p.y() / p.z() + camera.cy()));
        if (u < 1 || v < 1 || u + 1 >= static_cast<int>(camera.width) ||
            v + 1 >= static_cast<int>(camera.height)) {
            return;
        }
        for (int row = -1; row <= 1; ++row) {
            for (int column = -1; column <= 1; ++column) {
                view.intensity[v + row][u + column] +=
                    0.1F * static_cast<float>((2 - std::abs(row)) * (2 - std::abs(column)));
            }
        }
    }
};

TEST(ViewModels, EvaluateRenderedViews) {
    const DotOnTheFloor floor;
    const Camera camera = makeCamera(95, 63, 1.2);
    const auto viewFrom = [&](double x) {
        Pose T_w_b = Pose::Identity();
        T_w_b.translation() = Vector3d(x, 0., 2.);
        View view;
        floor.render(camera, (T_w_b * cameraMount(std::numbers::pi / 2)).inverse(), view);
        return view;
    };
    const View above = viewFrom(0.);
    const View elsewhere = viewFrom(50.);

    const auto count = featureCountModel({.referenceCount = 1.});
    EXPECT_DOUBLE_EQ(count(above).base, 0.5);
    EXPECT_DOUBLE_EQ(count(elsewhere).base, 1.);
    const auto reprojection = featureReprojectionModel(camera, {.pixelSigma = 2.});
    EXPECT_NEAR(reprojection(above)(0, 0), std::pow(camera.fx() / 2. / 2., 2), 1e-6);
    EXPECT_TRUE(reprojection(elsewhere).isZero(0.));
    const auto map = mapUncertaintyModel(camera, {}, {});
    EXPECT_GT(map(elsewhere).along(Vector3d::UnitX()), map(above).along(Vector3d::UnitX()));
    EXPECT_EQ(map(elsewhere).along(Vector3d::UnitX()), 1.);
}

TEST(ViewModels, FillFieldsOverAMap) {
    const auto floor = std::make_shared<DotOnTheFloor>();
    const Camera camera = makeCamera(95, 63, 1.2);
    const Pose mount = cameraMount(std::numbers::pi / 2);
    Pose above = Pose::Identity();
    above.translation().z() = 2.;
    InformationField information(floor, camera, photometricModel(camera, {}), mount, {});
    EXPECT_FALSE(information.hasPenalties());
    EXPECT_FALSE(information.at(above).isZero);
    InformationField penalties(floor, camera, featureCountModel({.referenceCount = 1.}), mount, {});
    EXPECT_TRUE(penalties.hasPenalties());
    EXPECT_DOUBLE_EQ(penalties.at(above).penalty.base, 0.5);
}

TEST(ViewModelTable, EveryNameMakesAModelOfItsKind) {
    const Camera camera = makeCamera(95, 63, 1.2);
    std::map<std::string, std::string> kinds;
    for (const std::string& name : viewModelNames()) {
        const ViewModel model = makeViewModel(name, camera, {});
        kinds[name] = std::holds_alternative<InformationModel>(model) ? "information"
                      : std::holds_alternative<PenaltyModel>(model)   ? "penalty"
                                                                      : "none";
    }
    const std::map<std::string, std::string> wanted{{"photometric", "information"},
                                                    {"feature_reprojection", "information"},
                                                    {"none", "none"},
                                                    {"feature_count", "penalty"},
                                                    {"map_uncertainty", "penalty"}};
    EXPECT_EQ(kinds, wanted);
    EXPECT_THROW(makeViewModel("photometry", camera, {}), std::invalid_argument);
}

TEST(ViewModelTable, ThePhotometricModelCanBeReplaced) {
    const Camera camera = makeCamera(95, 63, 1.2);
    const auto constant = [](const Camera&, const PhotometricOptions&) -> InformationModel {
        return [](const View&) -> Matrix6 { return 2. * Matrix6::Identity(); };
    };
    ViewModelOptions options;
    options.makePhotometric = constant;
    const ViewModel model = makeViewModel("photometric", camera, options);
    EXPECT_EQ(std::get<InformationModel>(model)(View()).trace(), 12.);
}

}  // namespace
}  // namespace photonav::test
