// SPDX-License-Identifier: BSD-3-Clause
// Fly a plan with a body that estimates its pose from images alone, with a camera that looks
// straight down and with one that looks 45 degrees ahead, past a poster on the floor.
#include <ompl/base/ScopedState.h>

#include <cmath>
#include <cstdio>

#include "belief/belief.hpp"
#include "flight/flights.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "plot/figure.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"

using namespace photonav;

namespace {

constexpr int kFlights = 4;

/// A floor with almost no texture, and a strip of carpet across the way.
Scene paleFloor() {
    Scene scene;
    const auto pale = addTexture(
        scene, valueNoise({.size = {12., 6.}, .amplitudes = {0.004, 0.003, 0.002}, .seed = 1}));
    const auto carpet = addTexture(scene, valueNoise({.size = {1.5, 6.}, .seed = 2}));
    addPlane(scene, {-3., -3., 0.}, {12., 0., 0.}, {0., 6., 0.}, pale);
    addPlane(scene, {3.5, -3., 0.005}, {1.5, 0., 0.}, {0., 6., 0.}, carpet);
    return scene;
}

BeliefOptions beliefs() {
    BeliefOptions options;
    options.initialCovariance.diagonal() << 0.01, 0.01, 0.01, 1e-5, 1e-5, 1e-4;
    options.motionNoise.diagonal() << 4e-3, 4e-3, 1e-3, 4.5e-6, 4.5e-6, 1e-4;  // per metre
    return options;
}

//! [plan]
/// A straight plan of 5 m, with the beliefs predicted along it.
std::vector<PlannedView> plan(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                              const Pose& T_b_c, const PhotometricOptions& photometric) {
    const FlightSpace space(StateKind::position,
                            {Eigen::Vector3d(-1., -1., 1.), Eigen::Vector3d(6., 1., 2.)});
    const auto field = std::make_shared<InformationField>(
        map, camera, photometricModel(camera, photometric), T_b_c, InformationField::Options{});
    BeliefModel model(space, field, beliefs());
    ompl::base::ScopedState<> start(space.space());
    ompl::base::ScopedState<> goal(space.space());
    space.setState(start.get(), {0., 0., 1.6}, 0.);
    space.setState(goal.get(), {5., 0., 1.6}, 0.);
    return plannedViews(model.evaluate({start.get(), goal.get()}));
}
//! [plan]

double sigma(const Matrix6& covariance) {
    return std::sqrt(covariance.topLeftCorner<3, 3>().trace());
}

double error(const FlightSample& sample) {
    return (sample.belief.mean.inverse().translation() - sample.T_c_w.inverse().translation())
        .norm();
}

}  // namespace

int main() {
    const auto floor = std::make_shared<MeshRenderer>(paleFloor());
    const Camera camera = makeCamera(188, 120, 70. * kDegree);
    const PhotometricOptions photometric{.sigma = 0.02, .scale = 0.08};
    Plot plot;
    plot.x = {.min = 0., .label = "distance along the plan [m]"};
    plot.y = {.min = 0., .label = "position error [cm]"};

    struct Mount {
        const char* name;
        double belowHorizon;
        Color color;
    };
    for (const auto& [name, belowHorizon, color] :
         {Mount{"down", 90. * kDegree, {222, 79, 12}},
          Mount{"45 degrees ahead", 45. * kDegree, {28, 108, 214}}}) {
        //! [fly]
        FlightWorld world;
        world.truth = world.map = floor;
        world.clearance = [](const Eigen::Vector3d& p_w) { return p_w.z(); };  // the floor
        world.camera = camera;
        world.T_b_c = cameraMount(belowHorizon);
        world.noise = assumedNoise(photometric);
        FlightOptions options;
        options.robot.body.odometryNoise = beliefs().motionNoise;
        options.alignment.photometric = photometric;
        const std::vector<PlannedView> views = plan(floor, camera, world.T_b_c, photometric);
        const Matrix6 toCamera = adjoint(world.T_b_c.inverse());
        options.initialCovariance = toCamera * beliefs().initialCovariance * toCamera.transpose();
        std::vector<FlightResult> flights;
        for (options.seed = 1; options.seed <= kFlights; ++options.seed) {
            flights.push_back(fly(views, world, options));
        }
        //! [fly]
        std::printf("camera %s\n", name);
        for (const FlightResult& flight : flights) {
            double worst = 0.;
            for (const FlightSample& s : flight.samples) worst = std::max(worst, error(s));
            std::printf(
                "  %s after %4.1f s, largest error on the way %5.1f cm, %4.1f cm from the "
                "goal%s\n",
                nameOf(flight.end).c_str(), flight.duration, 100. * worst, 100. * flight.goalError,
                flight.photometric ? " by its image" : "");
        }
        Plot::Points predicted;
        for (const PlannedView& view : views) {
            predicted.emplace_back(view.distance, 100. * sigma(view.covariance));
        }
        plot.curve(predicted,
                   {.color = color, .width = 4., .name = std::string("predicted σ, ") + name});
        for (const FlightResult& flight : flights) {
            Plot::Points errors;
            for (const FlightSample& s : flight.samples) {
                errors.emplace_back(s.distance, 100. * error(s));
            }
            plot.curve(errors,
                       {.color = color, .width = 1., .name = std::string("flights, ") + name});
        }
    }
    Figure{"Predicted and actual errors", {{plot}}}.save("flights.png");
    std::puts("wrote flights.png");
}
