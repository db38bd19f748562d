// SPDX-License-Identifier: BSD-3-Clause
// Text models of COLMAP: cameras and the poses of images.
#include "dataset/colmap_model.hpp"
#include "fuzz_input.hpp"

void photonav::fuzz::run(std::string_view input) {
    const std::array<std::string, 2> names{"colmap/cameras.txt", "colmap/images.txt"};
    writeParts(names, input);
    check([&] {
        const Sequence sequence = readColmapSequence((folder() / "colmap").string());
        require(!sequence.frames.empty(), "a model has images");
        for (const Sequence::Entry& frame : sequence.frames) {
            require(frame.T_c_w.matrix().allFinite(), "poses are finite");
        }
    });
}
