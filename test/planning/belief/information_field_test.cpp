// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "geometry/se3.hpp"
#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

Pose bodyAt(double x, double y, double yaw = 0.) { return levelPose({x, y, 2.}, yaw); }

Matrix6 growsAlongX(const Pose& T_c_w) {
    return (1. + T_c_w.inverse().translation().x()) * Matrix6::Identity();
}

class Nothing : public ViewSource {
  public:
    void render(const Camera&, const Pose&, View&) const override {}
};

TEST(InformationField, CountsViewsAndHits) {
    InformationField field(growsAlongX, Pose::Identity(), {});
    field.at(bodyAt(1.01, 0.));
    field.at(bodyAt(1.02, 0.01));  // the same cell
    field.at(bodyAt(1.02, 0.01, 0.5));
    field.at(bodyAt(3., 0.));
    EXPECT_EQ(field.views(), 3U);
    EXPECT_EQ(field.cacheHits(), 1U);
    field.clear();
    EXPECT_EQ(field.views() + field.cacheHits(), 0U);
}

TEST(InformationField, AMapIsReplacedByAMapOnly) {
    const Camera camera = makeCamera(8, 8, 1.);
    InformationField field(std::make_shared<Nothing>(), camera, photometricModel(camera, {}),
                           Pose::Identity(), {});
    EXPECT_THROW(field.update(nullptr, {}), std::invalid_argument);
}

TEST(InformationField, ValueDoesNotDependOnTheOrderOfQueries) {
    InformationField forward(growsAlongX, Pose::Identity(), {});
    InformationField backward(growsAlongX, Pose::Identity(), {});
    for (int i = 0; i <= 100; ++i) forward.at(bodyAt(0.01 * i, 0.));
    for (int i = 100; i >= 0; --i) backward.at(bodyAt(0.01 * i, 0.));
    for (int i = 0; i <= 100; ++i) {
        const Pose pose = bodyAt(0.01 * i, 0.);
        EXPECT_EQ(forward.at(pose).information, backward.at(pose).information);
    }
}

TEST(InformationField, EvaluatesWithinHalfACell) {
    const InformationField::Options options{.positionPitch = 0.2, .rotationPitch = 0.1};
    Pose asked;
    InformationField field(
        [&](const Pose& T_c_w) {
            asked = T_c_w.inverse();
            return Matrix6::Identity();
        },
        Pose::Identity(), options);
    std::mt19937 random(5);
    std::uniform_real_distribution<> uniform(-3., 3.);
    for (int i = 0; i < 200; ++i) {
        field.clear();
        const Pose pose = bodyAt(uniform(random), uniform(random), uniform(random));
        field.at(pose);
        EXPECT_LE((asked.translation() - pose.translation()).cwiseAbs().maxCoeff(), 0.1 + 1e-6);
        EXPECT_LE(Eigen::AngleAxisd(asked.linear().transpose() * pose.linear()).angle(),
                  0.05 * std::sqrt(3.) + 1e-6);
    }
}

TEST(InformationField, NamesViewsWithoutInformation) {
    InformationField field(stripesThenTexture, cameraMount(std::numbers::pi / 2), {});
    EXPECT_TRUE(field.at(bodyAt(1., 1.)).isZero);
    EXPECT_FALSE(field.at(bodyAt(4.5, 1.)).isZero);
}

TEST(InformationField, KeepsInformationInAxesOfTheWorldWhateverTheHeading) {
    // The camera observes world x only; the heading is not that of a cell's centre.
    InformationField field(
        [](const Pose& T_c_w) {
            const Matrix6 alongX = vector6(4., 0., 0., 0., 0., 0.).asDiagonal();
            return inRotatedAxes(alongX, T_c_w.linear());
        },
        cameraMount(std::numbers::pi / 4), {});
    for (const double yaw : {-0.03, 0.04, 1., 3.1}) {
        const Matrix6& information = field.at(bodyAt(0., 0., yaw)).information;
        EXPECT_NEAR(information(0, 0), 4., 1e-12);
        EXPECT_NEAR(information.norm(), 4., 1e-12);
    }
}

TEST(InformationField, AModelThatThrowsLeavesItUsable) {
    bool fail = true;
    InformationField field(
        [&](const Pose&) -> Matrix6 {
            if (fail) throw std::runtime_error("no view");
            return Matrix6::Identity();
        },
        Pose::Identity(), {});
    EXPECT_THROW(field.at(bodyAt(0., 0.)), std::runtime_error);
    fail = false;
    EXPECT_TRUE(field.at(bodyAt(0., 0.)).information.isIdentity(1e-12));
    EXPECT_EQ(field.views(), 1U);
}

TEST(InformationField, NegativeInformationCountsAsNone) {
    // Positive along the diagonal, but negative for y - z.
    Matrix6 indefinite = vector6(4., 1., 1e4, 0., 1., 1.).asDiagonal();
    indefinite(1, 2) = indefinite(2, 1) = 120.;
    InformationField field([&](const Pose&) { return indefinite; }, Pose::Identity(), {});
    const Matrix6 information = field.at(bodyAt(0., 0.)).information;
    EXPECT_TRUE(isCovariance(information)) << information;
    EXPECT_DOUBLE_EQ(information(0, 0), 4.);
    EXPECT_GT(information(2, 2), 1e4);

    indefinite(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(field.at(bodyAt(9., 0.)), std::domain_error);
}

TEST(InformationField, RejectsAPitchOfZero) {
    EXPECT_THROW(InformationField(growsAlongX, Pose::Identity(), {0., 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace photonav::test
