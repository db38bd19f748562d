// SPDX-License-Identifier: BSD-3-Clause
#include "servo/servo_study.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <random>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "io/interrupted.hpp"
#include "render/area_sensor.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"
#include "simulation/camera_noise.hpp"

namespace photonav {
namespace {

MeshRenderer floorOf(Texture texture) {
    Scene scene;
    const auto id = addTexture(scene, std::move(texture));
    addPlane(scene, {-10., -10., 0.}, {20., 0., 0.}, {0., 20., 0.}, id);
    return MeshRenderer(std::move(scene));
}

/// 2 m above the middle of a floor.
ServoGoal goalOver(const MeshRenderer& floor) {
    ServoGoal goal{floor, makeCamera(94, 60, 1.2), cameraMount(1.2)};
    goal.T_w_b.translation().z() = 2.;
    return goal;
}

ServoStudy study(const ServoGoal& goal, ServoStudyOptions options) {
    const std::atomic<bool> running{false};
    return studyServo(goal, options, running, [](double) {});
}

TEST(ServoStudy, ConvergesNearTheGoalAsFastAsPredicted) {
    const MeshRenderer floor = floorOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    ServoStudyOptions options{.distances = {0.05, 6.}, .angles = {0., 3.}, .trials = 5};
    for (const bool hasTilt : {false, true}) {
        options.hasTilt = hasTilt;
        options.damping = 0.05;
        const ServoStudy result = study(goalOver(floor), options);
        ASSERT_EQ(result.modes.size(), hasTilt ? 6U : 4U);
        for (const ServoMode& mode : result.modes) {
            EXPECT_NEAR(mode.simulatedDecay, mode.predictedDecay, 0.1 * mode.predictedDecay)
                << inWords(mode, result.depth);
        }
        EXPECT_NEAR(result.depth, 2.1, 0.2);
        ASSERT_EQ(result.basin.size(), 4U);
        EXPECT_EQ(result.basin[0].converged, 5);  // 5 cm
        EXPECT_EQ(result.basin[1].converged, 0);  // 6 m: nothing of the goal's view is seen
        EXPECT_EQ(result.basin[2].converged, 5);  // 5 cm and 3 degrees
        // 5 of 5 by Wilson: z = 1.96
        EXPECT_NEAR(result.basin[0].low, 0.5655, 1e-3);
        EXPECT_EQ(result.basin[0].high, 1.);
        EXPECT_GT(result.basin[0].seconds, 0.5);
    }
}

/// One step of Gauss-Newton from images with noise errs as much as their information says.
TEST(ServoStudy, StandardDeviationsAreThoseOfOneImage) {
    const MeshRenderer floor = floorOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    const ServoGoal goal = goalOver(floor);
    const ServoStudy result = study(goal, {.distances = {0.05}, .angles = {0.}, .trials = 1});
    View view;
    AreaSensor(floor).render(goal.camera, (goal.T_w_b * goal.T_b_c).inverse(), view);
    applyPointSpread(view);
    Eigen::MatrixXd body = Eigen::MatrixXd::Zero(6, 4);
    body.topLeftCorner<3, 3>().setIdentity();
    body(5, 3) = 1.;
    const LevenbergServo servo(view, goal.camera, -adjoint(Pose(goal.T_b_c.inverse())) * body,
                               {goal.photometric, 1., 0.});
    const ImageNoise noise = assumedNoise({.sigma = goal.photometric.sigma});
    std::mt19937_64 random(1);
    constexpr int kImages = 1000;
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    for (int i = 0; i < kImages; ++i) {
        ImageF image = view.intensity;
        noise(image, random, {});
        const Eigen::VectorXd q = servo.velocity(image);
        covariance += q * q.transpose() / kImages;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> position(covariance.topLeftCorner<3, 3>());
    EXPECT_NEAR(result.positionSigma, std::sqrt(position.eigenvalues()[2]),
                0.1 * result.positionSigma);
    EXPECT_NEAR(result.rotationSigma, std::sqrt(covariance(3, 3)), 0.1 * result.rotationSigma);
}

TEST(ServoStudy, NamesTheDirectionThatIsOpen) {
    const MeshRenderer floor = floorOf(stripes());  // bars along y
    const ServoStudy blind =
        study(goalOver(floor), {.distances = {0.05}, .angles = {0.}, .trials = 2});
    EXPECT_EQ(blind.modes[0].rate, 0.);
    EXPECT_EQ(inWords(blind.modes[0], blind.depth), "y");
    EXPECT_GT(blind.modes[1].rate, 0.);
    EXPECT_GT(blind.condition, 1e6);
    EXPECT_EQ(blind.openDirections(), 1U);
    EXPECT_EQ(blind.positionSigma, kInfinity);
}

/// Views of which one sets a flag.
struct InterruptingViews : ViewSource {
    const ViewSource& views;
    int last;
    mutable int rendered = 0;
    mutable std::atomic<bool> interrupted = false;

    InterruptingViews(const ViewSource& of, int number) : views(of), last(number) {}
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        interrupted = ++rendered >= last;
        views.render(camera, T_c_w, view);
    }
};

TEST(ServoStudy, EndsWithinATrial) {
    const MeshRenderer floor = floorOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    const auto studied = [&](const InterruptingViews& views) {
        const ServoGoal over = goalOver(floor);
        const ServoGoal goal{views, over.camera, over.T_b_c, over.T_w_b};
        return studyServo(goal, {.distances = {0.05}, .angles = {0., 1.}, .trials = 2},
                          views.interrupted, [](double) {});
    };
    const InterruptingViews all(floor, std::numeric_limits<int>::max());
    EXPECT_EQ(studied(all).trials(), 4);
    const InterruptingViews most(floor, all.rendered - 1);
    const ServoStudy cut = studied(most);
    EXPECT_TRUE(cut.interrupted);
    EXPECT_EQ(cut.trials(), 3);
    EXPECT_EQ(most.rendered, all.rendered - 1);
    for (const int first : {1, 2}) {  // the goal, and a mode
        const InterruptingViews few(floor, first);
        EXPECT_THROW(studied(few), Interrupted);
        EXPECT_EQ(few.rendered, first);
    }
}

TEST(ServoMode, IsSaidInWords) {
    ServoMode mode;
    mode.direction << 0.1, -0.8, 0., 0.2, 0., 0.;
    EXPECT_EQ(inWords(mode, 1.), "y +73 %, roll -18 %");
    EXPECT_EQ(inWords(mode, 2.), "y +62 %, roll -31 %");
    EXPECT_EQ(inWords(mode, 8.), "roll +64 %, y -32 %");
    mode.direction << 0., 0., -1., 0., 0., 0.001;
    EXPECT_EQ(inWords(mode, 1.), "z");
}

}  // namespace
}  // namespace photonav
