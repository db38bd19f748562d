// SPDX-License-Identifier: BSD-3-Clause
#include "servo/servo_study.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "evaluation/averages.hpp"
#include "geometry/constants.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"
#include "io/interrupted.hpp"
#include "render/area_sensor.hpp"
#include "simulation/camera_noise.hpp"

namespace photonav {
namespace {

using Random = std::mt19937_64;

constexpr double kOffImage = 1e3;  // [m]: what has gone there does not come back

/// The body's velocities that are free, as columns of twists of the body.
Eigen::MatrixXd bodyFreedom(bool hasTilt) {
    if (hasTilt) return Matrix6::Identity();
    Eigen::MatrixXd freedom = Eigen::MatrixXd::Zero(6, 4);
    freedom.topLeftCorner<3, 3>().setIdentity();
    freedom(5, 3) = 1.;
    return freedom;
}

double medianDepth(const View& view) {
    std::vector<double> depths;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (view.depth.bitmap[i] > 0.F) depths.push_back(view.depth.bitmap[i]);
    }
    return median(depths, 1.);
}

/// A photograph: pixels average over their area, and edges are as wide as the gradients' stencil.
/// In a rendered view the edges of surfaces move by whole pixels.
void photograph(const AreaSensor& sensor, const Camera& camera, const Pose& T_c_w, View& view) {
    sensor.render(camera, T_c_w, view);
    applyPointSpread(view);
}

View photographed(const AreaSensor& sensor, const Camera& camera, const Pose& T_c_w) {
    View view;
    photograph(sensor, camera, T_c_w, view);
    return view;
}

/// The servo at a goal, with what is needed to simulate it.
struct Simulation {
    ServoGoal goal;
    ServoStudyOptions options;
    Eigen::MatrixXd body;  ///< bodyFreedom()
    Pose T_goal;           ///< T_c_w
    AreaSensor sensor;
    ImageNoise noise;
    LevenbergServo servo;
    double depth;
    const std::atomic<bool>& interrupted;

    Simulation(const ServoGoal& at, const ServoStudyOptions& o, const std::atomic<bool>& flag)
        : goal(at),
          options(o),
          body(bodyFreedom(o.hasTilt)),
          T_goal((at.T_w_b * at.T_b_c).inverse()),
          sensor(at.views),
          noise(assumedNoise({.sigma = at.photometric.sigma})),
          // The body moves by exp(V dt) on the right of T_w_b: T_c_w by -Ad(T_c_b) V on its left.
          servo(photographed(sensor, at.camera, T_goal), at.camera,
                -adjoint(Pose(at.T_b_c.inverse())) * body,
                {at.photometric, o.gain, o.damping, [&flag] { throwIfStopped(flag); }}),
          depth(medianDepth(servo.goal())),
          interrupted(flag) {}

    Pose displaced(const Eigen::VectorXd& q) const {
        return expSE3(Vector6(servo.freedom() * q)) * T_goal;
    }

    /// Of a pose from the goal, in body twists to first order.
    Vector6 errorOf(const Pose& T_c_w) const {
        return -adjoint(goal.T_b_c) * logSE3(Pose(T_c_w * T_goal.inverse()));
    }

    /// One image and the motion it commands. @param random null: without noise
    /// @throws Interrupted when the study is interrupted
    void step(Pose& T_c_w, View& view, Random* random) const {
        throwIfStopped(interrupted);
        photograph(sensor, goal.camera, T_c_w, view);
        if (random) noise(view.intensity, *random, [&] { return interrupted.load(); });
        const Eigen::VectorXd q = servo.velocity(view.intensity) / options.rate;
        T_c_w = expSE3(Vector6(servo.freedom() * q)) * T_c_w;
    }

