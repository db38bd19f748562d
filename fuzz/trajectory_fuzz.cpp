// SPDX-License-Identifier: BSD-3-Clause
// Paths of other programs (TUM, KITTI, tables), plans to be flown, and candidate posters.
#include "check/given_trajectory.hpp"
#include "fuzz_input.hpp"
#include "geometry/camera.hpp"
#include "posters/poster.hpp"
#include "problem/planned_path.hpp"

namespace {

using namespace photonav;

void readPath(const std::string& file) {
    const GivenTrajectory trajectory = readGivenTrajectory(file, cameraMount(0.8));
    fuzz::require(trajectory.poses.size() >= 2, "there are at least two poses");
    fuzz::require(lengthOf(trajectory) <= 1e5, "the length is limited");
    for (const GivenPose& pose : trajectory.poses) {
        fuzz::require(pose.T_w_b.matrix().allFinite(), "poses are finite");
    }
}

void readPlan(const std::string& file) {
    static const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", {});
    const PlannedPath path = readPlannedPath(file, config);
    fuzz::require(path.waypoints.size() >= 2, "there are at least two waypoints");
}

}  // namespace

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 3);
    const std::string file = write("given", input);
    check([&] {
        if (choice == 0) readPath(file);
        if (choice == 1) readPlan(file);
        if (choice == 2) readPosters(file);
    });
}
