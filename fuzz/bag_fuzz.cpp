// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 bags: records, chunks, topics and their images.
#include "dataset/sequence_bag.hpp"
#include "fuzz_input.hpp"
#include "geometry/constants.hpp"

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 4);
    BagOptions options;
    options.forgiving = (choice & 1U) != 0;
    options.needsDepth = (choice & 2U) == 0;
    const std::string file = write("flight.bag", input);
    check([&] {
        const BagSequence bag = readBagSequence(file, options);
        require(bag.sequence.camera.fx() > 0., "the camera has a focal length");
        double last = -kInfinity;
        for (std::size_t i = 0; i < bag.sequence.frames.size(); ++i) {
            const Sequence::Entry& frame = bag.sequence.frames[i];
            require(frame.T_c_w.matrix().allFinite(), "poses are finite");
            require(frame.timestamp >= last, "frames are in order of time");
            last = frame.timestamp;
            const View view = bag.view(i);
            require(view.intensity.getWidth() == bag.sequence.camera.width, "images are whole");
        }
    });
}
