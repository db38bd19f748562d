// SPDX-License-Identifier: BSD-3-Clause
// Tutorials run in a scene of their own, or in one named on the command line.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "exercises.hpp"
#include "io/error.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// The file of the first argument, else that of a sample.
inline std::string sceneFile(int argc, char** argv, const std::string& sample) {
    const bool isNamed = argc > 1 && !asksForCheck(argc, argv);
    return isNamed ? argv[1] : PHOTONAV_SOURCE_DIR "/config/scenes/" + sample;
}

/// The scene in sceneFile(). One that cannot be read ends the program.
inline Scene sceneArgument(int argc, char** argv, const std::string& sample) {
    try {
        return loadScene(sceneFile(argc, argv, sample));
    } catch (const InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        std::exit(2);
    }
}

}  // namespace photonav
