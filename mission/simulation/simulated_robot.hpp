// SPDX-License-Identifier: BSD-3-Clause
// A robot in a simulated world. This class holds the true pose; tracker and pilot have no access.
#pragma once

#include <memory>
#include <optional>

#include "robot/robot.hpp"
#include "simulation/simulated_camera.hpp"
#include "simulation/simulated_mav.hpp"

namespace photonav {

struct SimulatedRobotOptions {
    MavOptions body;
    SimulatedCameraOptions camera;
};

/// A simulated body and camera. Each has its own random numbers, so that options of one do not
/// change the random numbers of the other. Deterministic for a seed.
class SimulatedRobot : public Robot {
  public:
    /// @param world the true world
    /// @param T_w_b initial pose of the body
    /// @param noise noise of the images; empty: no noise
    /// @throws std::invalid_argument as SimulatedMav and SimulatedCamera do
    SimulatedRobot(std::shared_ptr<const ViewSource> world, const Camera& camera, const Pose& T_b_c,
                   const Pose& T_w_b, const ImageNoise& noise, const SimulatedRobotOptions& options,
                   std::uint64_t seed);

    Observation fly(const BodyVelocity& command, double seconds) override;
    const Camera& camera() const override { return camera_.camera(); }
    const Pose& T_b_c() const override { return T_b_c_; }
    double blur() const override { return blur_; }

    // True values, for evaluation.

    const Pose& T_w_b() const { return mav_.T_w_b(); }
    Pose T_c_w() const { return (T_w_b() * T_b_c_).inverse(); }
    double time() const { return time_; }  ///< [s]
    /// The exposure that ended the last call of fly(), whether its image arrives or not.
    const std::optional<Exposed>& exposed() const { return exposed_; }

  private:
    std::shared_ptr<const ViewSource> world_;
    Pose T_b_c_;
    double blur_;
    SimulatedMav mav_;
    SimulatedCamera camera_;
    double time_ = 0.;
    std::optional<Exposed> exposed_;
};

/// Derives independent seeds from one seed.
/// @param use number that distinguishes the uses of random numbers
std::uint64_t seedFor(std::uint64_t seed, std::uint64_t use);

}  // namespace photonav
