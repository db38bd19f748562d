// SPDX-License-Identifier: BSD-3-Clause
#include "io/number.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

using Numbers = std::vector<double>;

TEST(Numbers, MayHaveASignAndNothingElseAround) {
    EXPECT_EQ(numberIn("+1.5"), 1.5);
    EXPECT_EQ(numberIn("-1.5e2"), -150.);
    EXPECT_EQ(numberIn<unsigned>("+7"), 7U);
    for (const char* bad : {"", "+", "+-1", "++1", "1 ", " 1", "1,5", "0x10", "1e999"}) {
        EXPECT_FALSE(numberIn(bad)) << bad;
    }
    EXPECT_FALSE(numberIn<unsigned>("-1"));
    EXPECT_FALSE(numberIn<unsigned>("4294967296"));
}

TEST(Numbers, OfAListAreFiniteAndNoneIsMissing) {
    EXPECT_EQ(numbersIn("1", ','), Numbers{1.});
    EXPECT_EQ(numbersIn("1, +2 ,-3", ','), (Numbers{1., 2., -3.}));
    EXPECT_EQ(numbersIn("0.1:0.9:0.2", ':'), (Numbers{0.1, 0.9, 0.2}));
    for (const char* bad : {"", ",", "1,", ",1", "1,,2", "1;2", "1,nan", "inf", "1 2"}) {
        EXPECT_FALSE(numbersIn(bad, ',')) << bad;
    }
}

}  // namespace
}  // namespace photonav
