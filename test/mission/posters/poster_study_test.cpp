// SPDX-License-Identifier: BSD-3-Clause
#include "posters/poster_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "check/check_result.hpp"
#include "io/error.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

constexpr auto kIgnored = [](std::size_t, const PosterIndices&) {};

Poster sheet(const std::string& name, Texture texture, const Eigen::Vector3d& corner,
             const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    Poster poster{name, {}};
    addPlane(poster.surfaces, corner, u, v, addTexture(poster.surfaces, std::move(texture)));
    return poster;
}

Texture wool(unsigned seed) {
    return valueNoise({.size = {2., 2.}, .cells = {0.3, 0.1}, .seed = seed});
}

/// A camera that looks down from 2 m onto a white floor, and flies 4 m straight on.
class PosterStudy : public testing::Test {
  protected:
    PosterStudy() {
        const auto white = addTexture(problem_.scene, uniformTexture(0.9));
        addPlane(problem_.scene, {-5., -5., 0.}, {15., 0., 0.}, {0., 10., 0.}, white);
        problem_.T_w_goal.translation() = problem_.config.goal.position;
        problem_.options.servo.distances = {0.1};
        problem_.options.servo.angles = {0.};
        problem_.options.servo.trials = 2;
        problem_.options.servo.duration = 10.;
    }

    static PosterProblem emptyProblem() {
        return {.config = parseConfig("scene: {file: none.yaml}\n"
                                      "space: xyz\n"
                                      "bounds: [[-1, -2, 2], [5, 2, 2]]\n"
                                      "start: [0, 0, 2]\n"
                                      "goal: [4, 0, 2]\n"
                                      "camera: {width: 94, height: 60}\n"
                                      "planner: {vertices: 100, kappa: 10, alpha: 0.5}\n",
                                      "test.yaml"),
                .file = "posters.yaml"};
    }

    static Poster carpetAtTheGoal() {
        return sheet("carpet", wool(3), {3., -1., 0.01}, {2., 0., 0.}, {0., 2., 0.});
    }
    static Poster whiteSheet() {
        return sheet("white", uniformTexture(0.9), {3., -1., 0.02}, {2., 0., 0.}, {0., 2., 0.});
    }
    static Poster outOfView() {
        return sheet("out of view", wool(4), {-4.9, -4., 0.5}, {0., 1., 0.}, {0., 0., 1.});
    }

    void flyStraight() {
        GivenTrajectory straight{TrajectoryFormat::table, true, {{}, {}}};
        straight.poses[0].T_w_b.translation() = problem_.config.start.position;
        straight.poses[1].T_w_b.translation() = problem_.config.goal.position;
        problem_.options.trajectory = straight;
    }
    PosterRanking rank() const { return rankPosters(problem_, kNotInterrupted, kIgnored); }
    std::vector<std::string> names(const PosterRanking& ranking) const {
        std::vector<std::string> all;
        for (const PosterSet& set : ranking.sets) {
            all.push_back(nameOf(set.posters, problem_.posters));
        }
        return all;
    }
    std::string refusal() const {
        return test::messageOf<InputError>([&] { checkPosters(problem_); });
    }

    PosterProblem problem_ = emptyProblem();
};

using Names = std::vector<std::string>;

TEST_F(PosterStudy, TextureAtTheGoalBeatsWhiteThere) {
    problem_.posters = {whiteSheet(), carpetAtTheGoal()};
    for (const RankBy by : {RankBy::path, RankBy::goal}) {
        problem_.options.rankBy = by;
        const PosterRanking ranking = rank();
        EXPECT_EQ(names(ranking), (Names{"carpet", "none", "white"}));
        const PosterSet &carpet = ranking.sets[0], &none = ranking.sets[1];
        EXPECT_EQ(carpet.servo.converged(), 2);
        EXPECT_LT(carpet.servo.positionSigma, 0.01);
        EXPECT_EQ(none.servo.openDirections(), 4U);
        EXPECT_LT(carpet.path->places.back().trace, 0.1 * none.path->places.back().trace);
        EXPECT_LT(carpet.cost, none.cost);
    }
}

TEST_F(PosterStudy, WhatIsOutOfViewChangesNothing) {
    addPlane(problem_.scene, {1., -1., 0.01}, {1., 0., 0.}, {0., 2., 0.},
             addTexture(problem_.scene, wool(5)));
    problem_.posters = {outOfView()};
    const PosterRanking ranking = rank();
    EXPECT_EQ(names(ranking), (Names{"none", "out of view"}));
    const PosterSet &none = ranking.sets[0], &out = ranking.sets[1];
    EXPECT_GT(none.path->places.front().trace,
              none.path->places.back().trace);  // it sees the strip
    EXPECT_EQ(localisationJson(*out.path), localisationJson(*none.path));
    EXPECT_EQ(out.cost, none.cost);
    EXPECT_EQ(out.servo.condition, none.servo.condition);
    const ImageF &seen = out.goalView->intensity, &before = none.goalView->intensity;
    EXPECT_TRUE(std::equal(seen.bitmap, seen.bitmap + seen.getSize(), before.bitmap));
}