    /// Unit: |rho| + depth |phi|.
    double lengthOf(const Eigen::VectorXd& q) const {
        const Vector6 twist = body * q;
        return twist.head<3>().norm() + depth * twist.tail<3>().norm();
    }
};

/// How fast an offset along a direction shrinks, over a time constant. Measured along the direction
/// as H measures, in which modes are orthogonal.
double simulatedDecay(const Simulation& simulation, const Eigen::VectorXd& mode, double rate) {
    constexpr double kOffset =
        0.5;  // in the image [pixels]: linear, and not lost in rays per pixel
    constexpr int kMostSteps = 300;
    const double dt = 1. / simulation.options.rate;
    const Eigen::MatrixXd& H = simulation.servo.information();
    const Eigen::VectorXd measure = H * mode / (mode.transpose() * H * mode).value();
    const auto along = [&](const Pose& T_c_w) {
        const Vector6 error = simulation.errorOf(T_c_w);
        return measure.dot((simulation.body.transpose() * error).eval());
    };
    Pose T_c_w =
        simulation.displaced(kOffset / simulation.goal.camera.fx() * simulation.depth * mode);
    const double before = along(T_c_w);
    const int steps = std::clamp(static_cast<int>(1. / (rate * dt)), 1, kMostSteps);
    View view;
    for (int i = 0; i < steps; ++i) simulation.step(T_c_w, view, nullptr);
    return -std::log(std::abs(along(T_c_w) / before)) / (steps * dt);
}

void addModes(const Simulation& simulation, ServoStudy& study) {
    const LevenbergServo::Modes modes = simulation.servo.modes();
    const double rate = simulation.options.rate;
    for (Eigen::Index i = 0; i < modes.rates.size(); ++i) {
        const Eigen::VectorXd direction =
            modes.directions.col(i) / simulation.lengthOf(modes.directions.col(i));
        ServoMode mode;
        mode.direction = simulation.body * direction;
        mode.rate = modes.rates[i];
        if (mode.rate > 0.) {
            mode.predictedDecay = -rate * std::log(std::abs(1. - mode.rate / rate));
            mode.simulatedDecay = simulatedDecay(simulation, direction, mode.rate);
        }
        study.modes.push_back(mode);
    }
}

double conditionOf(const Simulation& simulation) {
    const Eigen::MatrixXd& H = simulation.servo.information();
    Eigen::VectorXd unit(H.rows());
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
        unit[i] = 1. / simulation.lengthOf(Eigen::VectorXd::Unit(unit.size(), i));
    }
    const Eigen::MatrixXd scaled = unit.asDiagonal() * H * unit.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
    const double least = solver.eigenvalues()[0], most = solver.eigenvalues()[unit.size() - 1];
    return least > 1e-12 * most ? most / least : kInfinity;
}

void setSigmas(const Simulation& simulation, ServoStudy& study) {
    study.positionSigma = study.rotationSigma = kInfinity;
    if (study.openDirections() > 0) return;
    const Eigen::MatrixXd covariance = simulation.servo.information().inverse();
    const Eigen::Index rotations = covariance.rows() - 3;
    study.positionSigma = largestSigma(covariance.topLeftCorner(3, 3));
    study.rotationSigma = largestSigma(covariance.bottomRightCorner(rotations, rotations));
}

/// The random numbers of a trial. Those of another trial do not depend on how long it lasts.
Random randomOf(unsigned seed, std::size_t cell, int trial) {
    std::seed_seq words{seed, static_cast<unsigned>(cell), static_cast<unsigned>(trial)};
    return Random(words);
}

/// A start at a distance and a rotation, in a random direction of what is free.
Eigen::VectorXd randomOffset(double distance, double angle, bool hasTilt, Random& random) {
    std::normal_distribution<double> normal;
    const auto direction = [&](Eigen::Index n) {
        Eigen::VectorXd d(n);
        for (double& component : d) component = normal(random);
        return Eigen::VectorXd(d.normalized());
    };
    Eigen::VectorXd q(hasTilt ? 6 : 4);
    q.head(3) = distance * direction(3);
    q.tail(q.size() - 3) = angle * direction(q.size() - 3);
    return q;
}

