// SPDX-License-Identifier: BSD-3-Clause
// The tables of a TUM recording: lists of images, associations, trajectory, camera.
#include "dataset/sequence_tum.hpp"
#include "fuzz_input.hpp"
#include "geometry/constants.hpp"

void photonav::fuzz::run(std::string_view input) {
    const std::array<std::string, 5> names{"tum/rgb.txt", "tum/depth.txt", "tum/groundtruth.txt",
                                           "tum/camera.yaml", "tum/assoc.txt"};
    const unsigned choice = takeChoice(input, 8);
    TumOptions options;
    options.forgiving = (choice & 1U) != 0;
    options.needsDepth = (choice & 2U) == 0;
    if ((choice & 4U) != 0) options.tolerance = 10.;
    writeParts(names, input);
    check([&] {
        const Sequence sequence = readTumSequence((folder() / "tum").string(), options);
        require(sequence.camera.fx() > 0., "the camera has a focal length");
        double last = -kInfinity;
        for (const Sequence::Entry& frame : sequence.frames) {
            require(frame.T_c_w.matrix().allFinite(), "poses are finite");
            require(frame.timestamp >= last, "frames are in order of time");
            last = frame.timestamp;
        }
    });
}
