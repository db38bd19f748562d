// SPDX-License-Identifier: BSD-3-Clause
#include "commands/command_line.hpp"
#include "commands/servo_command.hpp"

namespace photonav {

Command servoCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<ServoOptions>();
    auto seed = std::make_shared<std::string>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser = app.add_subcommand(
        "servo", "Photometric servoing at a goal: where it converges, how fast, what is slowest.");
    addCommon(*parser, *options);
    addSeed(*parser, *seed, "of starts and image noise");
    ServoStudyOptions& study = options->study;
    parser->add_option("--at", options->at, "x,y,z[,yaw] of the body (default: the config's goal)");
    parser->add_option("--distances", options->distances,
                       "of starts from the goal, a,b,c [m] (default: 0.1,0.2,0.4,0.8)");
    parser->add_option("--angles", options->angles,
                       "rotations of starts, a,b,c [degrees] (default: 0,10,20)");
    parser->add_option("--trials", study.trials, "of each distance and angle")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    parser->add_flag("--tilt", study.hasTilt,
                     "six degrees of freedom; without: x, y, z and yaw, as the robot has");
    parser->add_option("--gain", study.gain, "of the error's exponential decrease [1/s]")
        ->check(CLI::Range(1e-3, 1e3))
        ->capture_default_str();
    parser->add_option("--damping", study.damping, "mu of Levenberg-Marquardt; 0: Gauss-Newton")
        ->check(CLI::Range(0., 1e6))
        ->capture_default_str();
    parser->add_option("--rate", study.rate, "images a second")
        ->check(CLI::Range(0.1, 1e4))
        ->capture_default_str();
    parser->add_option("--duration", study.duration, "that a start may need [s]")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    return {parser, [options, seed, &interrupted = invocation.interrupted] {
                if (!seed->empty()) options->overrides.push_back("seed=" + *seed);
                return runServo(*options, interrupted);
            }};
}

}  // namespace photonav