/// Seconds until it is at the goal and stays there; negative: it does not come.
/// @throws Interrupted as Simulation::step() does
double trial(const Simulation& simulation, const Eigen::VectorXd& offset, Random& random) {
    constexpr int kStays = 5;  // images
    const ServoStudyOptions& options = simulation.options;
    Pose T_c_w = simulation.displaced(offset);
    View view;
    int within = 0;
    const int steps = static_cast<int>(options.duration * options.rate);
    for (int i = 0; i <= steps; ++i) {
        const Vector6 error = simulation.errorOf(T_c_w);
        if (!(error.norm() < kOffImage)) return -1.;
        const bool isThere =
            error.head<3>().norm() < kServoPosition && error.tail<3>().norm() < kServoAngle;
        within = isThere ? within + 1 : 0;
        if (within == kStays) return std::max(0, i + 1 - kStays) / options.rate;
        simulation.step(T_c_w, view, &random);
    }
    return -1.;
}

/// 95 % interval of a share (Wilson).
void setInterval(BasinCell& cell) {
    constexpr double kZ = 1.96;
    const double n = cell.trials, p = cell.converged / n, z2 = kZ * kZ / n;
    const double middle = (p + z2 / 2.) / (1. + z2);
    const double half = std::sqrt(p * (1. - p) * z2 + z2 * z2 / 4.) / (1. + z2);
    cell.low = std::max(0., middle - half);
    cell.high = std::min(1., middle + half);
}

/// All trials from one distance and angle, or those that ended before an interruption.
/// @param number of the cell
BasinCell basinCell(const Simulation& simulation, double distance, double angle,
                    std::size_t number) {
    const ServoStudyOptions& options = simulation.options;
    BasinCell cell{distance, angle};
    std::vector<double> seconds;
    try {
        for (; cell.trials < options.trials; ++cell.trials) {
            Random random = randomOf(options.seed, number, cell.trials);
            const Eigen::VectorXd offset =
                randomOffset(distance, angle * kDegree, options.hasTilt, random);
            const double needed = trial(simulation, offset, random);
            if (needed >= 0.) seconds.push_back(needed);
        }
    } catch (const Interrupted&) {  // the trials so far are whole
    }
    cell.converged = static_cast<int>(seconds.size());
    cell.seconds = median(seconds, 0.);
    if (cell.trials > 0) setInterval(cell);
    return cell;
}

}  // namespace

ServoStudy studyServo(const ServoGoal& goal, const ServoStudyOptions& options,
                      const std::atomic<bool>& interrupted,
                      const std::function<void(double)>& progress) {
    const Simulation simulation(goal, options, interrupted);
    ServoStudy study;
    study.depth = simulation.depth;
    study.condition = conditionOf(simulation);
    addModes(simulation, study);
    setSigmas(simulation, study);
    const double all = static_cast<double>(options.distances.size() * options.angles.size());
    for (const double angle : options.angles) {
        for (const double distance : options.distances) {
            const BasinCell cell = basinCell(simulation, distance, angle, study.basin.size());
            if (cell.trials > 0) study.basin.push_back(cell);
            progress(static_cast<double>(study.basin.size()) / all);
        }
    }
    study.interrupted = interrupted;
    return study;
}

std::size_t ServoStudy::openDirections() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(modes, [](const ServoMode& mode) { return !(mode.rate > 0.); }));
}

int ServoStudy::trials() const {
    int sum = 0;
    for (const BasinCell& cell : basin) sum += cell.trials;
    return sum;
}

int ServoStudy::converged() const {
    int sum = 0;
    for (const BasinCell& cell : basin) sum += cell.converged;
    return sum;
}

std::string inWords(const ServoMode& mode, double depth) {
    static constexpr std::array kNames{"x", "y", "z", "roll", "pitch", "yaw"};
    Vector6 parts = mode.direction;
    parts.tail<3>() *= depth;
    std::array<Eigen::Index, 6> order{0, 1, 2, 3, 4, 5};
    std::ranges::stable_sort(
        order, [&](auto i, auto j) { return std::abs(parts[i]) > std::abs(parts[j]); });
    const double whole = parts.cwiseAbs().sum(), sign = parts[order[0]] < 0. ? -1. : 1.;
    const auto named = [&](Eigen::Index i) {
        const auto share = std::lround(100. * sign * parts[i] / whole);
        return share == 0 ? "" : fmt::format("{} {:+} %", kNames.at(std::size_t(i)), share);
    };
    const std::string first = named(order[0]), second = named(order[1]);
    return second.empty() ? kNames.at(std::size_t(order[0])) : first + ", " + second;
}

}  // namespace photonav
