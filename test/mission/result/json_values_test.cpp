// SPDX-License-Identifier: BSD-3-Clause
#include "result/json_values.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/constants.hpp"

namespace photonav {
namespace {

using nlohmann::json;

TEST(ResultText, NumbersThatAreNotFiniteAreNullWithAReason) {
    const double infinity = std::numeric_limits<double>::infinity();
    const json result{{"gain", kNone},
                      {"runs", {{{"cost", 1.5}}, {{"cost", infinity}}}},
                      {"none", nullptr},
                      {"name", "nan"}};
    const json read = json::parse(jsonText(result));
    EXPECT_TRUE(read["gain"].is_null());
    EXPECT_TRUE(read["runs"][1]["cost"].is_null());
    EXPECT_EQ(read["not_finite"], (json{{"/gain", "not a number"}, {"/runs/1/cost", "infinite"}}));
    EXPECT_EQ(json::parse(jsonText({{"cost", 1.5}, {"none", nullptr}})),
              (json{{"cost", 1.5}, {"none", nullptr}}));
}

}  // namespace
}  // namespace photonav
