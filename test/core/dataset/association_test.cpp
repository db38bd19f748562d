// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

namespace photonav {
namespace {

/// Every pair within the tolerance, closest first.
std::vector<int> bruteForce(const std::vector<double>& a, const std::vector<double>& b,
                            double tolerance) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            const double difference = std::abs(a[i] - b[j]);
            if (difference <= tolerance) pairs.emplace_back(difference, i, j);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<int> partner(a.size(), -1);
    std::vector<bool> taken(b.size(), false);
    for (const auto& [difference, i, j] : pairs) {
        if (partner[i] >= 0 || taken[j]) continue;
        partner[i] = static_cast<int>(j);
        taken[j] = true;
    }
    return partner;
}

std::vector<double> randomTimes(std::mt19937& random, std::size_t count) {
    std::vector<double> times(count);
    for (double& time : times) time = 1e-3 * static_cast<double>(random() % 100000);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

TEST(Association, MakesThePairsOfACompleteSearch) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 100; ++trial) {
        const auto a = randomTimes(random, 1 + random() % 60);
        const auto b = randomTimes(random, 1 + random() % 60);
        for (const double tolerance : {0.05, 1., 200.}) {
            EXPECT_EQ(associate(a, b, tolerance), bruteForce(a, b, tolerance)) << trial;
        }
    }
}

TEST(Association, PairsRepeatedTimestampsInOrder) {
    EXPECT_EQ(associate({1., 1., 2.}, {1., 1., 1.}, 0.1), (std::vector<int>{0, 1, -1}));
    EXPECT_EQ(associate({}, {1.}, 0.1), std::vector<int>{});
    EXPECT_EQ(associate({1.}, {}, 0.1), std::vector<int>{-1});
}

/// All are within the tolerance of all: 4e10 pairs.
TEST(Association, TakesNoMoreForDenseLists) {
    std::vector<double> times(200000);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = 1e-6 * static_cast<double>(i);
    const auto partner = associate(times, times, 1.);
    for (std::size_t i = 0; i < times.size(); ++i) ASSERT_EQ(partner[i], static_cast<int>(i));
}

}  // namespace
}  // namespace photonav
