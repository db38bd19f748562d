// SPDX-License-Identifier: BSD-3-Clause
#include "planners/path_descent.hpp"

#include <gtest/gtest.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// A descent on a problem from a path through these points, until the options or a condition on the
/// number of tried changes stop it.
struct Descended {
    Descended(const Problem& problem, const std::vector<Vector3d>& points,
              const DescentOptions& options = {},
              unsigned stopAfter = std::numeric_limits<unsigned>::max())
        : si(problem.spaceInformation()), model(problem.model()), descent(si, model, options) {
        std::vector<ob::ScopedState<>> states;
        std::vector<const ob::State*> path;
        for (const Vector3d& p : points) {
            states.emplace_back(si);
            problem.space().setState(states.back().get(), p, 0.);
        }
        for (const auto& state : states) path.push_back(state.get());
        descent.begin(path);
        before = descent.cost();
        descent.descend(
            ob::PlannerTerminationCondition([&] { return descent.tried() >= stopAfter; }));
    }

    double length() const {
        double sum = 0.;
        const auto path = descent.path();
        for (std::size_t i = 1; i < path.size(); ++i) sum += si->distance(path[i - 1], path[i]);
        return sum;
    }

    ob::SpaceInformationPtr si;
    std::shared_ptr<BeliefModel> model;
    PathDescent descent;
    double before = 0.;
};

/// Accepts the motions that a function accepts, and records where those from the start lead.
class RecordingValidator : public ob::MotionValidator {
  public:
    using Accepts = std::function<bool(const Vector3d& from, const Vector3d& to)>;

    RecordingValidator(const ob::SpaceInformationPtr& si, Vector3d start, Accepts accepts)
        : ob::MotionValidator(si), start_(std::move(start)), accepts_(std::move(accepts)) {}

    bool checkMotion(const ob::State* from, const ob::State* to) const override {
        const auto at = [](const ob::State* state) {
            return Vector3d(state->as<ob::RealVectorStateSpace::StateType>()->values);
        };
        if (!accepts_(at(from), at(to))) return false;
        if (at(from) == start_) firstWaypoints.push_back(at(to));
        return true;
    }
    bool checkMotion(const ob::State* from, const ob::State* to,
                     std::pair<ob::State*, double>&) const override {
        return checkMotion(from, to);
    }

    mutable std::vector<Vector3d> firstWaypoints;

  private:
    Vector3d start_;
    Accepts accepts_;
};

/// First waypoints that one round of shifts by at most 0.1 m tries, where length alone counts.
std::vector<Vector3d> shiftsOf(const std::vector<Vector3d>& points, std::uint32_t seed,
                               const RecordingValidator::Accepts& accepts) {
    Problem problem;
    problem.bounds = box({-100, -100, -100}, {100, 100, 100});
    problem.belief.alpha = 1.;
    const auto si = problem.spaceInformation();
    const auto validator = std::make_shared<RecordingValidator>(si, points.front(), accepts);
    si->setMotionValidator(validator);
    std::vector<ob::ScopedState<>> states;
    std::vector<const ob::State*> path;
    for (const Vector3d& p : points) {
        states.emplace_back(si);
        problem.space().setState(states.back().get(), p, 0.);
    }
    for (const auto& state : states) path.push_back(state.get());
    PathDescent descent(si, problem.model(),
                        {.moves = 20, .firstStep = 0.1, .lastStep = 0.1, .seed = seed});
    descent.begin(path);
    validator->firstWaypoints.clear();
    descent.descend(ob::plannerNonTerminatingCondition());
    return validator->firstWaypoints;
}

/// Whether a shift that was tried is the one before, doubled from the same centre.
bool containsDoubledShift(const std::vector<Vector3d>& shifts, const Vector3d& centre) {
    for (std::size_t i = 1; i < shifts.size(); ++i) {
        const Vector3d once = shifts[i - 1] - centre;
        if ((shifts[i] - centre).isApprox(2. * once, 1e-9)) return true;
    }
    return false;
}

const std::vector<Vector3d> kDetour{{3, 1, 2}, {7, 1.5, 2}, {7.5, 5, 2}, {7, 8, 2}, {3, 9, 2}};

TEST(PathDescent, CostsWhatTheBeliefsAlongItSayAndKeepsItsEnds) {
    const Problem problem;
    const Descended result(problem, kDetour);
    const auto path = result.descent.path();
    EXPECT_LT(result.descent.cost(), 0.98 * result.before);
    EXPECT_NEAR(result.descent.cost(), result.model->evaluate(path).back().cost, 1e-10);
    EXPECT_EQ(problem.space().position(path.front()), kDetour.front());
    EXPECT_EQ(problem.space().position(path.back()), kDetour.back());
    EXPECT_GE(result.descent.accepted(), 1U);
    EXPECT_LE(result.descent.accepted(), result.descent.tried());
}

