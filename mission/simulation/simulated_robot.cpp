// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_robot.hpp"

#include <array>
#include <utility>

namespace photonav {

SimulatedRobot::SimulatedRobot(std::shared_ptr<const ViewSource> world, const Camera& camera,
                               const Pose& T_b_c, const Pose& T_w_b, const ImageNoise& noise,
                               const SimulatedRobotOptions& options, std::uint64_t seed)
    : world_(std::move(world)),
      T_b_c_(T_b_c),
      blur_(options.camera.blur),
      mav_(T_w_b, options.body, seedFor(seed, 1)),
      camera_(*world_, camera, noise, options.camera, seedFor(seed, 2)) {}

Observation SimulatedRobot::fly(const BodyVelocity& command, double seconds) {
    Observation observation;
    // A step of no length measures no motion: images alone.
    observation.T_next_now = seconds > 0. ? mav_.step(command, seconds) : UncertainPose{};
    time_ += seconds;
    observation.time = time_;
    exposed_ = camera_.expose(time_, T_c_w());
    while (auto frame = camera_.receive(time_)) observation.frames.push_back(std::move(*frame));
    return observation;
}

std::uint64_t seedFor(std::uint64_t seed, std::uint64_t use) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(use)};
    std::array<std::uint32_t, 2> words{};
    sequence.generate(words.begin(), words.end());
    return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

}  // namespace photonav
