// SPDX-License-Identifier: BSD-3-Clause
// A recording in the TUM layout as a bag.
#pragma once

#include "dataset/sequence_tum.hpp"
#include "ros_bag_writer.hpp"

namespace photonav::test {

/// @param depthScale value of one metre in the recording's depth images
inline void writeBag(const std::string& file, const std::filesystem::path& recording,
                     const BagWords& words = {}, double depthScale = 5000.) {
    const Sequence sequence = readTumSequence(recording.string());
    std::vector<BagFrame> frames;
    for (const Sequence::Entry& frame : sequence.frames) {
        const Pose T_w_c = frame.T_c_w.inverse();
        const Eigen::Vector3d& p = T_w_c.translation();
        const Eigen::Quaterniond q(T_w_c.linear());
        frames.push_back({frame.timestamp,
                          {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()},
                          frame.colourFile,
                          frame.depthFile});
    }
    const Camera& camera = sequence.camera;
    writeBag(file, frames,
             {camera.width, camera.height, camera.fx(), camera.fy(), camera.cx(), camera.cy()},
             depthScale, words);
}

}  // namespace photonav::test
