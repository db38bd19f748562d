// SPDX-License-Identifier: BSD-3-Clause
#include "planners/roadmap.hpp"

#include <gtest/gtest.h>

#include <random>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

/// Bricks of 0.4 m from (2.8, 4, 0) to (4.8, 4.4, 0.4).
MapChange wall() {
    MapChange change{.resolution = 0.1};
    for (int x = 0; x < 5; ++x) change.occupancy.emplace_back(7 + x, 10, 0);
    change.normalize();
    return change;
}

TEST(ChangedSpace, IsTouchedByWhatPassesTheChangeWithinTheCap) {
    const MapChange change = wall();
    const ChangedSpace changed(change, 0.5);
    Eigen::AlignedBox3d grown = change.box();
    grown.min().array() -= 0.7;  // two cells beyond the cap
    grown.max().array() += 0.7;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0., 8.);
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3d from(uniform(random), uniform(random), 0.2);
        Vector3d to(uniform(random), uniform(random), 0.2);
        if (i % 3 == 0) to.x() = from.x();  // along an axis
        bool passes = false;
        for (double t = 0.; t <= 1.; t += 1e-3) {
            passes = passes || grown.contains(from + t * (to - from));
        }
        touching += passes ? 1 : 0;
        EXPECT_TRUE(changed.touches(from, to) || !passes);
        EXPECT_EQ(changed.contains(from), grown.contains(from));
        EXPECT_EQ(changed.touches(from, to), changed.touches(to, from));
    }
    EXPECT_GT(touching, 200);
    EXPECT_FALSE(changed.touches({0., 0., 0.2}, {8., 0., 0.2}));
    EXPECT_FALSE(changed.touches({0., 4.2, 0.2}, {1., 4.2, 0.2}));  // ends before it
}

/// Of two changes far from each other, not the space between them.
TEST(ChangedSpace, IsNearEveryChangeAlone) {
    MapChange change{.resolution = 0.1};
    change.occupancy.emplace_back(0, 0, 0);
    change.occupancy.emplace_back(20, 0, 0);  // at 8 m
    const ChangedSpace changed(change, 0.5);
    EXPECT_TRUE(changed.contains({0.2, 0.2, 0.2}));
    EXPECT_TRUE(changed.contains({8.2, 0.2, 0.2}));
    EXPECT_FALSE(changed.contains({4., 0.2, 0.2}));
    EXPECT_FALSE(changed.touches({2., 0.2, 0.2}, {6., 0.2, 0.2}));
    EXPECT_TRUE(changed.touches({4., 0.2, 0.2}, {8., 0.2, 0.2}));
}

TEST(ChangedSpace, IsEmptyWhereOnlyTextureChanged) {
    MapChange change{.resolution = 0.1};
    change.texture.emplace_back(0, 0, 0);
    const ChangedSpace changed(change, 0.5);
    EXPECT_FALSE(changed.contains({0.1, 0.1, 0.1}));
    EXPECT_FALSE(changed.touches({-1., 0.1, 0.1}, {1., 0.1, 0.1}));
}

/// Three vertices in a row, each joined to the next.
struct Row {
    Row() : si(Problem{}.spaceInformation()), model(Problem{}.model()) {
        for (unsigned i = 0; i < 3; ++i) {
            vertices.push_back({si->allocState(), i, false});
            Problem{}.space().setState(vertices[i].state, {2. + 2. * i, 6., 2.}, 0.);
        }
        for (unsigned i = 0; i < 2; ++i) join(i, i + 1);
    }
    ~Row() {
        for (Vertex& vertex : vertices) si->freeState(vertex.state);
    }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;

    Roadmap::Edge& join(unsigned i, unsigned j) {
        return roadmap.add(&vertices[i], &vertices[j],
                           model->motion(vertices[i].state, vertices[j].state));
    }

    ob::SpaceInformationPtr si;
    std::shared_ptr<BeliefModel> model;
    std::deque<Vertex> vertices;
    Roadmap roadmap;
};

TEST(Roadmap, RemovesTheEdgesOfAVertexAtBothEnds) {
    Row row;
    row.roadmap.removeEdgesOf(row.vertices[1]);
    for (const Vertex& vertex : row.vertices) EXPECT_TRUE(row.roadmap.of(&vertex).empty());
    Roadmap::Edge& edge = row.join(0, 2);  // in the place of a removed one
    EXPECT_EQ(row.roadmap.of(&row.vertices[2]), std::vector<Roadmap::Edge*>{&edge});
    EXPECT_EQ(edge.otherEnd(&row.vertices[0]), &row.vertices[2]);
    EXPECT_FALSE(edge.isFree.has_value());
}

TEST(Roadmap, ChecksAgainWhatPassesTheChange) {
    Row row;
    Roadmap::Edge& first = *row.roadmap.of(&row.vertices[0]).front();
    Roadmap::Edge& second = *row.roadmap.of(&row.vertices[2]).front();
    EXPECT_TRUE(Roadmap::isFree(first, *row.si));
    second.isFree = false;
    MapChange change{.resolution = 0.1};
    change.occupancy.emplace_back(14, 15, 5);  // at (5.6, 6, 2)
    EXPECT_EQ(row.roadmap.mapChanged(ChangedSpace(change, 0.5), row.model->space(), *row.si), 0U);
    EXPECT_TRUE(first.isFree.has_value());
    EXPECT_FALSE(second.isFree.has_value());
    EXPECT_TRUE(Roadmap::isFree(second, *row.si));
}

TEST(Roadmap, ChecksAllEdgesOnce) {
    Row row;
    int checks = 0;
    Problem counted;
    counted.clearance = [&](const Eigen::Vector3d& p) {
        ++checks;
        return std::abs(p.x() - 5.6);
    };
    const auto si = counted.spaceInformation();
    EXPECT_FALSE(row.roadmap.checkAll(*si, ob::PlannerTerminationCondition([] { return true; })));
    EXPECT_EQ(checks, 0);
    const auto never = ob::plannerNonTerminatingCondition();
    EXPECT_TRUE(row.roadmap.checkAll(*si, never));
    EXPECT_TRUE(*row.roadmap.of(&row.vertices[0]).front()->isFree);
    EXPECT_FALSE(*row.roadmap.of(&row.vertices[2]).front()->isFree);
    const int once = checks;
    row.roadmap.removeEdgesOf(row.vertices[0]);
    EXPECT_TRUE(row.roadmap.checkAll(*si, never));
    EXPECT_EQ(checks, once);
}

TEST(Roadmap, CountsTheEdgesThatAChangeBlocks) {
    Row row;
    for (const unsigned i : {0U, 2U}) {
        EXPECT_TRUE(Roadmap::isFree(*row.roadmap.of(&row.vertices[i]).front(), *row.si));
    }
    MapChange change{.resolution = 0.1};
    change.occupancy.emplace_back(14, 15, 5);  // at (5.6, 6, 2)
    Problem blocked;
    blocked.clearance = [](const Eigen::Vector3d& p) { return std::abs(p.x() - 5.6); };
    const auto si = blocked.spaceInformation();
    EXPECT_EQ(row.roadmap.mapChanged(ChangedSpace(change, 0.5), row.model->space(), *si), 1U);
    EXPECT_TRUE(*row.roadmap.of(&row.vertices[0]).front()->isFree);
    EXPECT_FALSE(*row.roadmap.of(&row.vertices[2]).front()->isFree);
}

}  // namespace
}  // namespace photonav::test
