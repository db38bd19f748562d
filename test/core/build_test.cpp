// SPDX-License-Identifier: BSD-3-Clause
// What the build promises, as far as a program can see it.
#include <gtest/gtest.h>

#include <Eigen/Core>

namespace photonav {
namespace {

TEST(Build, SanitizersComeWithAssertions) {
#if defined(__SANITIZE_ADDRESS__)
    volatile int index = 3;
    EXPECT_DEATH(Eigen::VectorXd::Zero(3).eval()[index] = 1., "Assertion");
#else
    GTEST_SKIP() << "no sanitizer here";
#endif
}

}  // namespace
}  // namespace photonav
