// SPDX-License-Identifier: BSD-3-Clause
// Fly a plan with a body that estimates its pose from images alone, with a camera that looks
// straight down and with one that looks 45 degrees ahead, past a poster on the floor.
#include <cmath>
#include <cstdio>

#include "exercises.hpp"
#include "flight/flight_setup.hpp"
#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"
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

//! [problem]
/// 5 m straight on, with a camera that looks down or 45 degrees ahead.
Config straightFlight(const std::string& mount) {
    Config config;
    config.bounds = {Eigen::Vector3d(-1., -1., 1.), Eigen::Vector3d(6., 1., 2.)};
    config.start.position = {0., 0., 1.6};
    config.goal.position = {5., 0., 1.6};
    config.camera.mount = mount;
    config.photometric = {.sigma = 0.02, .scale = 0.08};
    config.belief.initialCovariance.diagonal() << 0.01, 0.01, 0.01, 1e-5, 1e-5, 1e-4;
    config.belief.motionNoise.diagonal() << 4e-3, 4e-3, 1e-3, 4.5e-6, 4.5e-6, 1e-4;  // per metre
    return config;
}
//! [problem]

double sigma(const Matrix6& covariance) {
    return std::sqrt(covariance.topLeftCorner<3, 3>().trace());
}

double error(const FlightSample& sample) {
    return (sample.belief.mean.inverse().translation() - sample.T_c_w.inverse().translation())
        .norm();
}

void print(const std::vector<FlightResult>& flights) {
    for (const FlightResult& flight : flights) {
        double worst = 0.;
        for (const FlightSample& s : flight.samples) worst = std::max(worst, error(s));
        std::printf(
            "  %s after %4.1f s, largest error on the way %5.1f cm, %4.1f cm from the goal%s\n",
            nameOf(flight.end).c_str(), flight.duration, 100. * worst, 100. * flight.goalError,
            flight.photometric ? " by its image" : "");
    }
}

void draw(Plot& plot, const std::string& mount, const Color& color,
          const std::vector<PlannedView>& plan, const std::vector<FlightResult>& flights) {
    Plot::Points predicted;
    for (const PlannedView& view : plan) {
        predicted.emplace_back(view.distance, 100. * sigma(view.covariance));
    }
    plot.curve(predicted, {.color = color, .width = 4., .name = "predicted σ, " + mount});
    for (const FlightResult& flight : flights) {
        Plot::Points errors;
        for (const FlightSample& s : flight.samples) {
            errors.emplace_back(s.distance, 100. * error(s));
        }
        plot.curve(errors, {.color = color, .width = 1., .name = "flights, " + mount});
    }
}

/// Predicted standard deviation of the position at the end of a way along x [cm].
double predictedAt(double x, const Config& config) {
    const World world(paleFloor(), config);
    const Place end{{x, 0., 1.6}, {}};
    PlanningProblem problem(config, world);
    return 100. * sigma(problem.evaluate("straight", {config.start, end}).points.back().covariance);
}

std::vector<Exercise> exercises() {
    Config slippery = straightFlight("down");
    slippery.belief.motionNoise *= 4.;
    return {{[] { return predictedAt(2., straightFlight("down")); }, 0.05},
            {[=] { return predictedAt(2., slippery); }, 0.05}};
}

}  // namespace

int main(int argc, char** argv) {
    if (const auto code = checkAnswers(argc, argv, exercises())) return *code;
    Plot plot;
    plot.x = {.min = 0., .label = "distance along the plan [m]"};
    plot.y = {.min = 0., .label = "position error [cm]"};
    for (const auto& [mount, color] : {std::pair{"down", kIndigo}, {"front45", kWine}}) {
        //! [fly]
        const Config config = straightFlight(mount);
        const World world(paleFloor(), config);
        PlanningProblem problem(config, world);
        const EvaluatedPath path = problem.evaluate("straight", {config.start, config.goal});
        const std::vector<PlannedView> plan = plannedViews(path.points);
        FlightSetup setup = setUpFlight(problem);
        std::vector<FlightResult> flights;
        for (setup.options.seed = 1; setup.options.seed <= kFlights; ++setup.options.seed) {
            flights.push_back(fly(plan, setup.world, setup.options));
        }
        //! [fly]
        std::printf("camera %s\n", mount);
        print(flights);
        draw(plot, mount, color, plan, flights);
    }
    Figure{"Predicted and actual errors", {{plot}}}.save("flights.png");
    std::puts("wrote flights.png");
}
