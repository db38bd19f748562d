// Tracks a recorded flight by odometry, or in the map of the second argument: is it consistent?
//! [replay]
#include <iostream>
#include <photonav/io/error.hpp>
#include <photonav/replay/replay.hpp>
#include <photonav/replay/replay_errors.hpp>
#include <photonav/replay/replay_result.hpp>

int main(int argc, char** argv) {
    photonav::ReplayOptions options;
    if (argc > 1) options.dataset = argv[1];
    if (argc > 2) options.mapFile = argv[2];
    options.odometry = options.mapFile.empty();
    try {
        const photonav::Replay replay(options);
        const photonav::ReplayRun run = replay.run();
        const photonav::ReplayErrors errors = photonav::evaluate(run);
        std::cout << photonav::verdictOf(run) << '\n';
        for (const photonav::EvaluatedFrame& frame : errors.frames) {
            std::cout << frame.pair.timestamp << ": off by " << frame.positionError << " m, sigma "
                      << frame.positionSigma << " m\n";
        }
        return photonav::isLostForGood(run) ? 1 : 0;
    } catch (const photonav::InputError& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
//! [replay]