TEST(PathDescent, StraightensWhatOnlyLengthCounts) {
    Problem problem;
    problem.belief.alpha = 1.;
    const Descended result(problem, kDetour);
    EXPECT_EQ(result.descent.path().size(), 2U);
    EXPECT_NEAR(result.descent.cost(), 8., 1e-9);
}

TEST(PathDescent, BendsAStraightPathTowardWhatCanBeSeen) {
    const Problem problem;
    const Descended result(problem, {problem.start, problem.goal});
    EXPECT_GT(result.descent.path().size(), 2U);
    EXPECT_LT(result.descent.cost(), 0.98 * result.before);
}

TEST(PathDescent, EndsWhereNothingCanBeTried) {
    const Problem problem;
    EXPECT_EQ(Descended(problem, {{3, 1, 2}}).descent.tried(), 0U);
    EXPECT_EQ(Descended(problem, {{3, 1, 2}, {3, 1.2, 2}}).descent.tried(), 0U);
}

TEST(PathDescent, ShortensThePathAroundAnObstacle) {
    Problem problem;  // a cylinder of 2 m, and 0.2 m of robot: tangents and an arc
    problem.belief.alpha = 1.;
    problem.clearance = [](const Vector3d& p) { return (p - Vector3d(5, 5, p.z())).norm() - 2.; };
    const Descended result(problem, {{1, 5, 2}, {2, 9, 2}, {8, 9, 2}, {9, 5, 2}});
    const double tangent = std::sqrt(16. - 2.2 * 2.2);
    const double arc = 2.2 * (std::numbers::pi - 2. * std::acos(2.2 / 4.));
    EXPECT_LT(result.length(), 1.01 * (2. * tangent + arc));
    const auto path = result.descent.path();
    for (std::size_t i = 1; i < path.size(); ++i) {
        EXPECT_TRUE(result.si->checkMotion(path[i - 1], path[i]));
    }
}

TEST(PathDescent, IsDeterministicAndEndsWithItsMoves) {
    const Problem problem;
    const Descended once(problem, kDetour, {.moves = 500});
    const Descended twice(problem, kDetour, {.moves = 500});
    EXPECT_DOUBLE_EQ(once.descent.cost(), twice.descent.cost());
    EXPECT_LT(once.descent.tried(), 510U);
    const Descended more(problem, kDetour, {.moves = 5000});
    EXPECT_LE(more.descent.cost(), once.descent.cost());
}

TEST(PathDescent, WorksWithHeadingAndInFullPose) {
    for (const StateKind kind : {StateKind::positionYaw, StateKind::se3}) {
        Problem problem;
        problem.kind = kind;
        problem.bounds = box({0, 0, 1}, {10, 10, 3});
        const Descended result(problem, kDetour, {.moves = 800});
        EXPECT_LT(result.descent.cost(), result.before);
        EXPECT_NEAR(result.descent.cost(),
                    result.model->evaluate(result.descent.path()).back().cost, 1e-9);
    }
}

TEST(PathDescent, DoublesAShiftThatHelped) {
    const std::vector<Vector3d> corner{{0, 0, 2}, {50, 80, 2}, {90, 0, 2}};
    const auto isNotStraight = [&](const Vector3d& from, const Vector3d& to) {
        return from != corner.front() || to != corner.back();
    };
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        EXPECT_TRUE(containsDoubledShift(shiftsOf(corner, seed, isNotStraight), corner[1]));
    }
}

TEST(PathDescent, DoublesAShiftOfALegThatHelped) {
    const std::vector<Vector3d> bridge{{0, 0, 2}, {30, 80, 2}, {60, 80, 2}, {90, 0, 2}};
    const auto keepsTheLeg = [&](const Vector3d& from, const Vector3d& to) {
        if (from == bridge[0]) return (to - bridge[1]).norm() < 5.;
        if (to == bridge[3]) return (from - bridge[2]).norm() < 5.;
        return (to - from).isApprox(bridge[2] - bridge[1], 1e-9);
    };
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        EXPECT_TRUE(containsDoubledShift(shiftsOf(bridge, seed, keepsTheLeg), bridge[1]));
    }
}

TEST(PathDescent, StopsByItsConditionAndContinues) {
    const Problem problem;
    Descended result(problem, kDetour, {.moves = 500}, 40);
    EXPECT_GE(result.descent.tried(), 40U);
    EXPECT_LT(result.descent.tried(), 50U);
    const double cost = result.descent.cost();
    EXPECT_LE(cost, result.before);
    EXPECT_NEAR(cost, result.model->evaluate(result.descent.path()).back().cost, 1e-10);
    result.descent.descend(ob::plannerNonTerminatingCondition());
    EXPECT_GE(result.descent.tried(), 500U);
    EXPECT_LT(result.descent.cost(), cost);
}

TEST(PathDescent, TriesNothingIfTheConditionHoldsAtOnce) {
    const Problem problem;
    const Descended result(problem, kDetour, {}, 0);
    EXPECT_EQ(result.descent.tried(), 0U);
    EXPECT_DOUBLE_EQ(result.descent.cost(), result.before);
}

}  // namespace
}  // namespace photonav::test
