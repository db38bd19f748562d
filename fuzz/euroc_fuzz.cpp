// SPDX-License-Identifier: BSD-3-Clause
// The tables of a EuRoC recording: sensors, lists of images, ground truth.
#include "dataset/sequence_euroc.hpp"
#include "fuzz_input.hpp"

void photonav::fuzz::run(std::string_view input) {
    const std::string mav = "euroc/mav0/";
    const std::array<std::string, 6> names{mav + "cam0/sensor.yaml",
                                           mav + "cam0/data.csv",
                                           mav + "cam1/sensor.yaml",
                                           mav + "cam1/data.csv",
                                           mav + "state_groundtruth_estimate0/data.csv",
                                           mav + "state_groundtruth_estimate0/sensor.yaml"};
    for (const char* sensor : {"cam0", "cam1"})
        std::filesystem::create_directories(folder() / (mav + sensor));
    writeParts(names, input);
    check([&] {
        const StereoSequence sequence = readEurocSequence((folder() / "euroc").string(), {});
        for (const StereoSequence::Entry& frame : sequence.frames) {
            require(frame.T_c_w.matrix().allFinite(), "poses are finite");
        }
    });
}
