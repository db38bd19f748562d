// SPDX-License-Identifier: BSD-3-Clause
// What the build promises, as far as a program can see it.
#include <gtest/gtest.h>

#include <Eigen/Core>

namespace photonav {
namespace {

TEST(Build, SanitizersComeWithAssertions) {
#ifdef PHOTONAV_SANITIZED
    Eigen::VectorXd three(3);
    EXPECT_DEATH(three[three.size()] = 1., "Assertion");
#else
    GTEST_SKIP() << "no sanitizer here";
#endif
}

}  // namespace
}  // namespace photonav