TEST_F(PosterStudy, SetsGrowWhileThatIsBetterAndNothingLiesInThem) {
    flyStraight();
    problem_.options.most = 3;
    const Poster halfway = sheet("halfway", wool(6), {1., -1., 0.01}, {1.5, 0., 0.}, {0., 2., 0.});
    const Poster instead = sheet("instead", wool(7), {3.5, -1., 0.01}, {2., 0., 0.}, {0., 2., 0.});
    problem_.posters = {carpetAtTheGoal(), instead, halfway, outOfView()};
    const PosterRanking ranking = rank();
    EXPECT_EQ(names(ranking).front(), "halfway + carpet");
    const Names all = names(ranking);
    const auto has = [&](const std::string& name) { return std::ranges::count(all, name) == 1; };
    EXPECT_TRUE(has("halfway + instead"));
    EXPECT_TRUE(has("halfway + out of view"));
    EXPECT_TRUE(has("halfway + carpet + out of view"));
    EXPECT_FALSE(has("halfway + carpet + instead"));  // on each other
    EXPECT_EQ(all.size(), 5U + 3U + 1U);
}

TEST_F(PosterStudy, AnyNumberOfThreadsRanksAlike) {
    addPlane(problem_.scene, {1., 1., 0.01}, {2., 0., 0.}, {0., 1.5, 0.},
             addTexture(problem_.scene, wool(5)));  // worth a detour
    problem_.posters = {whiteSheet(), carpetAtTheGoal(), outOfView()};
    const PosterRanking one = rank();
    problem_.options.jobs = 3;
    const PosterRanking three = rank();
    ASSERT_EQ(names(one), names(three));
    for (std::size_t i = 0; i < one.sets.size(); ++i) {
        EXPECT_EQ(localisationJson(*one.sets[i].path), localisationJson(*three.sets[i].path));
        EXPECT_EQ(one.sets[i].servo.basin[0].seconds, three.sets[i].servo.basin[0].seconds);
    }
}

TEST_F(PosterStudy, AnInterruptKeepsTheSetsThatAreDone) {
    problem_.options.hasPath = false;
    problem_.options.rankBy = RankBy::goal;
    problem_.posters = {whiteSheet(), carpetAtTheGoal(), outOfView()};
    std::atomic<bool> interrupted = false;
    const PosterRanking ranking =
        rankPosters(problem_, interrupted,
                    [&](std::size_t done, const PosterIndices&) { interrupted = done == 2; });
    EXPECT_TRUE(ranking.interrupted);
    EXPECT_EQ(names(ranking), (Names{"none", "white"}));
}

TEST_F(PosterStudy, ACandidateMustLeaveRoomForStartGoalAndTrajectory) {
    const auto boxAt = [](double x) {
        Poster box{"box", {}};
        addBox(box.surfaces, {x - 0.5, -0.5, 0.}, {x + 0.5, 0.5, 2.5},
               addTexture(box.surfaces, wool(8)));
        return box;
    };
    const auto expectRefused = [&](double x, const std::string& what) {
        problem_.posters = {whiteSheet(), boxAt(x)};
        EXPECT_TRUE(refusal().starts_with("posters.yaml: candidates[1]: 'box' puts the " + what))
            << refusal();
    };
    expectRefused(0., "start in collision: clearance -0.0");
    expectRefused(4., "goal in collision: clearance -0.0");
    problem_.posters = {boxAt(2.)};
    EXPECT_EQ(refusal(), "");  // a path is planned around it
    flyStraight();
    expectRefused(2., "trajectory in collision: clearance -0.0");
}

TEST_F(PosterStudy, ACandidateMustNotLieInASurface) {
    problem_.posters = {
        sheet("flat", wool(9), {1., -1., 0.}, {1., 0., 0.}, {0., 1., 0.}),
    };
    EXPECT_EQ(refusal(),
              "posters.yaml: candidates[0]: 'flat' lies in a surface of the scene; put it a "
              "centimetre in front");
    Poster crate{"crate", {}};
    addBox(crate.surfaces, {1., 0.8, 0.}, {2., 1.8, 1.}, addTexture(crate.surfaces, wool(8)));
    problem_.posters = {carpetAtTheGoal(), crate};  // a box may stand on the floor
    EXPECT_EQ(refusal(), "");
}

TEST(Posters, FilesAreReadAsScenesAre) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("posters.yaml");
    const auto complaint = [&](const std::string& text) {
        folder.write("posters.yaml", text);
        const std::string message = test::messageOf<InputError>([&] { readPosters(file); });
        return message.empty() ? message : message.substr(file.size() + 2);
    };
    const std::string surface =
        "textures: [{name: t}], planes: [{corner: [0, 0, 1], u: [1, 0, 0], v: [0, 1, 0], "
        "texture: t}]";
    EXPECT_EQ(complaint("candidates: [{name: a, " + surface + "}, {name: b, " + surface + "}]"),
              "");
    EXPECT_EQ(readPosters(file)[1].name, "b");
    EXPECT_EQ(readPosters(file)[1].surfaces.triangles.size(), 2U);
    EXPECT_EQ(complaint("candidates: []"), "candidates: there are none");
    EXPECT_EQ(complaint("candidates: [{" + surface + "}]"), "candidates[0].name: missing");
    EXPECT_EQ(complaint("candidates: [{name: a, " + surface + "}, {name: a, " + surface + "}]"),
              "candidates[1].name: 'a' is there twice");
    EXPECT_EQ(complaint("candidates: [{name: none, " + surface + "}]"),
              "candidates[0].name: 'none' stands for the scene as it is");
    EXPECT_EQ(complaint("candidates: [{name: a, plains: []}]"),
              "candidates[0].plains: unknown key, did you mean 'candidates[0].planes'?");
    EXPECT_EQ(complaint("candidates: [{name: a}]"), "candidates[0]: the scene has no surfaces");
    EXPECT_EQ(complaint("candidats: [{name: a}]"),
              "candidats: unknown key, did you mean 'candidates'?");
}

}  // namespace
}  // namespace photonav
